// Finds what a person sees wrong in a surface whose distances are small: faces folded over, edges folded back, wrong
// shading. gim/encoder.h, Defects, has the definitions.
//
// In: two meshes of any topology, closest points between them. Cost: O(F log F), that of a closest point for each face, and
// O(samples). The number of threads does not change the result.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/surface/closest_point.h"
#include "encoder/surface/mesh.h"
#include "encoder/surface/surface_samples.h"
#include "gim/encoder.h"

namespace gim {

// Points of one surface, each with the closest point of the other one.
struct PairedSamples {
    SurfaceSamples samples;
    std::vector<ClosestPoint> found;
};

// Returns for each face of `test` whether it looks away from the face of the reference that is nearest to its centroid.
// A face without area does not.
std::vector<uint8_t> find_folded_faces(const Mesh& test, const Mesh& reference, const ClosestPointTree& tree,
                                       uint32_t threads);

// Returns the edges of exactly two faces that meet at more than 150 degrees between their normals. Vertices at equal
// positions count as one; the edges name the first of them.
std::vector<std::array<uint32_t, 2>> find_folded_back_edges(const Mesh& mesh);

// Groups the folded faces that hang together by corners; corners at equal positions are one. Returns the group of the
// largest area.
Defects::Fold find_largest_fold(const Mesh& mesh, const std::vector<uint8_t>& folded);

// What defects need to know of a surface.
struct DefectTraits {
    std::vector<Vec3> normals;       // shading normals, weighted by angle
    uint64_t folded_back_edges = 0;  // see find_folded_back_edges()
};
DefectTraits defect_traits(const Mesh& mesh);

// A reference, prepared for many comparisons.
struct DefectReference {
    const Mesh& mesh;
    const ClosestPointTree& tree;
    const DefectTraits& traits;
};

// Measures the defects of `test` but for the two figures over the RMS distance. from_test, from_reference: samples on
// that surface.
Defects measure_defects(const Mesh& test, const DefectReference& reference, const PairedSamples& from_test,
                        const PairedSamples& from_reference, uint32_t threads);

// Does what map_defects() does.
DefectMap locate_defects(const Mesh& test, const Mesh& reference, const ClosestPointTree& tree, uint32_t threads);

// Returns the smallest value that at least `part` of the values do not exceed. values: not empty; reordered.
double percentile(std::vector<double>& values, double part);

}  // namespace gim
