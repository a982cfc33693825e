#include "encoder/surface/normal_breaks.h"

#include <tbb/parallel_sort.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace gim {

namespace {

// Faces at an edge that are compared, each with each. Where more meet, normals tell nothing.
constexpr size_t kMostFaces = 8;
// Normals of the two sides of an edge are less exact than this, in degrees.
constexpr float kRounding = 1.5F;

// Half-edges of the input between the same places, whatever their direction, have one key.
struct Side {
    uint64_t key = 0;
    uint32_t half_edge = 0;
    bool ascends = false;  // from the lower place to the higher one
};

uint64_t key_of(uint32_t a, uint32_t b) { return uint64_t{std::min(a, b)} << 32 | std::max(a, b); }

// An edge whose normals break at one end at least.
struct Break {
    uint64_t key = 0;
    float at_lower = 0, at_higher = 0;  // degrees
};

class Breaks {
  public:
    Breaks(const TriangleMesh& input, std::span<const uint32_t> place) : shading_(input.shading) {
        for (uint32_t f = 0; f < input.triangles.size(); ++f) {
            for (uint32_t i = 0; i < 3; ++i) {
                const uint32_t a = place[input.triangles[f][i]], b = place[input.triangles[f][(i + 1) % 3]];
                if (a != b) sides_.push_back({key_of(a, b), 3 * f + i, a < b});
            }
        }
        tbb::parallel_sort(sides_.begin(), sides_.end(), [](const Side& a, const Side& b) {
            return a.key != b.key ? a.key < b.key : a.half_edge < b.half_edge;
        });
        for (size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
            while (end < sides_.size() && sides_[end].key == sides_[begin].key) ++end;
            compare(std::span(sides_).subspan(begin, end - begin));
        }
        sides_.clear();
    }

    // Lets an edge break at both ends if it breaks at one, and there one crease alone passes. Around the apex of a cone
    // many edges break.
    void continue_creases(size_t places) {
        std::vector<uint32_t> count(places, 0);
        for (const Break& b : breaks_) {
            if (b.at_lower > kRounding) ++count[lower(b)];
            if (b.at_higher > kRounding) ++count[higher(b)];
        }
        for (Break& b : breaks_) {
            if (b.at_lower <= kRounding && count[higher(b)] == 2) b.at_lower = b.at_higher;
            if (b.at_higher <= kRounding && count[lower(b)] == 2) b.at_higher = b.at_lower;
        }
    }

    float between(uint32_t a, uint32_t b) const {
        const auto found = std::lower_bound(breaks_.begin(), breaks_.end(), key_of(a, b),
                                            [](const Break& at, uint64_t key) { return at.key < key; });
        const bool is_there = found != breaks_.end() && found->key == key_of(a, b);
        return is_there ? std::min(found->at_lower, found->at_higher) : 0;
    }

  private:
    static uint32_t lower(const Break& b) { return static_cast<uint32_t>(b.key >> 32); }
    static uint32_t higher(const Break& b) { return static_cast<uint32_t>(b.key); }

    // The normals of a face at the lower and at the higher place of its edge.
    std::array<uint32_t, 2> normals_of(const Side& side) const {
        const auto& corners = shading_.corners[face_of(side.half_edge)];
        const uint32_t from = corners[side.half_edge % 3], to = corners[next(side.half_edge) % 3];
        return side.ascends ? std::array{from, to} : std::array{to, from};
    }

    // Faces that run the same way along an edge look to opposite sides, and so may their normals.
    float angle_between(uint32_t a, uint32_t b, bool is_turned) const {
        if (a == Shading::kFlat || b == Shading::kFlat) return 180;
        if (a == b) return 0;
        const auto vector = [&](uint32_t n) {
            const auto& v = shading_.normals[n];
            const Vec3 wide{double{v[0]}, double{v[1]}, double{v[2]}};
            return wide.allFinite() ? wide : Vec3(Vec3::Zero());
        };
        const Vec3 first = vector(a), second = vector(b);
        if (first.isZero(0) || second.isZero(0)) return 0;
        const double angle = std::atan2(first.cross(second).norm(), first.dot(second)) * 180 / std::numbers::pi;
        return static_cast<float>(is_turned ? std::min(angle, 180 - angle) : angle);
    }

    void compare(std::span<const Side> faces) {
        if (faces.size() < 2 || faces.size() > kMostFaces) return;
        const auto runs_as_first = [&](const Side& s) { return s.ascends == faces[0].ascends; };
        const bool all_alike = std::all_of(faces.begin(), faces.end(), runs_as_first);
        Break least{faces[0].key, 180, 180};
        for (size_t i = 0; i < faces.size(); ++i) {
            for (size_t k = i + 1; k < faces.size(); ++k) {
                if (!all_alike && faces[i].ascends == faces[k].ascends) continue;
                const auto a = normals_of(faces[i]), b = normals_of(faces[k]);
                least.at_lower = std::min(least.at_lower, angle_between(a[0], b[0], all_alike));
                least.at_higher = std::min(least.at_higher, angle_between(a[1], b[1], all_alike));
            }
        }
        if (std::max(least.at_lower, least.at_higher) > kRounding) breaks_.push_back(least);
    }

    const Shading& shading_;
    std::vector<Side> sides_;
    std::vector<Break> breaks_;  // by key, ascending
};

}  // namespace

std::vector<float> find_breaks(const TriangleMesh& input, std::span<const uint32_t> place, const Mesh& mesh,
                               std::span<const uint32_t> source_vertex) {
    if (input.shading.empty()) return {};
    Breaks breaks(input, place);
    breaks.continue_creases(place.size());
    std::vector<float> result;
    result.reserve(3 * mesh.triangles.size());
    for (uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h)
        result.push_back(breaks.between(place[source_vertex[from(mesh, h)]], place[source_vertex[to(mesh, h)]]));
    return result;
}

}  // namespace gim
