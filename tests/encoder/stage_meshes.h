// Meshes for the stage tests, in the encoder's own type.
#pragma once

#include <string>
#include <vector>

#include "corpus/corpus.h"
#include "encoder/surface/clean.h"
#include "encoder/surface/mesh.h"

namespace gim {

struct NamedMesh {
    std::string name;
    int genus;
    uint32_t boundary_loops;
    Mesh mesh;
};

// Every connected valid mesh of the corpus, cleaned.
inline std::vector<NamedMesh> connected_meshes() {
    std::vector<NamedMesh> meshes;
    for (const corpus::CorpusEntry& entry : corpus::corpus().connected()) {
        auto cleaned = clean(entry.mesh());
        meshes.push_back({entry.name, entry.genus, entry.boundary_loops, std::move(cleaned.value().mesh)});
    }
    return meshes;
}

// Every valid mesh of the corpus, those of several components too.
inline std::vector<NamedMesh> surfaces() {
    std::vector<NamedMesh> meshes;
    for (const corpus::CorpusEntry& entry : corpus::corpus().valid()) {
        auto cleaned = clean(entry.mesh(), {.require_connected = false});
        meshes.push_back({entry.name, entry.genus, entry.boundary_loops, std::move(cleaned.value().mesh)});
    }
    return meshes;
}

// Euler characteristic V - E + F over referenced vertices.
inline int64_t euler_characteristic(const Mesh& mesh) {
    const Topology topology = build_topology(mesh);
    int64_t vertices = 0, edges = 0;
    for (const uint32_t h : topology.outgoing) vertices += h != kNone;
    for (uint32_t h = 0; h < topology.twin.size(); ++h) edges += topology.twin[h] == kNone || h < topology.twin[h];
    return vertices - edges + static_cast<int64_t>(mesh.triangles.size());
}

}  // namespace gim
