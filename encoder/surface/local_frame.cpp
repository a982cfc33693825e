#include "encoder/surface/local_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "encoder/surface/describe_mesh.h"
#include "format/container.h"

namespace gim {

namespace {

// A frame is moved only if binary32 coordinates in it are rounded this much less.
constexpr double kLeastGain = 16;

// The fit may move samples beyond the input's box, and a step has 24 bits.
constexpr double kMargin = 2;

double steps_of(uint32_t bits) { return std::exp2(bits) - 1; }

// The most by which binary32 rounds numbers up to this absolute value.
double binary32_rounding(double value) { return std::ldexp(1.0, std::ilogb(value) - 24); }

struct Bounds {
    Vec3 low = Vec3::Constant(INFINITY), high = Vec3::Constant(-INFINITY);

    void add(const Vec3& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    double extent() const { return (high - low).maxCoeff(); }
};

std::string short_text(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.3g", value);
    return text.data();
}

}  // namespace

Result<void> check_extent(std::span<const Vec3> positions, uint32_t bits, Stage stage,
                          const std::function<std::string(size_t)>& name) {
    if (positions.empty()) return {};
    Bounds bounds;
    size_t outermost = 0;
    for (size_t i = 0; i < positions.size(); ++i) {
        bounds.add(positions[i]);
        if (positions[i].cwiseAbs().maxCoeff() > positions[outermost].cwiseAbs().maxCoeff()) outermost = i;
    }
    const double farthest = double{kMaxOrigin} / kMargin;
    if (positions[outermost].cwiseAbs().maxCoeff() > farthest) {
        return Error{stage, name(outermost) + ": coordinates too large for the format, which takes up to " +
                                short_text(farthest) + "; repair the vertex, or scale the surface down"};
    }
    const double extent = bounds.extent();
    const double most = double{kMaxStep} * steps_of(bits) / kMargin,
                 least = double{kMinStep} * steps_of(bits) * kMargin;
    if (extent == 0 || (extent <= most && extent >= least)) return {};
    const bool is_large = extent > most;
    return Error{stage, name(outermost) + ": coordinates too " + (is_large ? "large" : "small") +
                            " for the format: the surface extends over " + short_text(extent) + ", and with " +
                            std::to_string(bits) + " bits " + (is_large ? "at most " : "at least ") +
                            short_text(is_large ? most : least) +
                            (is_large ? " is possible; scale it down" : " is needed; scale it up")};
}

Result<void> check_extent(const TriangleMesh& mesh, uint32_t bits) {
    std::vector<Vec3> positions;
    std::vector<uint32_t> vertices;
    std::vector<bool> seen(mesh.positions.size(), false);
    for (const auto& triangle : mesh.triangles) {
        for (const uint32_t v : triangle) {
            if (v >= mesh.positions.size()) return {};
            if (seen[v]) continue;
            seen[v] = true;
            const auto& p = mesh.positions[v];
            positions.emplace_back(p[0], p[1], p[2]);
            vertices.push_back(v);
            if (!positions.back().allFinite()) return {};
        }
    }
    const auto name = [&](size_t i) {
        return "vertex " + std::to_string(vertices[i]) + " at " + text_of(mesh.positions[vertices[i]]);
    };
    const auto is_first = [&](const Vec3& p) { return p == positions.front(); };
    if (!positions.empty() && std::all_of(positions.begin(), positions.end(), is_first)) {
        return Error{Stage::kClean, name(0) +
                                        ": all other vertices lie at the same place, so there is no surface; do its "
                                        "coordinates have too few digits?"};
    }
    return check_extent(positions, bits, Stage::kClean, name);
}

LocalFrame choose_frame(std::span<const Vec3> positions, uint32_t bits) {
    Bounds bounds;
    for (const Vec3& p : positions) bounds.add(p);
    LocalFrame frame;
    if (positions.empty() || !(bounds.extent() > 0)) return frame;
    const double extent = bounds.extent();
    const double farthest = std::max(bounds.low.cwiseAbs().maxCoeff(), bounds.high.cwiseAbs().maxCoeff());
    const bool is_rounded = binary32_rounding(farthest) > extent / steps_of(bits) / 100;
    if (!is_rounded || farthest < kLeastGain * extent) return frame;
    frame.origin = bounds.low;
    frame.is_moved = true;
    return frame;
}

void move_into(const LocalFrame& frame, std::span<Vec3> positions) {
    if (!frame.is_moved) return;
    for (Vec3& p : positions) p -= frame.origin;
}

std::optional<TriangleMesh> moved_into(const LocalFrame& frame, const TriangleMesh& mesh) {
    if (!frame.is_moved) return std::nullopt;
    TriangleMesh moved = mesh;
    for (auto& p : moved.positions) {
        for (size_t k = 0; k < 3; ++k) p[k] -= frame.origin[static_cast<int>(k)];
    }
    return moved;
}

void move_out_of(const LocalFrame& frame, EncodeReport& report) {
    if (!frame.is_moved) return;
    const auto move = [&](Defects& defects) {
        if (defects.largest_fold.faces == 0) return;
        for (size_t k = 0; k < 3; ++k) defects.largest_fold.center[k] += frame.origin[static_cast<int>(k)];
    };
    if (report.error.defects) move(*report.error.defects);
    for (LevelReport& level : report.levels) move(level.defects);
}

Observer moved_out_of(const LocalFrame& frame, const Observer& observer) {
    if (!frame.is_moved || !observer) return observer;
    return [frame, observer](const Snapshot& state) {
        Snapshot moved = state;
        for (auto& p : moved.mesh.positions) {
            for (size_t k = 0; k < 3; ++k) p[k] += frame.origin[static_cast<int>(k)];
        }
        observer(moved);
    };
}

}  // namespace gim
