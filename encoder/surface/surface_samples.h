// Takes area-stratified points on a triangle mesh, for measuring distances and for fitting.
//
// The total area is cut into `count` equal strata along the list of triangles. Each stratum gets one jittered sample.
// Inside a triangle the samples follow a low-discrepancy sequence. Every part of the surface therefore gets its share
// to within one sample, and each sample stands for the same area. In: any mesh with an area. Cost: O(F + count). The
// number of threads does not change the result; `seed` does.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

struct SurfaceSamples {
    std::vector<Vec3> points;         // in the order of the triangles
    std::vector<uint32_t> triangles;  // the triangle that each point lies on
    std::vector<Vec2> barycentrics;   // coordinates of the second and third corner
    double area = 0;                  // of the whole surface; each sample stands for area / points.size()
};

// Returns no points if the mesh has no area.
SurfaceSamples sample_by_area(const Mesh& mesh, uint32_t count, uint64_t seed, uint32_t threads = 0);

// A well-mixed 64-bit hash. The samplers have no other source of "randomness".
inline uint64_t mix_bits(uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

}  // namespace gim
