// Flattens the opened mesh into the unit square with the least L2 geometric stretch. The boundary stays fixed.
//
// Gu, Gortler, Hoppe. Geometry Images. SIGGRAPH 2002. Section 3.1, "Interior parametrization", with the hierarchical
// solver of Sander, Gortler, Snyder, Hoppe. Signal-Specialized Parametrization. EGRW 2002, section 5: coarsen the
// interior, solve, refine vertex by vertex with local optimisation. We differ in three ways: the base mesh starts from
// a Tutte map instead of brute force, the local steps are Newton steps, and whole sweeps run each time the mesh has
// grown by a fixed factor.
#pragma once

#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/progressive_mesh.h"
#include "gim/encoder.h"

namespace gim {

struct ParametrizeOptions {
    double growth = 1.2;      // sweep over all vertices whenever the mesh has grown by this factor
    int sweeps = 8;           // sweeps each time; more come closer to the optimum and take more time
    int final_sweeps = 40;    // most sweeps on the full mesh
    double tolerance = 2e-4;  // sweeping stops when a sweep gains less than this part of the energy
    // How much a squeeze counts against the stretch of the same factor. 0: not at all; samples may crowd in one direction
    // until a quantizer folds them over. 1: as much.
    double squeeze = 0;
    // Per vertex: how much the stretch around it counts. Sample density follows its square root. Empty: 1 everywhere.
    std::vector<double> importance;
};

// Maps one disk, several times if need be. It is coarsened once.
class DiskMapper {
  public:
    // In: a disk; per vertex the sides of the square that it lies on (0: interior); `uv` of the boundary,
    //     counter-clockwise. No interior edge may run along one side (boundary_map.h sees to that). Keeps a reference to the
    //     mesh.
    // Cost: about O(V log V).
    DiskMapper(const Mesh& mesh, std::vector<uint8_t> sides, std::vector<Vec2> uv);

    // Returns uv of every vertex, with every triangle counter-clockwise. If that is impossible, an Error says where.
    // Cost: about O(V log V). Deterministic.
    Result<std::vector<Vec2>> map(const ParametrizeOptions& options, const Progress& progress = {}) const;

  private:
    ProgressiveMesh coarsened_to(uint32_t interior) const;
    Result<std::vector<Vec2>> map_from(ProgressiveMesh hierarchy, const ParametrizeOptions& options,
                                       const Progress& progress) const;

    const Mesh& mesh_;
    std::vector<uint8_t> sides_;
    std::vector<Vec2> border_;
    uint32_t boundary_;  // number of vertices on it
    ProgressiveMesh coarse_;
};

// Maps a disk once, as DiskMapper does.
Result<std::vector<Vec2>> parametrize(const Mesh& mesh, const std::vector<uint8_t>& sides, std::vector<Vec2> uv,
                                      const ParametrizeOptions& options, const Progress& progress = {});

// Returns the number of triangles that are not counter-clockwise under uv.
uint64_t count_flipped(const Mesh& mesh, const std::vector<Vec2>& uv);

}  // namespace gim
