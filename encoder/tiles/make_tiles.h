// Runs the stages of the tiles: from a clean mesh to a sampled and fitted image on a base mesh of quads.
// Maximo, Velho, Siqueira. Adaptive Multi-Chart and Multiresolution Mesh Representation. 2013. Section 4.
#pragma once

#include <optional>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/image/geometry_image.h"
#include "encoder/image/rails.h"
#include "encoder/surface/authored_edges.h"
#include "encoder/surface/mesh.h"
#include "encoder/tiles/tile_base.h"
#include "encoder/tiles/tile_image.h"
#include "gim/encoder.h"

namespace gim {

// What does not depend on the number of tiles.
struct TileableSurface {
    TileInput input;
    BaseHierarchy hierarchy;
};
// mesh: clean. creases: per half-edge 3f+i whether its edge is one that tiles keep; empty: none is. O(F log F).
TileableSurface make_tileable(const Mesh& mesh, const std::vector<bool>& creases);

// A surface for all runs, with its creases and without. Each is made when it is asked for first.
class TileableSurfaces {
  public:
    // Keeps references to its arguments. authored: what the input's normals say of the mesh's edges.
    TileableSurfaces(const Mesh& mesh, const AuthoredEdges& authored) : mesh_(mesh), authored_(authored) {}

    bool has_creases();
    uint64_t hard_edges() const { return authored_.kept; }  // of the creases, those that the input's normals name
    const TileableSurface& of(bool with_creases);

  private:
    const std::vector<bool>& creases();

    const Mesh& mesh_;
    const AuthoredEdges& authored_;
    std::optional<std::vector<bool>> creases_;
    std::optional<TileableSurface> creased_, smooth_;
};

struct MadeTiles {
    TileImage tiles;
    GeometryImage atlas;  // of the tiles, as atlas_of() lays them out
    Rails rails;          // of the atlas: creases on borders of tiles
    double stretch_efficiency = 0;
    uint64_t folds_before_fit = 0;
};

// In:  what make_tileable() makes of a clean mesh with any number of components, boundaries and handles, and that mesh.
// Out: about options.tiles (not 0) tiles, as fine as options.samples allows.
// Cost: O(F log F), and the fit.
Result<MadeTiles> make_tiles(const TileableSurface& surface, const Mesh& mesh, const EncodeOptions& options,
                             StageClock& clock);

}  // namespace gim
