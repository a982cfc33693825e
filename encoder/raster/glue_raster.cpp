#include "encoder/raster/glue_raster.h"

#include <cmath>
#include <cstdlib>

#include "encoder/raster/cell_index.h"
#include "format/chart_ramp.h"

namespace gim {
namespace {

constexpr int64_t kSideBySide = 1;  // samples

// The first samples of points, by where they are.
class PointIndex {
  public:
    PointIndex(uint32_t width, const std::vector<Vec3>& positions, double tolerance)
        : width_(width), positions_(positions), tolerance_(tolerance), cells_(tolerance > 0 ? 2 * tolerance : 1) {}

    // Returns the nearest one within the tolerance; kNone if there is none.
    uint32_t nearest(uint32_t sample) const {
        uint32_t best = kNone;
        double least = INFINITY;
        cells_.for_each_near(positions_[sample], [&](uint32_t other) {
            const double distance = (positions_[other] - positions_[sample]).norm();
            if (distance > tolerance_ || distance >= least || (distance > 0 && lie_side_by_side(sample, other))) return;
            best = other;
            least = distance;
        });
        return best;
    }
    void add(uint32_t sample) { cells_.add(positions_[sample], sample); }

  private:
    bool lie_side_by_side(uint32_t a, uint32_t b) const {
        return std::abs(int64_t{a / width_} - int64_t{b / width_}) <= kSideBySide &&
               std::abs(int64_t{a % width_} - int64_t{b % width_}) <= kSideBySide;
    }

    uint32_t width_;
    const std::vector<Vec3>& positions_;
    double tolerance_;
    CellIndex cells_;
};

void find_depths(const RasterImage& image, RasterGluing& g) {
    const uint32_t w = image.width, h = image.height;
    const auto is_defined = [&](uint32_t r, uint32_t c) { return r < h && c < w && image.defined[size_t{r} * w + c]; };
    g.depth.assign(image.defined.size(), kUndefined);
    for (uint32_t r = 0; r < h; ++r) {
        for (uint32_t c = 0; c < w; ++c) {
            if (!is_defined(r, c)) continue;
            const bool is_inside =
                is_defined(r - 1, c) && is_defined(r + 1, c) && is_defined(r, c - 1) && is_defined(r, c + 1);
            g.depth[size_t{r} * w + c] = is_inside ? kInside : kOnBorder;
            ++g.defined;
            g.border += is_inside ? 0 : 1;
        }
    }
}

uint32_t count_pieces(const RasterGluing& g, uint32_t width, uint32_t height) {
    std::vector<uint8_t> seen(g.depth.size(), 0);
    std::vector<uint32_t> queue;
    uint32_t pieces = 0;
    const auto visit = [&](uint32_t i) {
        if (seen[i] || g.depth[i] == kUndefined) return;
        seen[i] = 1;
        queue.push_back(i);
    };
    for (uint32_t start = 0; start < seen.size(); ++start) {
        visit(start);
        pieces += queue.empty() ? 0 : 1;
        while (!queue.empty()) {
            const uint32_t i = queue.back(), row = i / width, column = i % width;
            queue.pop_back();
            if (row > 0) visit(i - width);
            if (row + 1 < height) visit(i + width);
            if (column > 0) visit(i - 1);
            if (column + 1 < width) visit(i + 1);
        }
    }
    return pieces;
}

}  // namespace

void number_points(RasterGluing& g) {
    const auto count = static_cast<uint32_t>(g.depth.size());
    g.point.assign(count, kNone);
    g.is_shared.assign(count, 0);
    g.points = 0;
    g.open = 0;
    for (uint32_t i = 0; i < count; ++i) {
        if (g.depth[i] == kUndefined) continue;
        const uint32_t first = g.origin[i];
        if (first != i) g.is_shared[i] = g.is_shared[first] = 1;
        g.point[i] = first == i ? g.points++ : g.point[first];
    }
    for (uint32_t i = 0; i < count; ++i) g.open += g.depth[i] == kOnBorder && !g.is_shared[i] ? 1 : 0;
}

RasterGluing glue_raster(const RasterImage& image, const std::vector<Vec3>& positions, double tolerance) {
    RasterGluing g;
    find_depths(image, g);
    g.pieces = count_pieces(g, image.width, image.height);
    const auto count = static_cast<uint32_t>(g.depth.size());
    g.origin.resize(count);
    PointIndex index(image.width, positions, tolerance);
    for (uint32_t i = 0; i < count; ++i) {
        g.origin[i] = i;
        if (g.depth[i] != kOnBorder) continue;
        const uint32_t other = index.nearest(i);
        if (other == kNone) {
            index.add(i);
        } else {
            g.origin[i] = other;
        }
    }
    number_points(g);
    return g;
}

}  // namespace gim
