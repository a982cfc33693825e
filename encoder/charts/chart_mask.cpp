#include "encoder/charts/chart_mask.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "encoder/base/disjoint_sets.h"

namespace gim {

namespace {

// Holes of at most this many samples are filled: they are inlets narrower than a sample.
constexpr size_t kLargestFilledHole = 4;

// The eight neighbours counter-clockwise from +column; bit k of a neighbourhood is neighbour k.
constexpr std::array<std::array<int, 2>, 8> kNeighbour{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}}};

// Counts the fans of triangles around a defined sample with the given neighbours. Quad q lies between neighbours 2q and
// 2q+2. It is solid if two of its three other samples are defined. Solid quads are joined across a defined neighbour
// between them.
constexpr int count_fans(uint32_t neighbours) {
    const auto bit = [&](uint32_t k) { return (neighbours >> (k % 8)) & 1; };
    const auto solid = [&](uint32_t q) { return bit(2 * q) + bit(2 * q + 1) + bit(2 * q + 2) >= 2; };
    int quads = 0, joints = 0;
    for (uint32_t q = 0; q < 4; ++q) {
        quads += solid(q % 4);
        joints += solid(q % 4) && solid((q + 1) % 4) && bit(2 * q + 2);
    }
    return quads == 4 && joints == 4 ? 1 : quads - joints;
}

// Returns whether there is one fan, and every straight neighbour shares a triangle with the sample. Without the second
// condition, a chart one sample wide could come apart unnoticed.
constexpr bool is_sound(uint32_t neighbours) {
    if (count_fans(neighbours) != 1) return false;
    const auto bit = [&](uint32_t k) { return (neighbours >> (k % 8)) & 1; };
    for (uint32_t k = 0; k < 8; k += 2) {
        if (!bit(k)) continue;
        const bool left = bit(k + 1) + bit(k + 2) >= 1, right = bit(k + 7) + bit(k + 6) >= 1;
        if (!left && !right) return false;
    }
    return true;
}

// Finds for each neighbourhood the smallest sound one that contains it. Prefers straight neighbours.
std::array<uint8_t, 256> make_repairs() {
    std::array<uint8_t, 256> repair{};
    for (uint32_t n = 0; n < 256; ++n) {
        int best = 1000;
        for (uint32_t m = 0; m < 256; ++m) {
            if ((m & n) != n || !is_sound(m)) continue;
            const uint32_t added = m & ~n;
            const int cost = 8 * std::popcount(added) + std::popcount(added & 0b10101010u);
            if (cost < best) best = cost, repair[n] = static_cast<uint8_t>(m);
        }
    }
    return repair;
}

uint32_t neighbourhood(const SampleMask& mask, int64_t column, int64_t row) {
    uint32_t bits = 0;
    for (uint32_t k = 0; k < 8; ++k)
        bits |= static_cast<uint32_t>(mask.at(column + kNeighbour[k][0], row + kNeighbour[k][1])) << k;
    return bits;
}

void fill_interior(const std::vector<Vec2>& polygon, SampleMask& mask) {
    // The columns at which the border crosses each row. The half-open rule counts a corner on the row once.
    std::vector<std::vector<double>> crossings(mask.height);
    for (size_t i = 0; i < polygon.size(); ++i) {
        Vec2 a = polygon[i], b = polygon[(i + 1) % polygon.size()];
        if (a.y() > b.y()) std::swap(a, b);
        const auto first = static_cast<int64_t>(std::ceil(a.y()));
        for (int64_t row = std::max<int64_t>(first, 0); static_cast<double>(row) < b.y() && row < mask.height; ++row) {
            crossings[static_cast<size_t>(row)].push_back(a.x() + (static_cast<double>(row) - a.y()) / (b.y() - a.y()) *
                                                                      (b.x() - a.x()));
        }
    }
    for (uint32_t row = 0; row < mask.height; ++row) {
        std::vector<double>& at = crossings[row];
        std::sort(at.begin(), at.end());
        for (size_t k = 0; k + 1 < at.size(); k += 2) {
            const double first = std::max(0.0, std::ceil(at[k])),
                         last = std::min(mask.width - 1.0, std::floor(at[k + 1]));
            for (double column = first; column <= last; ++column)
                mask.defined[size_t{row} * mask.width + static_cast<size_t>(column)] = 1;
        }
    }
}

