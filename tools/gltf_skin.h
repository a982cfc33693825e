// Skins: vertices that follow joints, in the pose that the nodes of the file have.
#pragma once

#include "tools/gltf_primitive.h"
#include "tools/gltf_scene.h"

namespace gim::gltf {

struct SkinnedVertices {
    std::vector<Eigen::Vector3d> positions;  // in the world, of the rows that were asked for
    bool mirrored = false;                   // most of them by a transform that turns the surface inside out
};

// Places the rows of `positions`. The node that holds the mesh has no part in it, as the specification says. Fails if
// the skin or the joints of a vertex are incomplete.
SkinnedVertices apply_skin(File& file, const NodeTransforms& nodes, uint64_t skin, Primitive& primitive,
                           const MorphedColumn& positions, std::span<const uint32_t> rows);

}  // namespace gim::gltf
