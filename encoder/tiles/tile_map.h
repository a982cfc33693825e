// Maps a surface one to one to the tiles of its base mesh, with little L2 stretch.
//
// After: Maximo, Velho, Siqueira. Adaptive Multi-Chart and Multiresolution Mesh Representation. Computers & Graphics
// 2014, section 4.1: the removed vertices' parametrization is carried along the hierarchy. We differ: nothing is carried
// while the mesh is coarsened. The map is made from coarse to fine, as on the square (squares/parametrize.h; Sander,
// Gortler, Snyder, Hoppe 2002), on the flat surface with cones that the tiles are (flat_mesh.h). Each vertex that comes
// back gets a place inside its star, so no triangle is ever flipped, and the borders of tiles move over the surface like
// everything else. The corners of tiles are vertices of the surface. They move from vertex to vertex, except on creases
// and boundaries. These lie on borders. A vertex without room on its border waits beside it, in a fringe beyond the
// boundaries too (TileWalker::with_fringe), until finer faces make room.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/surface/mesh.h"
#include "encoder/tiles/base_mesh.h"
#include "format/quad_complex.h"

namespace gim {

struct TileMapOptions {
    double growth = 1.2;      // sweep over all vertices whenever the mesh has grown by this factor
    int sweeps = 8;           // sweeps each time; more come closer to the optimum and take more time
    int final_sweeps = 40;    // most sweeps on the full mesh
    double tolerance = 2e-4;  // sweeping stops when a sweep gains less than this part of the energy
    // How much a squeeze counts against the stretch of the same factor (ParametrizeOptions).
    double squeeze = 0.2;
    // Per vertex: how much the stretch around it counts. Sample density follows its square root. Empty: 1 everywhere.
    std::vector<double> importance;
};

// A place on a tile. Corner 0 is at (0, 0), corner 1 at (1, 0), corner 2 at (1, 1), corner 3 at (0, 1).
struct TilePlace {
    uint32_t tile = kNone;
    Vec2 uv = Vec2::Zero();
};

// A triangle of the surface in the plane. The unit square is the tile, and contains the centroid.
struct TileTriangle {
    std::array<Vec2, 3> corners;
    uint32_t tile = 0;  // numbers from the count of tiles on are the fringe
};

struct TileMap {
    std::vector<Quad> quads;           // as given; but see `swapped`
    std::vector<Triangle> triangles;   // those of the mesh, in their order, unless vertices are left out
    std::vector<TileTriangle> placed;  // per triangle: counter-clockwise; edges are as long as on the other side
    std::vector<TilePlace> places;     // per vertex; of several tiles that share it, any one
    std::vector<uint32_t> left_out;    // vertices without a place: the triangles do without them
    size_t stray = 0;                  // vertices of creases and boundaries that lie beside the borders of their tiles
    uint32_t swapped = 0;              // vertices that took a base vertex's place at the corners of tiles
};

// In:  the mesh, its base mesh (base_mesh.h), and tiles made of the base triangles.
// Cost: about O(V log V); some seconds for 100,000 faces. Deterministic.
Result<TileMap> map_tiles(const Mesh& dense, const BaseMesh& base, const std::vector<Quad>& quads,
                          const TileMapOptions& options, const Progress& progress = {});

// Returns 1 / (normalised L2 stretch)^2 of the map (stretch_efficiency() of stretch.h).
double stretch_efficiency(const std::vector<Vec3>& positions, const TileMap& map);

}  // namespace gim
