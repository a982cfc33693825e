#pragma once
#include <cstdint>
#include <vector>
#include "encoder/surface/mesh.h"
namespace gim {
struct HalfEdgeCollapse { uint32_t vertex, into, left, right; };
struct BaseMesh {
    std::vector<Triangle> triangles;
    std::vector<HalfEdgeCollapse> collapses;
    std::vector<std::array<uint32_t, 2>> creases;
};
}