void fill_band(const std::vector<Vec2>& polygon, double band, SampleMask& mask) {
    for (size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const Vec2 low = (a.cwiseMin(b).array() - band).ceil().cwiseMax(0),
                   high = (a.cwiseMax(b).array() + band).floor();
        const Vec2 edge = b - a;
        const double length2 = edge.squaredNorm();
        for (double row = low.y(); row <= high.y() && row < mask.height; ++row) {
            for (double column = low.x(); column <= high.x() && column < mask.width; ++column) {
                const Vec2 p(column, row);
                const double t = length2 > 0 ? std::clamp((p - a).dot(edge) / length2, 0.0, 1.0) : 0;
                if ((p - a - t * edge).squaredNorm() <= band * band)
                    mask.defined[static_cast<size_t>(row) * mask.width + static_cast<size_t>(column)] = 1;
            }
        }
    }
}

// Fills holes of at most kLargestFilledHole samples. A hole is a set of undefined samples that cannot reach the
// rectangle's rim by steps in the four directions.
void fill_small_holes(SampleMask& mask) {
    std::vector<uint8_t> seen(mask.defined.size(), 0);
    std::vector<uint32_t> piece;
    for (uint32_t start = 0; start < seen.size(); ++start) {
        if (seen[start] || mask.defined[start]) continue;
        piece.assign(1, start);
        seen[start] = 1;
        bool open = false;
        for (size_t k = 0; k < piece.size(); ++k) {
            const int64_t column = piece[k] % mask.width, row = piece[k] / mask.width;
            for (uint32_t n = 0; n < 8; n += 2) {
                const int64_t c = column + kNeighbour[n][0], r = row + kNeighbour[n][1];
                if (c < 0 || r < 0 || c >= mask.width || r >= mask.height) {
                    open = true;
                    continue;
                }
                const auto i = static_cast<uint32_t>(r * mask.width + c);
                if (!seen[i] && !mask.defined[i]) seen[i] = 1, piece.push_back(i);
            }
        }
        if (open || piece.size() > kLargestFilledHole) continue;
        for (const uint32_t i : piece) mask.defined[i] = 1;
    }
}

// Defines a sample between two pieces that only meet at a corner. Returns false if there is nothing to join.
bool join_pieces(SampleMask& mask) {
    const auto number = [&](int64_t column, int64_t row) { return static_cast<uint32_t>(row * mask.width + column); };
    DisjointSets pieces(mask.defined.size());
    for (int64_t row = 0; row < mask.height; ++row) {
        for (int64_t column = 0; column < mask.width; ++column) {
            if (mask.at(column, row) && mask.at(column + 1, row))
                pieces.unite(number(column, row), number(column + 1, row));
            if (mask.at(column, row) && mask.at(column, row + 1))
                pieces.unite(number(column, row), number(column, row + 1));
        }
    }
    bool any = false;
    for (int64_t row = 0; row + 1 < mask.height; ++row) {
        for (int64_t column = 0; column + 1 < mask.width; ++column) {
            for (const int64_t right : {0, 1}) {
                const int64_t x = column + right, y = column + 1 - right;
                if (!mask.at(x, row) || !mask.at(y, row + 1)) continue;
                if (pieces.find(number(x, row)) == pieces.find(number(y, row + 1))) continue;
                mask.defined[number(y, row)] = 1;
                pieces.unite(number(x, row), number(y, row + 1));
                any = true;
            }
        }
    }
    return any;
}

