// gim_corpus --list                      the manifest, as CSV
// gim_corpus NAME OUT.{ply,obj}          writes one mesh of the corpus as text
// gim_corpus --dense IN PARTS OUT.ply    cuts each triangle of IN into PARTS * PARTS, with noise; writes binary PLY
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>

#include "corpus/corpus.h"
#include "corpus/generators.h"
#include "tools/file.h"
#include "tools/mesh_read.h"

namespace {

using gim::TriangleMesh;

void print_manifest() {
    std::puts("name,vertices,triangles,components,boundary_loops,genus,fault");
    for (const gim::corpus::CorpusEntry& e : gim::corpus::corpus()) {
        const TriangleMesh mesh = e.mesh();
        std::printf("%s,%zu,%zu,%u,%u,%s,%s\n", e.name.c_str(), mesh.positions.size(), mesh.triangles.size(),
                    e.components, e.boundary_loops, e.genus < 0 ? "" : std::to_string(e.genus).c_str(),
                    e.fault.c_str());
    }
}

void write_ply(std::FILE* file, const TriangleMesh& mesh) {
    std::fprintf(file,
                 "ply\nformat ascii 1.0\nelement vertex %zu\nproperty double x\nproperty double y\nproperty double z\n",
                 mesh.positions.size());
    std::fprintf(file, "element face %zu\nproperty list uchar int vertex_indices\nend_header\n", mesh.triangles.size());
    for (const auto& p : mesh.positions) std::fprintf(file, "%.17g %.17g %.17g\n", p[0], p[1], p[2]);
    for (const auto& t : mesh.triangles) std::fprintf(file, "3 %u %u %u\n", t[0], t[1], t[2]);
}

void write_obj(std::FILE* file, const TriangleMesh& mesh) {
    for (const auto& p : mesh.positions) std::fprintf(file, "v %.17g %.17g %.17g\n", p[0], p[1], p[2]);
    for (const auto& t : mesh.triangles) std::fprintf(file, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
}

// Little-endian machines only, as all that gim is built for.
void write_binary_ply(std::FILE* file, const TriangleMesh& mesh) {
    std::fprintf(file,
                 "ply\nformat binary_little_endian 1.0\nelement vertex %zu\nproperty float x\nproperty float y\n"
                 "property float z\nelement face %zu\nproperty list uchar int vertex_indices\nend_header\n",
                 mesh.positions.size(), mesh.triangles.size());
    for (const auto& p : mesh.positions) {
        const float point[3] = {float(p[0]), float(p[1]), float(p[2])};
        std::fwrite(point, sizeof point, 1, file);
    }
    for (const auto& t : mesh.triangles) {
        std::fputc(3, file);
        std::fwrite(t.data(), sizeof(uint32_t), t.size(), file);
    }
}

// A tenth of the mean edge: what a scanner adds to a surface that it samples more densely than it can see.
double noise_of(const TriangleMesh& mesh) {
    double sum = 0;
    for (const auto& t : mesh.triangles) {
        const auto &a = mesh.positions[t[0]], &b = mesh.positions[t[1]];
        sum += std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
    }
    return 0.1 * sum / double(std::max<size_t>(1, mesh.triangles.size()));
}

gim::Result<TriangleMesh> read_dense(const std::string& path, const char* parts_text) {
    constexpr uint32_t kMostParts = 100;
    uint32_t parts = 0;
    const char* end = parts_text + std::strlen(parts_text);
    const auto parsed = std::from_chars(parts_text, end, parts);
    if (parsed.ec != std::errc() || parsed.ptr != end || parts < 1 || parts > kMostParts)
        return gim::Error{gim::Stage::kInput, "PARTS must be 1 to 100"};
    const auto bytes = gim::read_file(path);
    if (!bytes.ok()) return bytes.error();
    gim::ReadContext context;
    const auto mesh = gim::read_mesh(bytes.value(), gim::detect_format(bytes.value(), {}), context);
    if (!mesh.ok()) return mesh;
    TriangleMesh dense = gim::corpus::densified(mesh.value(), parts);
    const double noise = noise_of(dense);
    return gim::corpus::roughened(std::move(dense), noise, 1);
}

template <class Write>
int write_to(const std::string& path, const Write& write) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) {
        std::fprintf(stderr, "gim_corpus: cannot write %s\n", path.c_str());
        return 1;
    }
    write(file);
    const bool written = std::ferror(file) == 0;
    if (std::fclose(file) != 0 || !written) {
        std::fprintf(stderr, "gim_corpus: writing %s failed\n", path.c_str());
        return 1;
    }
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::strcmp(argv[1], "--list") == 0) {
        print_manifest();
        return 0;
    }
    if (argc == 5 && std::strcmp(argv[1], "--dense") == 0) {
        const auto mesh = read_dense(argv[2], argv[3]);
        if (!mesh.ok()) {
            std::fprintf(stderr, "gim_corpus: %s: %s\n", argv[2], mesh.error().message.c_str());
            return 1;
        }
        return write_to(argv[4], [&](std::FILE* file) { write_binary_ply(file, mesh.value()); });
    }
    if (argc != 3) {
        std::fputs("usage: gim_corpus --list | gim_corpus NAME OUT.{ply,obj} | gim_corpus --dense IN PARTS OUT.ply\n",
                   stderr);
        return 2;
    }
    const gim::corpus::CorpusEntry entry = gim::corpus::corpus().named(argv[1]);
    if (entry.name.empty()) {
        std::fprintf(stderr, "gim_corpus: no mesh is called %s; see gim_corpus --list\n", argv[1]);
        return 2;
    }
    const std::string path = argv[2];
    return write_to(path, [&](std::FILE* file) {
        if (path.ends_with(".obj")) {
            write_obj(file, entry.mesh());
        } else {
            write_ply(file, entry.mesh());
        }
    });
}
