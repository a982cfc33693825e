#include "encoder/squares/square_fit.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "encoder/code/file_units.h"
#include "encoder/code/rate_target.h"
#include "encoder/fit/fit_strength.h"
#include "encoder/squares/square_codec.h"
#include "encoder/squares/write_squares.h"

namespace gim {

namespace {

// Distance of a coarser image, in steps of the quantizer, from which on it leads samples astray. Thin parts then lie
// between its samples. At the default quality every second sample of bunny, horse, rocker-arm and fandisk is 0.17 to 0.29 off, and
// the fit from coarse to fine changes the bytes by -8 to +1 %; of feline, gargoyle and dragon it is 0.54 to 0.6 off, and the bytes
// rise by 2 to 14 %.
constexpr double kMostDistance = 0.4;
constexpr double kCoarsePart = 0.35;  // of the time
constexpr int kCodesPerFourfold = 8;  // of cell_area_of()

Progress part_of(const Progress& whole, double begin, double end) {
    if (!whole) return {};
    return [=](Stage stage, double fraction) { return whole(stage, begin + (end - begin) * fraction); };
}

std::optional<SquareImage> halved(const SquareImage& image) {
    const uint32_t side = (image.side() - 1) / 2 + 1;
    if (image.side() < kLeastSideFromCoarse || side < image.sideband.node_side) return {};
    SquareGrid grid{side, {}};
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column) grid.positions.push_back(image.at(2 * row, 2 * column));
    }
    auto glued = glue_square(std::move(grid), image.sideband);
    if (!glued.ok()) return {};
    return std::move(glued.value());
}

// A sample of the coarse image stands for four. So the same details have half the quantizer there, and a cell four
// times the area.
Units halved(Units units) {
    units.quantizer /= 2;
    if (units.cell_area > 0) units.cell_area = static_cast<uint8_t>(std::min(255, units.cell_area + kCodesPerFourfold));
    return units;
}

}  // namespace

bool needs_first_fit(const EncodeOptions& options, uint32_t side) {
    return !is_fitted_to_codec(options) || is_searched(options.rate) || side < kLeastSideFromCoarse;
}

SquareFit::SquareFit(const SquareImage& start, const Mesh& surface, uint64_t seed, const FitRounds& rounds)
    : side_(start.side()),
      seed_(seed),
      rounds_(rounds),
      seams_(file_seams(start)),
      surface_(std::make_shared<const FitSurface>(surface)),
      half_(halved(start)),
      fine_(start, square_codec(side_, seams_), surface_, seed, Rails{}, rounds) {}

std::vector<Vec3> SquareFit::run(const Units& units, CodedFit::Effort effort, const Progress& progress) {
    if (effort != CodedFit::Effort::kFinal || !is_led_by_coarse(units)) return fine_.run(units, effort, progress);
    fit_coarsely(units, part_of(progress, 0, kCoarsePart));
    return fine_.run(units, CodedFit::Effort::kRefine, part_of(progress, kCoarsePart, 1));
}

void SquareFit::begin_coarse() {
    coarse_.emplace(*half_, square_codec(half_->side(), seams_), surface_, seed_, Rails{}, rounds_);
    coarse_distance_ = coarse_->distance();
    half_.reset();
}

bool SquareFit::is_led_by_coarse(const Units& units) {
    if (half_) begin_coarse();
    return coarse_ && coarse_distance_ <= kMostDistance * double{units.quantizer} * double{units.step};
}

void SquareFit::fit_coarsely(const Units& units, const Progress& progress) {
    Pyramid<float> pyramid =
        analyse<Irreversible97>(to_units<float>(fine_.positions(), units), side_, side_, 1, &seams_);
    coarse_->place(from_units(pyramid.base, units));
    pyramid.base = to_units<float>(coarse_->run(halved(units), CodedFit::Effort::kCoarse, progress), units);
    AnalysisLevel<float>& details = pyramid.levels[0];
    for (auto* band : {&details.horizontal, &details.vertical, &details.diagonal})
        std::fill(band->begin(), band->end(), 0.0f);
    fine_.place(from_units(restore<Irreversible97>(pyramid, &seams_), units));
}

}  // namespace gim
