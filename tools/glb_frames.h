// Frames of tangent, bitangent and normal: of decoded arrays, and of the primitives of a glTF file.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "tools/glb_geometry.h"
#include "tools/gltf_primitive.h"

namespace gim::gltf {

// A point of decoded arrays.
struct FrameAt {
    Eigen::Vector3d position, normal;  // unit normal
    Eigen::Matrix3d axes;              // tangent, bitangent, normal as columns; zero without tangents
    double spacing = 0;                // about the size of the triangle
};
FrameAt frame_at(const PrimitiveArrays& arrays, uint32_t triangle, const std::array<float, 3>& weights);

// The frames of a primitive for the textures of one set of coordinates: its TANGENT and NORMAL, or what its triangles
// tell.
class InputFrames {
  public:
    InputFrames(Primitive& primitive, const std::string& texcoord_set);

    // The axes, as above, at a point of a triangle of these rows.
    Eigen::Matrix3d axes(const std::array<uint32_t, 3>& rows, const std::array<double, 3>& weights) const;

  private:
    std::vector<Eigen::Vector3d> normals_, tangents_;  // of each row
    std::vector<double> signs_;
};

}  // namespace gim::gltf
