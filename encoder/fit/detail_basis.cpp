#include "encoder/fit/detail_basis.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace gim {

namespace {

std::vector<float> flat(const Pyramid<float>& pyramid) {
    std::vector<float> out = pyramid.base;
    for (const AnalysisLevel<float>& level : pyramid.levels) {
        for (const auto* band : {&level.horizontal, &level.vertical, &level.diagonal})
            out.insert(out.end(), band->begin(), band->end());
    }
    return out;
}

Pyramid<float> unflattened(const std::vector<float>& values, uint32_t side) {
    Pyramid<float> pyramid;
    pyramid.columns = pyramid.rows = side;
    pyramid.levels.resize(static_cast<size_t>(std::countr_zero(side - 1)));
    auto at = values.begin();
    const auto take = [&](std::vector<float>& band, size_t triples) {
        band.assign(at, at + static_cast<ptrdiff_t>(3 * triples));
        at += static_cast<ptrdiff_t>(3 * triples);
    };
    take(pyramid.base, 4);
    for (uint32_t e = 1; e <= pyramid.steps(); ++e) {
        const size_t lows = low_count(pyramid.columns_at(e)), highs = high_count(pyramid.columns_at(e));
        AnalysisLevel<float>& level = pyramid.levels[e - 1];
        take(level.horizontal, lows * highs);
        take(level.vertical, highs * lows);
        take(level.diagonal, highs * highs);
    }
    return pyramid;
}

}  // namespace

DetailBasis::DetailBasis(const std::vector<float>& image, uint32_t side, const DetailCoding& coding,
                         const SeamTable* seams)
    : side_(side), seams_(seams) {
    const auto steps = static_cast<uint32_t>(std::countr_zero(side - 1));
    std::vector<std::vector<float>> images(steps + 1);  // by exponent
    images[steps] = image;
    for (uint32_t e = steps; e > 0; --e)
        images[e - 1] = gim::analyse<Irreversible97>(images[e], (1u << e) + 1, (1u << e) + 1, 1, seams).base;

    add_base(4, low_band_step(coding.quantizer, steps));
    norms_.assign(4, kBandNorms[steps - 1].low);
    for (uint32_t e = 1; e <= steps; ++e) {
        const uint32_t lows = (1u << (e - 1)) + 1, highs = lows - 1, depth = steps - e + 1;
        const DetailSteps detail_steps = coding.steps_at(depth);
        const FrameField field(images[e - 1].data(), lows, lows, detail_steps.cell_area);
        const auto add_band = [&](Orientation orientation, uint32_t rows, uint32_t columns) {
            const float norm =
                orientation == Orientation::kDiagonal ? kBandNorms[depth - 1].diagonal : kBandNorms[depth - 1].edge;
            for (uint32_t row = 0; row < rows; ++row) {
                for (uint32_t column = 0; column < columns; ++column) {
                    add_detail(field.at(orientation, row, column), detail_steps, orientation, norm);
                }
            }
        };
        const OwnSharedRim rim(seams, (1u << e) + 1);
        const auto first = static_cast<uint32_t>(frames_.size());
        const auto triple = [&](Orientation orientation, uint32_t row, uint32_t column) {
            const bool is_horizontal = orientation == Orientation::kHorizontal;
            return first + (is_horizontal ? row * highs : lows * highs + row * lows) + column;
        };
        rim.view().for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
            const DetailPlace from = rim.view().source_of(orientation, row, column);
            copies_.push_back({triple(orientation, row, column), triple(from.orientation, from.row, from.column)});
        });
        add_band(Orientation::kHorizontal, lows, highs);
        add_band(Orientation::kVertical, highs, lows);
        add_band(Orientation::kDiagonal, highs, highs);
    }
    is_copy_.resize(frames_.size());
    for (const auto& [copy, source] : copies_) {
        is_copy_[copy] = true;
        norms_[source] *= std::sqrt(2.0f);
    }
}

void DetailBasis::gather_copies(Coordinates& coordinates, float weight) const {
    for (const auto& [copy, source] : copies_) {
        for (size_t k = 0; k < 3; ++k) {
            float &to = coordinates[3 * size_t{source} + k], &from = coordinates[3 * size_t{copy} + k];
            to = weight * (to + from);
            from = 0;
        }
    }
}

DetailBasis::Coordinates DetailBasis::analyse(const std::vector<float>& image) const {
    Coordinates coordinates = flat(gim::analyse<Irreversible97>(image, side_, seams_));
    gather_copies(coordinates, 0.5f);
    turn(coordinates, Way::kIntoFrames);
    return coordinates;
}

std::vector<float> DetailBasis::synthesize(const Coordinates& coordinates) const {
    Coordinates turned = coordinates;
    turn(turned, Way::kOutOfFrames);
    for (const auto& [copy, source] : copies_) std::copy_n(&turned[3 * size_t{source}], 3, &turned[3 * size_t{copy}]);
    return restore<Irreversible97>(unflattened(turned, side_), seams_);
}

DetailBasis::Coordinates DetailBasis::transposed(std::vector<float> image) const {
    Coordinates coordinates = flat(restore_transposed(std::move(image), side_, seams_));
    gather_copies(coordinates, 1);
    turn(coordinates, Way::kIntoFrames);
    return coordinates;
}

}  // namespace gim
