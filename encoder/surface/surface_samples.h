// Area-stratified points on a triangle mesh, for measuring distances and for fitting.
//
// The total area is cut into `count` equal strata along the list of triangles, and each stratum gets one jittered
// sample; inside a triangle the samples follow a low-discrepancy sequence. So every part of the surface gets its share
// to within one sample, and each sample stands for the same area. In: any mesh with an area. Cost: O(F + count). The
// same for any number of threads; only `seed` changes it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/surface/mesh.h"

namespace gim {

struct SurfaceSamples {
    std::vector<Vec3> points;         // in the order of the triangles
    std::vector<uint32_t> triangles;  // the one that each point is on
    std::vector<Vec2> barycentrics;   // of the second and third corner
    double area = 0;                  // of the whole surface; area / points.size() for each sample
};

// No points when the mesh has no area.
SurfaceSamples sample_by_area(const Mesh& mesh, uint32_t count, uint64_t seed, uint32_t threads = 0);

// A well-mixed 64-bit hash: the one source of "randomness" of the samplers.
inline uint64_t mix_bits(uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

}  // namespace gim
