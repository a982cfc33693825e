#include "encoder/squares/make_squares.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "encoder/squares/choose_cut.h"
#include "encoder/squares/make_square.h"
#include "encoder/squares/share_sides.h"
#include "encoder/surface/refine.h"
#include "encoder/surface/topology_summary.h"

namespace gim {

namespace {

// Makes the image. Doubles its side, up to `most`, if the cut needs more room than the component's area deserves.
Result<MadeSquare> make_roomy_square(const Mesh& mesh, EncodeOptions options, uint32_t most,
                                     const CutPreference& preference, StageClock& clock, const Observer& observer) {
    for (;; options.side = 2 * (options.side - 1) + 1) {
        auto square = make_square(mesh, options, preference, clock, observer);
        if (square.ok() || options.side >= most) return square;
    }
}

struct SideLimits {
    uint32_t most = 0;        // side that a component may take if its cut needs room
    bool is_largest = false;  // no component has a larger side
};

// Makes one component's square. Chooses among cuts for the largest ones only. If `preference` is not known, it is set to the one that was chosen.
Result<MadeSquare> make_component(const Mesh& mesh, const EncodeOptions& options, const SideLimits& limits,
                                  StageClock& clock, const Observer& observer,
                                  std::optional<CutPreference>& preference) {
    if (!preference && may_choose_cut(options) && limits.is_largest) {
        if (auto choice = choose_cut(mesh, options, clock)) {
            preference = choice->preference;
            if (!observer) return std::move(choice->square);
        }
    }
    if (!preference) preference = CutPreference{};
    return make_roomy_square(mesh, options, limits.most, *preference, clock, observer);
}

void add_to_report(const MadeSquare& square, double part_of_area, EncodeReport& report) {
    report.cut_length += square.cut_length;
    report.stretch_efficiency += part_of_area * square.stretch_efficiency;
    report.flipped_triangles += square.flipped_triangles;
    report.folds_before_fit += square.folds_before_fit;
}

}  // namespace

Result<Squares> make_squares(const Mesh& mesh, const EncodeOptions& options, StageClock& clock,
                             const Observer& observer, EncodeReport& report, CutPreferences& preferences) {
    const Components components = connected_components(mesh.triangles, mesh.positions.size());
    std::vector<Mesh> parts;
    std::vector<double> areas;
    for (uint32_t k = 0; k < components.count; ++k) {
        parts.push_back(extract_component(mesh, components, k));
        areas.push_back(surface_area(parts.back()));
    }
    const std::vector<uint32_t> sides = share_sides(areas, options.side);
    const uint32_t largest = *std::max_element(sides.begin(), sides.end());
    const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
    std::vector<SquareImage> images;
    preferences.resize(parts.size());
    for (size_t k = 0; k < parts.size(); ++k) {
        const std::string prefix = parts.size() == 1 ? "" : "component-" + std::to_string(k) + "-";
        const Observer with_prefix = [&](const Snapshot& state) {
            Snapshot named = state;
            named.name = prefix + state.name;
            observer(named);
        };
        EncodeOptions part_options = options;
        part_options.side = sides[k];
        part_options.node_side = std::min(options.node_side, sides[k]);
        const SideLimits limits{options.side, sides[k] == largest};
        auto square =
            make_component(parts[k], part_options, limits, clock, observer ? with_prefix : Observer(), preferences[k]);
        if (!square.ok() && parts.size() == 1) return square.error();
        if (!square.ok()) {
            return Error{square.error().stage,
                         "component " + std::to_string(k) + " of " + std::to_string(parts.size()) + " (" +
                             std::to_string(parts[k].triangles.size()) + " triangles): " + square.error().message};
        }
        add_to_report(square.value(), all > 0 ? areas[k] / all : 1.0 / double(parts.size()), report);
        images.push_back(std::move(square.value().image));
    }
    return Squares{std::move(images), std::move(parts)};
}

}  // namespace gim
