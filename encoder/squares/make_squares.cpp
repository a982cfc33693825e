#include "encoder/squares/make_squares.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "encoder/base/at_once.h"
#include "encoder/squares/make_component.h"
#include "encoder/squares/share_sides.h"
#include "encoder/surface/refine.h"
#include "encoder/surface/topology_summary.h"

namespace gim {

namespace {

std::string square_of(uint32_t side) { return std::to_string(side) + " x " + std::to_string(side); }

// Names a component in a message; empty if it is the only one.
std::string component_name(const std::vector<Mesh>& parts, size_t k) {
    if (parts.size() == 1) return {};
    return "component " + std::to_string(k) + " of " + std::to_string(parts.size()) + " (" +
           std::to_string(parts[k].triangles.size()) + " triangles): ";
}

void add_to_report(const MadeSquare& square, double part_of_area, EncodeReport& report) {
    report.cut_length += square.cut_length;
    report.stretch_efficiency += part_of_area * square.stretch_efficiency;
    report.flipped_triangles += square.flipped_triangles;
    report.folds_before_fit += square.folds_before_fit;
}

// The same, with names that begin with that of the component.
Observer named_by(size_t component, const Observer& observer) {
    if (!observer) return {};
    return [component, &observer](const Snapshot& state) {
        Snapshot named = state;
        named.name = "component-" + std::to_string(component) + "-" + state.name;
        observer(named);
    };
}

// Components of at least this side share their own work among the threads. Smaller ones have too little of it.
constexpr uint32_t kLeastSideByItself = 129;

// Calls make(component, clock) for each component: large ones one after the other, small ones at once.
template <class Make>
void for_each_part(const std::vector<uint32_t>& sides, const Observer& observer, StageClock& clock, const Make& make) {
    std::vector<size_t> small;
    for (size_t k = 0; k < sides.size(); ++k) {
        if (sides.size() > 1 && !observer && sides[k] < kLeastSideByItself)
            small.push_back(k);
        else
            make(k, clock);
    }
    if (small.empty()) return;
    clock.begin(Stage::kCut);
    for_each_at_once(small.size(), clock, [&](size_t i) {
        StageClock unheard({});
        make(small[i], unheard);
    });
}

}  // namespace

CutPreferences usual_cuts(const Mesh& mesh) {
    return CutPreferences(connected_components(mesh.triangles, mesh.positions.size()).count, CutPreference{});
}

Result<Squares> make_squares(const Mesh& mesh, const EncodeOptions& options, uint32_t most_side, StageClock& clock,
                             const Observer& observer, EncodeReport& report, CutPreferences& preferences) {
    const Components components = connected_components(mesh.triangles, mesh.positions.size());
    std::vector<Mesh> parts = split_components(mesh, components);
    std::vector<double> areas;
    for (const Mesh& part : parts) areas.push_back(surface_area(part));
    const std::vector<uint32_t> sides = share_sides(areas, options.side);
    const uint32_t largest = *std::max_element(sides.begin(), sides.end());
    const double all = std::accumulate(areas.begin(), areas.end(), 0.0);
    preferences.resize(parts.size());

    std::vector<std::optional<Result<MadeSquare>>> squares(parts.size());
    const auto make = [&](size_t k, StageClock& part_clock) {
        EncodeOptions part_options = options;
        part_options.side = sides[k];
        part_options.node_side = std::min(options.node_side, sides[k]);
        const SideLimits limits{most_side, sides[k] == largest};
        const Observer part_observer = parts.size() == 1 ? observer : named_by(k, observer);
        squares[k] = make_component(parts[k], part_options, limits, part_clock, part_observer, preferences[k]);
    };
    for_each_part(sides, observer, clock, make);

    std::vector<SquareImage> images;
    for (size_t k = 0; k < parts.size(); ++k) {
        Result<MadeSquare>& square = *squares[k];
        if (!square.ok()) return Error{square.error().stage, component_name(parts, k) + square.error().message};
        if (square.value().image.side() > options.side) {
            report.warnings.push_back(component_name(parts, k) + "the surface does not fit " + square_of(options.side) +
                                      " samples; the image has " + square_of(square.value().image.side()));
        }
        add_to_report(square.value(), all > 0 ? areas[k] / all : 1.0 / double(parts.size()), report);
        images.push_back(std::move(square.value().image));
    }
    return Squares{std::move(images), std::move(parts)};
}

}  // namespace gim
