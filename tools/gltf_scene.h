// Nodes: where the meshes of a scene stand.
#pragma once

#include <Eigen/Geometry>
#include <functional>

#include "tools/gltf_accessor.h"

namespace gim::gltf {

// A mesh of the scene. `node` is null if the file has no nodes.
struct MeshInstance {
    const Json& node;
    const Json& mesh;
    Eigen::Affine3d transform;  // of the node, to the world
};

// Calls use() for every mesh instance of the scene, in the order of its nodes: of the default scene, else of the first,
// else of all nodes that are nobody's child; of all meshes if there are no nodes. Fails if nodes form a cycle.
void for_each_mesh(const Json& root, const std::function<void(const MeshInstance&)>& use);

// The transforms of a node's EXT_mesh_gpu_instancing, relative to the node. One identity if it has none.
std::vector<Eigen::Affine3d> instances_of(File& file, const Json& node);

// The transforms of all nodes to the world, wherever they hang.
class NodeTransforms {
  public:
    explicit NodeTransforms(const Json& root);
    Eigen::Affine3d to_world(uint64_t node) const;

  private:
    const Json& root_;
    std::vector<uint64_t> parents_;  // UINT64_MAX: none
};

}  // namespace gim::gltf
