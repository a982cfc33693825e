// gim_corpus --list              the manifest, as CSV
// gim_corpus NAME OUT.{ply,obj}  writes one mesh of the corpus as text
#include <cstdio>
#include <cstring>
#include <string>

#include "corpus/corpus.h"

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

}  // namespace

int main(int argc, char** argv) {
    if (argc == 2 && std::strcmp(argv[1], "--list") == 0) {
        print_manifest();
        return 0;
    }
    if (argc != 3) {
        std::fputs("usage: gim_corpus --list | gim_corpus NAME OUT.{ply,obj}\n", stderr);
        return 2;
    }
    const gim::corpus::CorpusEntry entry = gim::corpus::corpus().named(argv[1]);
    if (entry.name.empty()) {
        std::fprintf(stderr, "gim_corpus: no mesh is called %s; see gim_corpus --list\n", argv[1]);
        return 2;
    }
    const std::string path = argv[2];
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file) {
        std::fprintf(stderr, "gim_corpus: cannot write %s\n", path.c_str());
        return 1;
    }
    if (path.ends_with(".obj")) {
        write_obj(file, entry.mesh());
    } else {
        write_ply(file, entry.mesh());
    }
    const bool written = std::ferror(file) == 0;
    if (std::fclose(file) != 0 || !written) {
        std::fprintf(stderr, "gim_corpus: writing %s failed\n", path.c_str());
        return 1;
    }
    return 0;
}
