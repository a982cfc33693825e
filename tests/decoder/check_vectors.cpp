// Decodes all conformance vectors and compares every bit. For platforms without a test library: it needs only the
// decoder and the standard library. check_vectors FOLDER: the folder that holds valid/ and invalid/.
#include <algorithm>
#include <cstdio>

#include "tests/decoder/vectors.h"

namespace {

namespace fs = std::filesystem;
using gim::test::Decoded;
using gim::test::read_bytes;
using gim::test::to_bytes;

std::vector<fs::path> vectors_in(const fs::path& folder) {
    std::vector<fs::path> paths;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(folder, none)) {
        if (entry.path().extension() == ".gim") paths.push_back(entry.path());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

bool decodes_to_its_bits(const fs::path& path) {
    const auto is_as_stored = [&](const auto& values, const char* extension) {
        return to_bytes(values) == read_bytes(fs::path(path).replace_extension(extension));
    };
    const Decoded d = gim::test::decode_all(read_bytes(path));
    return d.status == GIM_OK && !d.samples.empty() && is_as_stored(d.samples, ".f32") &&
           is_as_stored(d.triangles, ".tri") && is_as_stored(d.vertices, ".vtx") && is_as_stored(d.planes, ".pln") &&
           is_as_stored(d.details, ".dsp") && is_as_stored(d.bounds, ".bnd");
}

bool is_refused_for_its_reason(const fs::path& path) {
    const gim_status expected = gim::test::status_of_name(path.filename().string());
    return expected != GIM_OK && gim::test::decode_all(read_bytes(path)).status == expected;
}

// Returns how many vectors fail.
size_t check(const std::vector<fs::path>& paths, bool (*is_right)(const fs::path&)) {
    size_t failures = 0;
    for (const fs::path& path : paths) {
        if (is_right(path)) continue;
        std::printf("FAILED %s\n", path.filename().string().c_str());
        ++failures;
    }
    return failures;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fputs("usage: check_vectors FOLDER\n", stderr);
        return 2;
    }
    const std::vector<fs::path> valid = vectors_in(fs::path(argv[1]) / "valid");
    const std::vector<fs::path> invalid = vectors_in(fs::path(argv[1]) / "invalid");
    if (valid.size() < 8 || invalid.size() < 20) {
        std::fputs("check_vectors: the folder has too few vectors\n", stderr);
        return 2;
    }
    const size_t failures = check(valid, decodes_to_its_bits) + check(invalid, is_refused_for_its_reason);
    std::printf("%zu valid and %zu invalid vectors, %zu failures\n", valid.size(), invalid.size(), failures);
    return failures == 0 ? 0 : 1;
}