// Cuts spikes off in one pass. More passes would eat thin tips from their ends.
void cut_spikes(SampleMask& mask) {
    std::vector<uint32_t> spikes;
    for (uint32_t i = 0; i < mask.defined.size(); ++i) {
        if (is_spike(mask, i)) spikes.push_back(i);
    }
    for (const uint32_t i : spikes) {
        if (is_spike(mask, i)) mask.defined[i] = 0;
    }
}

// Crops the mask to its defined samples and moves the pose along.
void crop(ChartMask& chart) {
    const SampleMask& mask = chart.mask;
    uint32_t left = mask.width, right = 0, top = mask.height, bottom = 0;
    for (uint32_t row = 0; row < mask.height; ++row) {
        for (uint32_t column = 0; column < mask.width; ++column) {
            if (!mask.defined[size_t{row} * mask.width + column]) continue;
            left = std::min(left, column), right = std::max(right, column);
            top = std::min(top, row), bottom = std::max(bottom, row);
        }
    }
    SampleMask small{right - left + 1, bottom - top + 1, {}};
    small.defined.reserve(size_t{small.width} * small.height);
    for (uint32_t row = top; row <= bottom; ++row) {
        const auto begin = mask.defined.begin() + static_cast<std::ptrdiff_t>(size_t{row} * mask.width + left);
        small.defined.insert(small.defined.end(), begin, begin + small.width);
    }
    chart.pose.offset -= Vec2(left, top);
    chart.mask = std::move(small);
}

}  // namespace

uint64_t SampleMask::count() const {
    return static_cast<uint64_t>(std::count(defined.begin(), defined.end(), uint8_t{1}));
}

Vec2 ChartPose::operator()(const Vec2& p) const {
    const double c = scale * std::cos(angle), s = scale * std::sin(angle);
    return Vec2(c * p.x() - s * p.y(), s * p.x() + c * p.y()) + offset;
}

void dilate_to_manifold(SampleMask& mask) {
    static const std::array<uint8_t, 256> kRepair = make_repairs();
    std::vector<uint32_t> queue;
    for (uint32_t i = 0; i < mask.defined.size(); ++i) {
        if (mask.defined[i]) queue.push_back(i);
    }
    for (size_t at = 0; at < queue.size(); ++at) {
        const int64_t column = queue[at] % mask.width, row = queue[at] / mask.width;
        const uint32_t now = neighbourhood(mask, column, row);
        if (is_sound(now)) continue;
        const uint32_t added = kRepair[now] & ~now;
        for (uint32_t k = 0; k < 8; ++k) {
            const int64_t c = column + kNeighbour[k][0], r = row + kNeighbour[k][1];
            if (!((added >> k) & 1) || c < 0 || r < 0 || c >= mask.width || r >= mask.height) continue;
            mask.defined[static_cast<size_t>(r * mask.width + c)] = 1;
            // The new sample and its neighbours have to be looked at again.
            for (int64_t y = r - 1; y <= r + 1; ++y) {
                for (int64_t x = c - 1; x <= c + 1; ++x) {
                    if (mask.at(x, y)) queue.push_back(static_cast<uint32_t>(y * mask.width + x));
                }
            }
        }
    }
}

bool is_spike(const SampleMask& mask, uint32_t sample) {
    if (!mask.defined[sample]) return false;
    const uint32_t around = neighbourhood(mask, sample % mask.width, sample / mask.width);
    const auto bit = [&](uint32_t k) { return (around >> (k % 8)) & 1; };
    // Both neighbours in the only solid quad must belong to further triangles. Otherwise they would go with the tip.
    const auto in_other_triangle = [&](uint32_t k) {
        const int64_t column = sample % mask.width + kNeighbour[k % 8][0],
                      row = sample / mask.width + kNeighbour[k % 8][1];
        int quads = 0;
        for (const int64_t y : {row - 1, row}) {
            for (const int64_t x : {column - 1, column})
                quads += mask.at(x, y) + mask.at(x + 1, y) + mask.at(x, y + 1) + mask.at(x + 1, y + 1) >= 3;
        }
        return quads >= 2;
    };
    uint32_t solid = 0, only = 0, others = 0;
    for (uint32_t q = 0; q < 4; ++q) {
        const uint32_t count = bit(2 * q) + bit(2 * q + 1) + bit(2 * q + 2);
        if (count >= 2) ++solid, only = q, others = count;
    }
    if (solid != 1 || others != 2) return false;
    for (uint32_t k = 2 * only; k <= 2 * only + 2; ++k) {
        if (bit(k) && !in_other_triangle(k)) return false;
    }
    return true;
}

