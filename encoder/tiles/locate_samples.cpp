#include "encoder/tiles/locate_samples.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <unordered_map>

#include "encoder/surface/closest_point.h"
#include "encoder/surface/stretch.h"
#include "encoder/tiles/code_complex.h"
#include "encoder/tiles/tile_walk.h"

namespace gim {

namespace {

// Barycentric coordinates may go down to this. Otherwise rounding could leave a sample on an edge without a triangle.
constexpr double kRounding = -1e-6;

class Locator {
  public:
    Locator(const TileWalker& walker, const TileSamples& samples, uint32_t side)
        : walker_(walker), samples_(samples), side_(side), found_(samples.count()), best_(samples.count(), kRounding) {}

    // Takes the samples that triangle f covers.
    void convert(uint32_t f, const TileTriangle& triangle) {
        const double n = side_;
        const Vec2 a = triangle.corners[0] * n, b = triangle.corners[1] * n, c = triangle.corners[2] * n;
        const double area = twice_signed_area(a, b, c);
        const Vec2 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
        for (double row = std::ceil(low.y()); row <= high.y(); ++row) {
            for (double column = std::ceil(low.x()); column <= high.x(); ++column) {
                const Vec2 p(column, row);
                const std::array<double, 3> w{twice_signed_area(p, b, c) / area, twice_signed_area(a, p, c) / area,
                                              twice_signed_area(a, b, p) / area};
                const double least = std::min({w[0], w[1], w[2]});
                if (least < kRounding) continue;
                const uint32_t sample = sample_at(triangle, (a + b + c) / (3 * n), p / n);
                if (sample == kNone || least <= best_[sample]) continue;
                best_[sample] = least;
                found_[sample] = {f, w};
            }
        }
    }

    // Gives samples that no triangle covers to the nearest one within `reach` intervals.
    void approach(uint32_t f, const TileTriangle& triangle, double reach) {
        const double n = side_;
        const Vec2 a = triangle.corners[0] * n, b = triangle.corners[1] * n, c = triangle.corners[2] * n;
        const Vec2 low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
        const auto in_space = [](const Vec2& p) { return Vec3(p.x(), p.y(), 0); };
        for (double row = std::ceil(low.y() - reach); row <= high.y() + reach; ++row) {
            for (double column = std::ceil(low.x() - reach); column <= high.x() + reach; ++column) {
                const Vec2 p(column, row);
                const ClosestPoint closest =
                    closest_point_on_triangle(in_space(p), in_space(a), in_space(b), in_space(c));
                const uint32_t sample = sample_at(triangle, (a + b + c) / (3 * n), p / n);
                const double distance = (closest.point - in_space(p)).norm();
                if (sample == kNone || distance > reach || distance >= far_[sample]) continue;
                far_[sample] = distance;
                found_[sample] = {f, closest.barycentric};
            }
        }
    }
    // Calls for approach(): samples that have a triangle keep it.
    bool is_complete() {
        far_.assign(found_.size(), HUGE_VAL);
        for (size_t i = 0; i < found_.size(); ++i) {
            if (found_[i].triangle != kNone) far_[i] = 0;
        }
        return std::find(far_.begin(), far_.end(), HUGE_VAL) == far_.end();
    }

    std::vector<SurfacePoint>& found() { return found_; }

  private:
    uint32_t sample_at(const TileTriangle& triangle, const Vec2& inside, const Vec2& p) const {
        const auto frame = walker_.walk(triangle.tile, inside, p);
        if (!frame) return kNone;
        const Vec2 at = (*frame)(p)*side_;
        if (frame->tile >= walker_.complex_tiles())  // of the fringe: only its side 0 lies on the complex
            return at.y() == 0 ? samples_.along(walker_.mate(4 * frame->tile), side_ - static_cast<uint32_t>(at.x()))
                               : kNone;
        return samples_.at(frame->tile, static_cast<uint32_t>(at.y()), static_cast<uint32_t>(at.x()));
    }

    const TileWalker& walker_;
    const TileSamples& samples_;
    uint32_t side_;
    std::vector<SurfacePoint> found_;
    std::vector<double> best_;  // least barycentric coordinate so far
    std::vector<double> far_;   // how far from its triangle
};

}  // namespace

NumberedQuads number_quads(const std::vector<Quad>& quads) {
    NumberedQuads result{quads, {}};
    std::unordered_map<uint32_t, uint32_t> number;
    for (Quad& quad : result.quads) {
        for (uint32_t& v : quad) {
            const auto [known, fresh] = number.try_emplace(v, static_cast<uint32_t>(result.vertices.size()));
            if (fresh) result.vertices.push_back(v);
            v = known->second;
        }
    }
    return result;
}

Result<std::vector<SurfacePoint>> locate_samples(const TileMap& map, uint32_t side) {
    const auto [quads, vertices] = number_quads(map.quads);
    GIM_TRY(complex, complex_of(quads, static_cast<uint32_t>(vertices.size())));
    const QuadComplex& view = complex.view();
    const TileSamples samples(view, side);
    const TileWalker walker = TileWalker::with_fringe(view);
    Locator locator(walker, samples, side);
    for (uint32_t f = 0; f < map.placed.size(); ++f) locator.convert(f, map.placed[f]);

    // Beside a vertex of a boundary that lies inside its tile.
    for (double reach = 1; !locator.is_complete() && reach <= side; reach *= 2) {
        for (uint32_t f = 0; f < map.placed.size(); ++f) locator.approach(f, map.placed[f], reach);
    }

    std::vector<SurfacePoint>& found = locator.found();
    std::vector<uint32_t> corner_of(map.places.size(), kNone);
    for (uint32_t v = 0; v < vertices.size(); ++v) corner_of[vertices[v]] = v;
    for (uint32_t f = 0; f < map.triangles.size(); ++f) {
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t corner = corner_of[map.triangles[f][i]];
            if (corner == kNone) continue;
            found[corner] = {f, {}};
            found[corner].barycentric[i] = 1;
        }
    }
    for (uint32_t sample = 0; sample < found.size(); ++sample) {
        if (found[sample].triangle == kNone)
            return Error{Stage::kSample, "sample " + std::to_string(sample) +
                                             " of the tiles has no triangle; this is an error of the program"};
    }
    return found;
}

}  // namespace gim
