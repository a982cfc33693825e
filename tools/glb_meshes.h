// Which meshes of a glTF file can become .gim, and what the encoder gets of them.
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <vector>

#include "tools/gltf_primitive.h"

namespace gim::gltf {

// A mesh in its own space. Its triangles have their primitive as label.
struct MeshSurface {
    TriangleMesh mesh;
    std::vector<uint32_t> first_vertex;  // of each primitive; a vertex less this is its row in the primitive's arrays
    uint64_t plain_bytes = 0;            // that its arrays take without compression
};

// The meshes that a node with a skin uses.
std::set<uint64_t> skinned_meshes(const Json& root);

// Throws a Failure that says why a mesh has to stay as it is: "it has morph targets".
void check_mesh(const Json& mesh);

// Reads a mesh that passed the check. Throws a Failure if it is damaged.
MeshSurface read_surface_of(File& file, DracoMeshes& draco, const Json& mesh);

}  // namespace gim::gltf