bool can_remove(const SampleMask& mask, uint32_t sample) {
    const int64_t column = sample % mask.width, row = sample / mask.width;
    constexpr uint32_t kInterior = 0xff;
    if (!mask.defined[sample] || neighbourhood(mask, column, row) == kInterior) return false;
    // An edge across an undefined corner would go with the sample, and the parts it joins would come apart.
    for (uint32_t k = 0; k < 8; k += 2) {
        const auto there = [&](uint32_t n) {
            return mask.at(column + kNeighbour[n % 8][0], row + kNeighbour[n % 8][1]);
        };
        if (there(k) && there(k + 2) && !there(k + 1)) return false;
    }
    uint32_t neighbours = 0;
    for (uint32_t k = 0; k < 8; ++k) {
        const int64_t c = column + kNeighbour[k][0], r = row + kNeighbour[k][1];
        if (!mask.at(c, r)) continue;
        ++neighbours;
        // Seen from the neighbour, the sample lies the other way.
        const uint32_t without = neighbourhood(mask, c, r) & ~(1u << ((k + 4) % 8));
        if (!is_sound(without)) return false;
    }
    return neighbours > 0;
}

std::vector<std::vector<uint32_t>> trace_borders(const SampleMask& mask) {
    // Every border sample has one border edge out and one in. Walk a quad's triangles counter-clockwise (x is the
    // column, y is the row): an edge is on the border if its reverse belongs to no other triangle.
    const auto solid = [&](int64_t column, int64_t row) {  // the quad with first corner (column, row)
        return mask.at(column, row) + mask.at(column + 1, row) + mask.at(column, row + 1) +
                   mask.at(column + 1, row + 1) >=
               3;
    };
    const auto number = [&](int64_t column, int64_t row) { return static_cast<uint32_t>(row * mask.width + column); };
    std::vector<uint32_t> following(mask.defined.size(), kNone);
    for (int64_t row = -1; row < mask.height; ++row) {
        for (int64_t column = -1; column < mask.width; ++column) {
            if (!solid(column, row)) continue;
            // The corners counter-clockwise, and for each the quad beyond the edge to the next corner.
            const std::array<std::array<int64_t, 2>, 4> corner{
                {{column, row}, {column + 1, row}, {column + 1, row + 1}, {column, row + 1}}};
            const std::array<std::array<int64_t, 2>, 4> beyond{
                {{column, row - 1}, {column + 1, row}, {column, row + 1}, {column - 1, row}}};
            for (size_t k = 0; k < 4; ++k) {
                const auto &a = corner[k], &b = corner[(k + 1) % 4], &c = corner[(k + 2) % 4];
                if (!mask.at(a[0], a[1])) continue;
                if (!mask.at(b[0], b[1])) {
                    following[number(a[0], a[1])] = number(c[0], c[1]);  // the diagonal of three
                } else if (!solid(beyond[k][0], beyond[k][1])) {
                    following[number(a[0], a[1])] = number(b[0], b[1]);
                }
            }
        }
    }
    std::vector<std::vector<uint32_t>> loops;
    std::vector<uint8_t> seen(following.size(), 0);
    for (uint32_t start = 0; start < following.size(); ++start) {
        if (seen[start] || following[start] == kNone) continue;
        loops.emplace_back();
        for (uint32_t at = start; at != kNone && !seen[at]; at = following[at]) {
            seen[at] = 1;
            loops.back().push_back(at);
        }
    }
    return loops;
}

