// Flattens the opened mesh into the unit square with the least L2 geometric stretch, its boundary held fixed.
//
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.1, "Interior parametrization", with the hierarchical
// solver of Sander, Gortler, Snyder, Hoppe. Signal-Specialized Parametrization. EGRW 2002, section 5: coarsen the
// interior, solve, refine vertex by vertex with local optimisation. We differ in that the base mesh starts from a Tutte
// map instead of brute force, that the local steps are Newton steps, and that whole sweeps are made each time the mesh
// has grown by a fixed factor.
#pragma once

#include <vector>

#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct ParametrizeOptions {
    double growth = 1.2;      // sweep over all vertices whenever the mesh has grown by this factor
    int sweeps = 8;           // sweeps each time; more come closer to the optimum, time grows with it
    int final_sweeps = 40;    // at most, on the full mesh
    double tolerance = 2e-4;  // stop sweeping when a sweep gains less than this part of the energy
    // Per vertex: how much its surroundings' stretch counts. Sample density follows the square root. Empty: 1 everywhere.
    std::vector<double> importance;
};

// In:  a disk; per vertex the sides of the square it lies on (0: interior); `uv` with the boundary's positions set, the
//      boundary counter-clockwise, no interior edge along one side (boundary_map.h takes care of that).
// Out: uv of every vertex; every triangle counter-clockwise. Fails, naming the triangle, when that cannot be had.
// Cost: about O(V log V). Deterministic.
Result<std::vector<Vec2>> parametrize(const Mesh& mesh, const std::vector<uint8_t>& sides, std::vector<Vec2> uv,
                                      const ParametrizeOptions& options, const Progress& progress = {});

// Triangles that are not counter-clockwise under uv.
uint64_t count_flipped(const Mesh& mesh, const std::vector<Vec2>& uv);

}  // namespace gim
