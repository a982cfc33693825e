// Finds closest points on a triangle mesh (closest_point.h).
// In: a mesh. Out: the nearest surface point of each query. Cost: O(F log F) to build; about O(log F) for a query near
// the surface.
#include "encoder/surface/closest_point.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/surface/box_splits.h"

namespace gim {

namespace {

constexpr uint32_t kWidth = 4;  // children of a node

// ---- one triangle ---------------------------------------------------------------------------------------------------

struct Candidate {
    double squared = std::numeric_limits<double>::infinity();
    double v = 0, w = 0;  // barycentric coordinates of the second and third corner
};

struct SegmentPoint {
    double squared, t;
};

SegmentPoint nearest_on_segment(const Vec3& query, const Vec3& a, const Vec3& b) {
    const Vec3 ab = b - a;
    const double length2 = ab.squaredNorm();
    double t = length2 > 0 ? std::clamp((query - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
    if (!(t >= 0)) t = 0;
    const Vec3 offset = t == 1.0 ? Vec3(query - b) : Vec3(query - (a + t * ab));
    return {offset.squaredNorm(), t};
}

// Searches only the boundary of the triangle. This serves slivers whose normal is not reliable.
Candidate nearest_on_rim(const Vec3& query, const Vec3& a, const Vec3& b, const Vec3& c) {
    const SegmentPoint ab = nearest_on_segment(query, a, b);
    const SegmentPoint bc = nearest_on_segment(query, b, c);
    const SegmentPoint ca = nearest_on_segment(query, c, a);
    if (ab.squared <= bc.squared && ab.squared <= ca.squared) return {ab.squared, ab.t, 0};
    if (bc.squared <= ca.squared) return {bc.squared, 1 - bc.t, bc.t};
    return {ca.squared, 0, 1 - ca.t};
}

// Finds the corner, edge or face region that the query lies over. Corner results are bit-equal for all triangles of a
// vertex.
Candidate nearest_on_triangle(const Vec3& query, const Vec3& a, const Vec3& b, const Vec3& c, bool in_plane = false) {
    const Vec3 ab = b - a, ac = c - a, ap = query - a;
    const double ap_ab = ap.dot(ab), ap_ac = ap.dot(ac);
    if (ap_ab <= 0 && ap_ac <= 0) return {ap.squaredNorm(), 0, 0};

    const Vec3 bp = query - b;
    const double bp_ab = bp.dot(ab), bp_ac = bp.dot(ac);
    if (bp_ab >= 0 && bp_ac <= bp_ab) return {bp.squaredNorm(), 1, 0};

    const Vec3 cp = query - c;
    const double cp_ab = cp.dot(ab), cp_ac = cp.dot(ac);
    if (cp_ac >= 0 && cp_ab <= cp_ac) return {cp.squaredNorm(), 0, 1};

    // Signed areas of the query with each edge, times the triangle's own area. In a sliver their signs are noise.
    const double area_ab = ap_ab * bp_ac - bp_ab * ap_ac;
    const double area_ca = cp_ab * ap_ac - ap_ab * cp_ac;
    const double area_bc = bp_ab * cp_ac - cp_ab * bp_ac;
    const double area = area_ab + area_ca + area_bc;
    const double ab2 = ab.squaredNorm(), ac2 = ac.squaredNorm();
    const double size2 = std::max(ab2, ac2);
    if (!(area > 1e-11 * size2 * std::max(size2, ap.squaredNorm()))) {
        // A query far above a sound triangle loses its digits too. Its projection along the normal is searched instead.
        const Vec3 normal = ab.cross(ac);
        const double normal2 = normal.squaredNorm();
        if (in_plane || !(normal2 > 1e-11 * size2 * size2)) return nearest_on_rim(query, a, b, c);
        const Vec3 rise = (normal.dot(ap) / normal2) * normal;
        Candidate foot = nearest_on_triangle(query - rise, a, b, c, true);
        foot.squared += rise.squaredNorm();
        return foot;
    }

    if (area_ab <= 0 && ap_ab >= 0 && bp_ab <= 0) {
        const double t = ap_ab / (ap_ab - bp_ab);
        return {(ap - t * ab).squaredNorm(), t, 0};
    }
    if (area_ca <= 0 && ap_ac >= 0 && cp_ac <= 0) {
        const double t = ap_ac / (ap_ac - cp_ac);
        return {(ap - t * ac).squaredNorm(), 0, t};
    }
    const double along_b = bp_ac - bp_ab, along_c = cp_ab - cp_ac;
    if (area_bc <= 0 && along_b >= 0 && along_c >= 0) {
        const double t = along_b / (along_b + along_c);
        return {(bp - t * (c - b)).squaredNorm(), 1 - t, t};
    }
    const double v = area_ca / area, w = area_ab / area;
    return {(ap - v * ab - w * ac).squaredNorm(), v, w};
}

ClosestPoint expand(const Candidate& found, const Vec3& a, const Vec3& b, const Vec3& c) {
    const double u = std::max(0.0, 1 - found.v - found.w);
    ClosestPoint result;
    result.point = u * a + found.v * b + found.w * c;
    if (found.v == 0 && found.w == 0) result.point = a;
    result.barycentric = {u, found.v, found.w};
    result.squared_distance = found.squared;
    return result;
}

// ---- nodes ----------------------------------------------------------------------------------------------------------

struct Corners {
    Vec3 a, b, c;
};

// One value for each of the four children (GCC and Clang vector extension), in the precision that the query needs.
template <class Real>
struct Lane4;
template <>
struct Lane4<float> {
    using Type = float __attribute__((vector_size(kWidth * sizeof(float))));
};
template <>
struct Lane4<double> {
    using Type = double __attribute__((vector_size(kWidth * sizeof(double))));
};
template <class Real>
using Lanes = typename Lane4<Real>::Type;

// Writes to a reference, because there is no settled way to return a vector wider than the machine's.
template <class Real>
void load(const float* values, Lanes<Real>& lanes) {
    Lanes<float> floats;
    std::memcpy(&floats, values, sizeof floats);
    lanes = __builtin_convertvector(floats, Lanes<Real>);
}

// A query at most this many extents of the mesh away is pruned with floats. A farther one sees all boxes at nearly the
// same distance, and floats could not tell them apart.
constexpr double kFar = 32;

// Rounding of the query's coordinates, and the margin by which a box may seem too far and is still opened.
template <class Real>
struct Margin {
    static constexpr Real kQuery = Real(2.5e-7), kLimit = Real(1.00001), kLeast = Real(1e-37);
};
template <>
struct Margin<double> {
    static constexpr double kQuery = 1e-15, kLimit = 1 + 1e-12, kLeast = 1e-300;
};

// Child boxes side by side. A child is a node (count 0) or the triangles first .. first + count - 1 of the leaf order.
struct alignas(64) Node {
    float low[3][kWidth];
    float high[3][kWidth];
    uint32_t first[kWidth];
    uint8_t count[kWidth];
    uint8_t used;
};

struct Range {
    Box box;
    uint32_t begin, end, split;
};

float round_down(double x) {
    const auto f = static_cast<float>(x);
    return double{f} > x ? std::nextafter(f, -Box::kInfinity) : f;
}

float round_up(double x) {
    const auto f = static_cast<float>(x);
    return double{f} < x ? std::nextafter(f, Box::kInfinity) : f;
}

}  // namespace

// ---- the tree -------------------------------------------------------------------------------------------------------

struct ClosestPointTree::Impl {
    // Floats are in a frame around the middle of the mesh, scaled to about unit size.
    Vec3 middle = Vec3::Zero();
    double scale = 1;
    std::vector<Node> nodes;
    std::vector<Corners> corners;    // in leaf order
    std::vector<uint32_t> triangle;  // leaf order -> mesh
    std::vector<uint32_t> position;  // mesh -> leaf order

    Box box_of(const Corners& t) const {
        const Vec3 low = (t.a.cwiseMin(t.b).cwiseMin(t.c) - middle) * scale;
        const Vec3 high = (t.a.cwiseMax(t.b).cwiseMax(t.c) - middle) * scale;
        Box box;
        for (int k = 0; k < 3; ++k) {
            box.low[k] = round_down(low[k]);
            box.high[k] = round_up(high[k]);
        }
        return box;
    }

    // Chooses the frame of the floats.
    void frame(const Mesh& mesh) {
        Vec3 low = mesh.positions[mesh.triangles[0][0]], high = low;
        for (const Triangle& t : mesh.triangles) {
            for (const uint32_t v : t) {
                low = low.cwiseMin(mesh.positions[v]);
                high = high.cwiseMax(mesh.positions[v]);
            }
        }
        middle = 0.5 * low + 0.5 * high;
        const double extent = (high - low).maxCoeff();
        // A power of two, so that scaling rounds nothing.
        scale = extent > 0 && std::isfinite(extent) ? std::ldexp(1.0, -std::clamp(std::ilogb(extent), -1000, 1000)) : 1;
    }

    Box box_of_leaf(uint32_t first, uint32_t count) const {
        Box box = box_of(corners[first]);
        for (uint32_t i = 1; i < count; ++i) box.add(box_of(corners[first + i]));
        return box;
    }

    Box box_of_node(const Node& node) const {
        Box box;
        for (uint32_t k = 0; k < node.used; ++k) {
            for (int axis = 0; axis < 3; ++axis) {
                box.low[axis] = std::min(box.low[axis], node.low[axis][k]);
                box.high[axis] = std::max(box.high[axis], node.high[axis][k]);
            }
        }
        return box;
    }

    // Takes the corners of a mesh of these triangles and makes all boxes from them. The frame must be that of the mesh.
    void place(const Mesh& mesh, uint32_t threads) {
        parallel_blocks(corners.size(), 16384, threads, [&](size_t, size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                const Triangle& t = mesh.triangles[triangle[i]];
                corners[i] = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
            }
        });
        const auto set = [](Node& node, uint32_t k, const Box& box) {
            for (int axis = 0; axis < 3; ++axis) {
                node.low[axis][k] = box.low[axis];
                node.high[axis][k] = box.high[axis];
            }
        };
        parallel_blocks(nodes.size(), 1024, threads, [&](size_t, size_t begin, size_t end) {
            for (size_t i = begin; i < end; ++i) {
                for (uint32_t k = 0; k < nodes[i].used; ++k) {
                    if (nodes[i].count[k] > 0) set(nodes[i], k, box_of_leaf(nodes[i].first[k], nodes[i].count[k]));
                }
            }
        });
        // A node's children come after it.
        for (size_t i = nodes.size(); i-- > 0;) {
            for (uint32_t k = 0; k < nodes[i].used; ++k) {
                if (nodes[i].count[k] == 0) set(nodes[i], k, box_of_node(nodes[nodes[i].first[k]]));
            }
        }
    }

    // Opens the largest of up to four ranges until the node is full, then does the same below. Returns the node's
    // index.
    uint32_t collapse(const std::vector<BoxSplit>& splits, const Range& whole) {
        std::array<Range, kWidth> children{whole};
        uint32_t used = 1;
        while (used < kWidth) {
            int open = -1;
            for (uint32_t k = 0; k < used; ++k) {
                if (children[k].split == kNone) continue;
                if (open < 0 || children[k].box.half_area() > children[open].box.half_area())
                    open = static_cast<int>(k);
            }
            if (open < 0) break;
            const Range range = children[open];
            const BoxSplit& split = splits[range.split];
            children[open] = {split.left, range.begin, range.split, split.left_split};
            children[used++] = {split.right, range.split, range.end, split.right_split};
        }
        const auto index = static_cast<uint32_t>(nodes.size());
        nodes.emplace_back().used = static_cast<uint8_t>(used);
        for (uint32_t k = 0; k < used; ++k) {
            if (children[k].split != kNone) continue;
            nodes[index].count[k] = static_cast<uint8_t>(children[k].end - children[k].begin);
            nodes[index].first[k] = children[k].begin;
        }
        for (uint32_t k = 0; k < used; ++k) {
            if (children[k].split == kNone) continue;
            const uint32_t child = collapse(splits, children[k]);
            nodes[index].first[k] = child;
        }
        return index;
    }
};

ClosestPointTree::ClosestPointTree(const Mesh& mesh, uint32_t threads) : impl_(std::make_unique<Impl>()) {
    const auto count = static_cast<uint32_t>(mesh.triangles.size());
    if (count == 0) return;
    Impl& tree = *impl_;
    tree.frame(mesh);

    std::vector<BoxItem> items(count);
    parallel_blocks(count, 16384, threads, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const Triangle& t = mesh.triangles[f];
            BoxItem& item = items[f];
            item.box = tree.box_of({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
            for (int k = 0; k < 3; ++k) item.centre[k] = 0.5f * (item.box.low[k] + item.box.high[k]);
            item.triangle = static_cast<uint32_t>(f);
        }
    });
    std::vector<BoxSplit> splits;
    const uint32_t top = split_boxes(items, splits, threads);

    tree.corners.resize(count);
    tree.triangle.resize(count);
    tree.position.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
        tree.triangle[i] = items[i].triangle;
        tree.position[items[i].triangle] = i;
    }
    tree.nodes.reserve(count / 2 + 1);
    tree.collapse(splits, {bounds(items, 0, count), 0, count, top});
    tree.place(mesh, threads);
}

ClosestPointTree::~ClosestPointTree() = default;
ClosestPointTree::ClosestPointTree(ClosestPointTree&&) noexcept = default;
ClosestPointTree& ClosestPointTree::operator=(ClosestPointTree&&) noexcept = default;

namespace {

// Answers one query. Measures boxes in the precision of Real.
template <class Real, class Tree>
ClosestPoint find_in(const Tree& tree, const Vec3& query, uint32_t hint) {
    Candidate best;
    uint32_t best_triangle = kNone, best_position = 0;
    const auto try_triangle = [&](uint32_t position) {
        const Corners& t = tree.corners[position];
        const Candidate candidate = nearest_on_triangle(query, t.a, t.b, t.c);
        const uint32_t triangle = tree.triangle[position];
        if (candidate.squared < best.squared || (candidate.squared == best.squared && triangle < best_triangle)) {
            best = candidate;
            best_triangle = triangle;
            best_position = position;
        }
    };
    // Returns a little more than the best distance, in the tree's frame. Boxes with an equally near triangle then pass.
    const auto limit_of = [&](double squared) {
        return static_cast<Real>(squared * tree.scale * tree.scale) * Margin<Real>::kLimit + Margin<Real>::kLeast;
    };
    if (hint < tree.position.size()) try_triangle(tree.position[hint]);
    Real limit = limit_of(best.squared);

    // The query as an interval that allows for its own rounding, so that box distances are never too large.
    Real q_low[3], q_high[3];
    const Vec3 local = (query - tree.middle) * tree.scale;
    const auto slack = static_cast<Real>(double{Margin<Real>::kQuery} * (local.cwiseAbs().maxCoeff() + 1));
    for (int k = 0; k < 3; ++k) {
        q_low[k] = static_cast<Real>(local[k]) - slack;
        q_high[k] = static_cast<Real>(local[k]) + slack;
    }

    struct Entry {
        Real squared;
        uint32_t first;
        uint32_t count;
    };
    std::array<Entry, 256> stack;  // at most 3 waiting entries a level; box_splits.h bounds the depth by about 48 + 32
    uint32_t size = 0;
    Entry entry{0, 0, 0};
    for (;;) {
        if (entry.count > 0) {
            for (uint32_t i = entry.first; i < entry.first + entry.count; ++i) try_triangle(i);
            limit = limit_of(best.squared);
        } else {
            const Node& node = tree.nodes[entry.first];
            Lanes<Real> lanes = {0, 0, 0, 0};
            for (int axis = 0; axis < 3; ++axis) {
                Lanes<Real> low, high;
                load<Real>(node.low[axis], low);
                load<Real>(node.high[axis], high);
                const Lanes<Real> below = low - q_high[axis], above = q_low[axis] - high;
                Lanes<Real> gap = below > above ? below : above;
                gap = gap > Real(0) ? gap : Lanes<Real>{0, 0, 0, 0};
                lanes += gap * gap;
            }
            Real squared[kWidth];
            std::memcpy(squared, &lanes, sizeof squared);
            // Insertion sort of the children that are near enough. The nearest one ends on top of the stack.
            const uint32_t base = size;
            for (uint32_t k = 0; k < node.used; ++k) {
                if (!(squared[k] <= limit)) continue;
                uint32_t at = size++;
                while (at > base && stack[at - 1].squared < squared[k]) {
                    stack[at] = stack[at - 1];
                    --at;
                }
                stack[at] = {squared[k], node.first[k], node.count[k]};
            }
        }
        do {
            if (size == 0) {
                const Corners& t = tree.corners[best_position];
                ClosestPoint result = expand(best, t.a, t.b, t.c);
                result.triangle = best_triangle;
                return result;
            }
            entry = stack[--size];
        } while (entry.squared > limit);
    }
}

}  // namespace

void ClosestPointTree::refit(const Mesh& mesh, uint32_t threads) {
    Impl& tree = *impl_;
    if (tree.corners.size() != mesh.triangles.size()) {
        *this = ClosestPointTree(mesh, threads);
        return;
    }
    if (tree.nodes.empty()) return;
    tree.frame(mesh);
    tree.place(mesh, threads);
}

ClosestPoint ClosestPointTree::find(const Vec3& query, uint32_t hint) const {
    if (impl_->nodes.empty()) return {};
    const double distance = (query - impl_->middle).cwiseAbs().maxCoeff() * impl_->scale;
    return distance <= kFar ? find_in<float>(*impl_, query, hint) : find_in<double>(*impl_, query, hint);
}

std::vector<ClosestPoint> ClosestPointTree::find_all(std::span<const Vec3> queries, uint32_t threads,
                                                     std::span<const uint32_t> hints) const {
    std::vector<ClosestPoint> found(queries.size());
    parallel_blocks(queries.size(), 1024, threads, [&](size_t, size_t begin, size_t end) {
        uint32_t previous = kNone;
        for (size_t i = begin; i < end; ++i) {
            found[i] = find(queries[i], hints.empty() || hints[i] == kNone ? previous : hints[i]);
            previous = found[i].triangle;
        }
    });
    return found;
}

ClosestPoint closest_point_on_triangle(const Vec3& query, const Vec3& a, const Vec3& b, const Vec3& c) {
    return expand(nearest_on_triangle(query, a, b, c), a, b, c);
}

}  // namespace gim
