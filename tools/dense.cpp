// gim_dense IN PARTS OUT.ply: cuts each triangle of a mesh into PARTS * PARTS, rounds them, adds noise, and writes binary
// PLY. Makes scans of a million faces, and of ten, for measurements.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <string_view>

#include "corpus/generators.h"
#include "tools/file.h"
#include "tools/little_endian.h"
#include "tools/mesh_read.h"

namespace gim {

namespace {

constexpr uint32_t kMostParts = 100;

Bytes binary_ply(const TriangleMesh& mesh) {
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
        std::to_string(mesh.triangles.size()) + "\nproperty list uchar int vertex_indices\nend_header\n";
    Bytes bytes(header.begin(), header.end());
    bytes.reserve(bytes.size() + 12 * mesh.positions.size() + 13 * mesh.triangles.size());
    for (const auto& p : mesh.positions) {
        for (const double x : p) append(bytes, static_cast<float>(x));
    }
    for (const auto& t : mesh.triangles) {
        append(bytes, uint8_t{3});
        for (const uint32_t v : t) append(bytes, v);
    }
    return bytes;
}

// A tenth of the mean edge: what a scanner adds that samples a surface more densely than it can see.
double noise_of(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const auto &a = mesh.positions[t[0]], &b = mesh.positions[t[1]];
        sum += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    }
    return 0.1 * sum / static_cast<double>(std::max<size_t>(1, mesh.triangles.size()));
}

Result<void> write_dense(const std::string& in, std::string_view parts_text, const std::string& out) {
    uint32_t parts = 0;
    const char* end = parts_text.data() + parts_text.size();
    const auto parsed = std::from_chars(parts_text.data(), end, parts);
    if (parsed.ec != std::errc() || parsed.ptr != end || parts < 1 || parts > kMostParts)
        return Error{Stage::kInput, "PARTS must be 1 to " + std::to_string(kMostParts)};
    const auto bytes = read_file(in);
    if (!bytes.ok()) return bytes.error();
    ReadContext context;
    const auto mesh = read_mesh(bytes.value(), detect_format(bytes.value(), {}), context);
    if (!mesh.ok()) return mesh.error();
    TriangleMesh dense = corpus::densified(mesh.value(), parts);
    const double noise = noise_of(dense);
    return write_file(out, binary_ply(corpus::roughened(std::move(dense), noise, 1)));
}

}  // namespace

}  // namespace gim

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: gim_dense IN PARTS OUT.ply\n", stderr);
        return 2;
    }
    const auto written = gim::write_dense(argv[1], argv[2], argv[3]);
    if (written.ok()) return 0;
    std::fprintf(stderr, "gim_dense: %s\n", written.error().message.c_str());
    return 1;
}