bool mask_is_disk(const SampleMask& mask) {
    int64_t euler = 0;
    uint32_t first = kNone;
    for (uint32_t i = 0; i < mask.defined.size(); ++i) {
        if (!mask.defined[i]) continue;
        const int64_t column = i % mask.width, row = i / mask.width;
        const uint32_t around = neighbourhood(mask, column, row);
        if (count_fans(around) != 1) return false;
        first = std::min(first, i);
        // Count the vertex, and the edges to +column and +row if a triangle has them.
        const auto bit = [&](uint32_t k) { return ((around >> k) & 1) != 0; };
        const auto solid = [&](uint32_t q) { return bit(2 * q) + bit((2 * q + 1) % 8) + bit((2 * q + 2) % 8) >= 2; };
        ++euler;
        euler -= bit(0) && (solid(0) || solid(3));
        euler -= bit(2) && (solid(0) || solid(1));
    }
    if (first == kNone) return false;
    // A quad of four samples has two triangles and one diagonal. A quad of three has one triangle and one diagonal.
    for (int64_t row = 0; row + 1 < mask.height; ++row) {
        for (int64_t column = 0; column + 1 < mask.width; ++column) {
            euler += mask.at(column, row) + mask.at(column + 1, row) + mask.at(column, row + 1) +
                         mask.at(column + 1, row + 1) ==
                     4;
        }
    }
    // A manifold of several pieces may add up to 1 too. So its border must be one loop; no piece can be closed.
    return euler == 1 && trace_borders(mask).size() == 1;
}

ChartMask rasterize_chart(const std::vector<Vec2>& border, double scale, double angle) {
    ChartPose pose{scale, angle, Vec2::Zero()};
    Vec2 low = pose(border[0]);
    for (const Vec2& p : border) low = low.cwiseMin(pose(p));
    pose.offset = -low;
    return rasterize_chart_on_lattice(border, pose);
}

ChartMask rasterize_chart_on_lattice(const std::vector<Vec2>& border, const ChartPose& pose, double band) {
    ChartMask chart;
    chart.pose = pose;
    std::vector<Vec2> polygon;
    polygon.reserve(border.size());
    for (const Vec2& p : border) polygon.push_back(pose(p));
    Vec2 low = polygon[0], high = low;
    for (const Vec2& p : polygon) low = low.cwiseMin(p), high = high.cwiseMax(p);
    const double margin = std::ceil(band) + 2;  // room for the band and the dilation
    const Vec2 shift = Vec2(margin, margin) - Vec2(low.array().floor());
    chart.pose.offset += shift;
    for (Vec2& p : polygon) p += shift;
    const Vec2 extent = (high + shift).array().ceil() + margin + 1;
    chart.mask.width = static_cast<uint32_t>(extent.x());
    chart.mask.height = static_cast<uint32_t>(extent.y());
    chart.mask.defined.assign(size_t{chart.mask.width} * chart.mask.height, 0);
    fill_interior(polygon, chart.mask);
    fill_band(polygon, band, chart.mask);
    if (chart.mask.count() == 0) {  // the chart lies between the samples
        chart.mask = {};
        return chart;
    }
    dilate_to_manifold(chart.mask);
    for (bool again = true; again;) {
        fill_small_holes(chart.mask);
        again = join_pieces(chart.mask);
        dilate_to_manifold(chart.mask);
    }
    cut_spikes(chart.mask);
    trim(chart);
    return chart;
}

void trim(ChartMask& chart) {
    crop(chart);
    chart.is_disk = mask_is_disk(chart.mask);
    chart.defined = static_cast<uint32_t>(chart.mask.count());
    const auto loops = trace_borders(chart.mask);
    chart.border_length = loops.empty() ? 0 : static_cast<uint32_t>(loops[0].size());
}

}  // namespace gim
