// The list of the corpus (corpus.h). A change here changes manifest.csv: write it anew with `gim_corpus --list`.
#include "corpus/corpus.h"

#include <limits>

namespace gim::corpus {

namespace {

TriangleMesh with_not_a_number() {
    TriangleMesh mesh = sphere(4);
    mesh.positions[7][1] = std::numeric_limits<double>::quiet_NaN();
    return mesh;
}

TriangleMesh with_missing_vertex() {
    TriangleMesh mesh = sphere(4);
    mesh.triangles[11][2] = 1000000;
    return mesh;
}

TriangleMesh with_misoriented_patch() {
    TriangleMesh mesh = torus(24, 12, 0.7, 0.3);
    for (size_t f = 100; f < 160; ++f) std::swap(mesh.triangles[f][0], mesh.triangles[f][1]);
    return mesh;
}

TriangleMesh with_useless_faces() {
    TriangleMesh mesh = sphere(4);
    mesh.triangles.push_back({3, 3, 8});
    mesh.triangles.push_back(mesh.triangles[5]);
    mesh.positions.push_back({9, 9, 9});
    return mesh;
}

std::vector<CorpusEntry> all_entries() {
    // Columns: name, generator, valid, components, boundary loops, genus, fault.
    return {
        {"sphere-108", [] { return sphere(3); }, true, 1, 0, 0, ""},
        {"sphere-1728", [] { return sphere(12); }, true, 1, 0, 0, ""},
        {"sphere-rough-10800", [] { return roughened(sphere(30), 0.02, 1); }, true, 1, 0, 0, ""},
        {"box-768", [] { return box(8, 0.6, 0.3); }, true, 1, 0, 0, ""},
        {"box-19200", [] { return box(40, 0.8, 0.5); }, true, 1, 0, 0, ""},
        {"limbs", [] { return limbed_blob(48); }, true, 1, 0, 0, ""},
        {"limbs-rough", [] { return roughened(limbed_blob(40), 0.005, 2); }, true, 1, 0, 0, ""},
        {"torus-576", [] { return torus(24, 12, 0.7, 0.3); }, true, 1, 0, 1, ""},
        {"torus-thin-8192", [] { return torus(128, 32, 0.9, 0.1); }, true, 1, 0, 1, ""},
        {"torus-rough-4096", [] { return roughened(torus(64, 32, 0.7, 0.3), 0.01, 3); }, true, 1, 0, 1, ""},
        {"tori-2", [] { return melted_tori(2, 40); }, true, 1, 0, 2, ""},
        {"tori-3", [] { return melted_tori(3, 44); }, true, 1, 0, 3, ""},
        {"plate-1", [] { return plate_with_holes(1, 4); }, true, 1, 0, 1, ""},
        {"plate-2", [] { return plate_with_holes(2, 5); }, true, 1, 0, 2, ""},
        {"plate-5", [] { return plate_with_holes(5, 6); }, true, 1, 0, 5, ""},
        {"disk-180", [] { return disk(7, 12); }, true, 1, 1, 0, ""},
        {"terrain-3200", [] { return terrain(40); }, true, 1, 1, 0, ""},
        {"annulus-512", [] { return annulus(8, 32, 0.4); }, true, 1, 2, 0, ""},
        {"cylinder-1200", [] { return open_cylinder(20, 30, 2); }, true, 1, 2, 0, ""},
        {"sphere-holes-1", [] { return sphere_with_holes(12, 1); }, true, 1, 1, 0, ""},
        {"sphere-holes-4", [] { return sphere_with_holes(15, 4); }, true, 1, 4, 0, ""},
        {"sphere-holes-6", [] { return sphere_with_holes(9, 6); }, true, 1, 6, 0, ""},
        {"two-spheres",
         [] {
             return together({sphere(6), sphere(9)}, 3);
         },
         true, 2, 0, 0, ""},
        {"four-pieces",
         [] {
             return together({torus(24, 12, 0.7, 0.3), disk(5, 12), sphere(5), annulus(3, 16, 0.5)}, 3);
         },
         true, 4, 3, 1, ""},

        {"soup", [] { return soup(sphere(6)); }, false, 432, 432, -1, "unwelded"},
        {"misoriented", with_misoriented_patch, false, 1, 0, -1, "misoriented"},
        {"useless-faces", with_useless_faces, false, 1, 0, -1, "degenerate"},
        {"edge-of-three", edge_with_three_faces, false, 1, 1, -1, "non-manifold"},
        {"bow-tie", bow_tie, false, 2, 0, -1, "non-manifold"},
        {"moebius", [] { return moebius_strip(24); }, false, 1, 1, -1, "one-sided"},
        {"not-a-number", with_not_a_number, false, 1, 0, -1, "not finite"},
        {"missing-vertex", with_missing_vertex, false, 1, 0, -1, "index"},
        {"empty", [] { return TriangleMesh{}; }, false, 0, 0, -1, "empty"},
    };
}

template <class Keep>
Corpus filtered(const Corpus& from, const Keep& keep) {
    std::vector<CorpusEntry> kept;
    for (const CorpusEntry& entry : from) {
        if (keep(entry)) kept.push_back(entry);
    }
    return Corpus(std::move(kept));
}

}  // namespace

Corpus Corpus::valid() const {
    return filtered(*this, [](const CorpusEntry& e) { return e.is_valid; });
}
Corpus Corpus::broken() const {
    return filtered(*this, [](const CorpusEntry& e) { return !e.is_valid; });
}
Corpus Corpus::connected() const {
    return filtered(*this, [](const CorpusEntry& e) { return e.is_valid && e.components == 1; });
}
Corpus Corpus::closed() const {
    return filtered(*this, [](const CorpusEntry& e) { return e.is_valid && e.boundary_loops == 0; });
}
Corpus Corpus::bounded() const {
    return filtered(*this, [](const CorpusEntry& e) { return e.is_valid && e.boundary_loops > 0; });
}
Corpus Corpus::genus(int value) const {
    return filtered(*this, [=](const CorpusEntry& e) { return e.genus == value; });
}

CorpusEntry Corpus::named(const std::string& name) const {
    for (const CorpusEntry& entry : entries_) {
        if (entry.name == name) return entry;
    }
    return {"", [] { return TriangleMesh{}; }, false, 0, 0, -1, "no such mesh"};
}

Corpus corpus() { return Corpus(all_entries()); }

}  // namespace gim::corpus
