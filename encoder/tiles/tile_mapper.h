// Optimises the map of a surface onto its tiles, while the surface is refined step by step. The steps of tile_map.h.
#pragma once

#include <array>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/surface/face_metrics.h"
#include "encoder/surface/stretch.h"
#include "encoder/tiles/flat_mesh.h"
#include "format/quad_complex.h"

namespace gim {

// What a vertex may do.
enum class Freedom : uint8_t {
    kFree,
    kSlides,  // along the border of a tile
    kStray,   // belongs to such a border, but had no place there yet
    kPinned,  // to a corner of tiles
};

class TileMapper {
  public:
    // mesh, kinds and quads must outlive this. freedom: per vertex. The corners of the quads are pinned.
    TileMapper(FlatMesh& mesh, const std::vector<VertexKind>& kinds, FaceMetrics metrics, std::vector<Freedom> freedom,
               std::vector<Quad>& quads);

    // Makes one pass over all vertices. Returns the energy gained, as a part of the energy that is left.
    double sweep();
    void sweep_until(int most, double tolerance);

    // Brings a vertex back. ring: of the split (FlatMesh::split). Returns false, and changes nothing, if there is no
    // place for it.
    bool insert(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring);

    // Does the same. If there is no place, neighbours move to make room.
    bool insert_with_help(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring);

    // Moves corners of tiles over the surface to neighbours where that lowers the energy. Corners on creases and
    // boundaries stay. Returns how many moved.
    size_t move_corners();

    uint32_t swapped() const { return swapped_; }
    size_t stray() const;

  private:
    // Two neighbours, the vertices around them, and the faces at all of these.
    struct Patch {
        std::vector<uint32_t> vertices, faces;
        std::vector<FlatFace> before;
    };
    struct Neighbour {
        uint32_t vertex;
        Vec2 place;          // from the star's vertex
        uint32_t half_edge;  // leaves the neighbour, in a face of the star
        uint32_t quarters;   // as that of the face (Spoke)
    };

    void refresh_metrics(uint32_t v);
    void load_star(uint32_t v);
    int axis_of(uint32_t v) const { return freedom_[v] == Freedom::kSlides ? mesh_.side_axis(v) : kAnyDirection; }
    StarDescent relax(uint32_t v, int steps);

    bool insert_after_bend(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring);
    bool insert_after_move(const HalfEdgeCollapse& collapse, const std::vector<uint32_t>& ring);
    bool find_place(uint32_t v, uint32_t into);
    bool place_from(const Vec2& start, bool open);
    bool place_between(uint32_t v, const Vec2& first, const Vec2& last);
    bool find_place_beside(const HalfEdgeCollapse& collapse);
    bool is_upright(const Vec2& x) const;
    bool winds_once(const Vec2& x, double angle) const;

    std::vector<Neighbour> neighbours_on_side(const std::vector<Spoke>& star) const;
    void assign_side(uint32_t v);
    uint32_t side_between(uint32_t a, uint32_t b) const;
    std::optional<Vec2> way_along_side(uint32_t v, const Neighbour& neighbour) const;
    std::optional<Vec2> way_from_corner(const Neighbour& neighbour, uint32_t side) const;
    std::optional<Vec2> way_past(const Neighbour& neighbour, uint32_t v) const;
    void return_to_side(uint32_t v);
    void approach(const Vec2& way);

    bool swap(const HalfEdgeCollapse& collapse);
    bool trade_places(uint32_t v, uint32_t w, Freedom freedom);
    void rename_corner(uint32_t from, uint32_t to);

    std::vector<uint32_t> corners_of_tiles() const;
    size_t sides_at(uint32_t v) const;
    std::vector<uint32_t> successors_of(uint32_t w);
    bool move_corner(uint32_t w);
    bool exchange(uint32_t v, uint32_t w);
    Patch patch_around(uint32_t v, uint32_t w) const;
    double energy_of(const Patch& patch) const;
    void settle(const Patch& patch);
    void restore(const Patch& patch);

    FlatMesh& mesh_;
    const std::vector<VertexKind>& kinds_;
    FaceMetrics metrics_;
    std::vector<FaceMetric> metric_;
    std::vector<Freedom> freedom_;
    std::vector<uint32_t> side_;  // per vertex that slides or is stray: a half-edge of the tiles, kNone if unknown
    std::vector<Quad>& quads_;
    std::vector<Spoke> spokes_;
    std::vector<StarTriangle> star_;
    uint32_t swapped_ = 0;
};

}  // namespace gim
