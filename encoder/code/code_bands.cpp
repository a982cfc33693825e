#include "encoder/code/code_bands.h"

#include <algorithm>
#include <array>
#include <utility>

#include "encoder/code/dead_zone.h"

namespace gim {
namespace {

// The details of one band: as rounded multiples of their steps, and as decoded.
struct QuantizedBand {
    std::vector<int32_t> integers;
    std::vector<float> details;
};

void turn_out_of(const DetailFrame& frame, float* detail) {
    const std::array<float, 3> in_frame = {detail[0], detail[1], detail[2]};
    out_of_frame(frame, in_frame.data(), detail);
}

QuantizedBand quantize(const RealBand& band, const FrameField& frames, const DetailSteps& steps,
                       Orientation orientation) {
    const size_t count = band.values.size() / 3;
    std::vector<DetailFrame> frame(steps.in_frames ? count : 0);
    std::vector<float> step(band.values.size(), steps.of(orientation)), local(band.values.begin(), band.values.end());
    for (size_t i = 0; i < frame.size(); ++i) {
        frame[i] =
            frames.at(orientation, static_cast<uint32_t>(i / band.columns), static_cast<uint32_t>(i % band.columns));
        steps_in(frame[i], steps, orientation, &step[3 * i]);
        into_frame(frame[i], &band.values[3 * i], &local[3 * i]);
    }
    for (size_t i = 0; i < local.size(); ++i) local[i] /= step[i];

    QuantizedBand result{round_band({local, band.rows, band.columns}, steps.in_frames), {}};
    result.details.resize(local.size());
    for (size_t i = 0; i < local.size(); ++i) result.details[i] = dequantize(result.integers[i], step[i]);
    for (size_t i = 0; i < frame.size(); ++i) turn_out_of(frame[i], &result.details[3 * i]);
    return result;
}

// Returns the details that a decoder makes of a band in frames.
std::vector<float> dequantized(const std::vector<int32_t>& integers, uint32_t columns, const FrameField& frames,
                               const DetailSteps& steps, Orientation orientation) {
    std::vector<float> details(integers.size());
    for (uint32_t i = 0; i < details.size() / 3; ++i) {
        const DetailFrame frame = frames.at(orientation, i / columns, i % columns);
        float step[3];
        steps_in(frame, steps, orientation, step);
        for (size_t k = 0; k < 3; ++k) details[3 * i + k] = dequantize(integers[3 * i + k], step[k]);
        turn_out_of(frame, &details[3 * i]);
    }
    return details;
}

float* detail_at(AnalysisLevel<float>& level, uint32_t side, Orientation orientation, uint32_t row, uint32_t column) {
    const bool is_horizontal = orientation == Orientation::kHorizontal;
    const uint32_t columns = is_horizontal ? high_count(side) : low_count(side);
    return &(is_horizontal ? level.horizontal : level.vertical)[(size_t{row} * columns + column) * 3];
}

// Sets details that mates share to the mean of both, and copies to zero.
void share_details(const SharedRim& rim, AnalysisLevel<float>& level, uint32_t side) {
    rim.for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
        const DetailPlace from = rim.source_of(orientation, row, column);
        float *copy = detail_at(level, side, orientation, row, column),
              *source = detail_at(level, side, from.orientation, from.row, from.column);
        for (int k = 0; k < 3; ++k) source[k] = 0.5f * (source[k] + copy[k]);
        std::fill_n(copy, 3, 0.0f);
    });
}

void copy_details(const SharedRim& rim, AnalysisLevel<float>& level, uint32_t side) {
    rim.for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
        const DetailPlace from = rim.source_of(orientation, row, column);
        std::copy_n(detail_at(level, side, from.orientation, from.row, from.column), 3,
                    detail_at(level, side, orientation, row, column));
    });
}

}  // namespace

QuantizedImage quantize_bands(const Pyramid<float>& pyramid, const DetailCoding& coding, const SeamTable* seams) {
    Pyramid<int32_t> out;
    out.columns = pyramid.columns;
    out.rows = pyramid.rows;
    const uint32_t steps = pyramid.steps();
    const float base_step = low_band_step(coding.quantizer, steps);
    out.base = quantize_base(pyramid.base, base_step);
    Pyramid<float> decoded;  // one step: from the image that a decoder has so far to the next one
    for (const int32_t q : out.base) decoded.base.push_back(static_cast<float>(q) * base_step);
    decoded.levels.resize(1);
    for (uint32_t e = 1; e <= steps; ++e) {
        decoded.columns = pyramid.columns_at(e);
        decoded.rows = pyramid.rows_at(e);
        const uint32_t columns = low_count(decoded.columns), rows = low_count(decoded.rows);
        const DetailSteps detail_steps = coding.steps_at(steps - e + 1);
        const FrameField frames(decoded.base.data(), columns, rows, detail_steps.cell_area);
        AnalysisLevel<float> level = pyramid.levels[e - 1];
        const OwnSharedRim rim(coding.in_frames ? seams : nullptr, decoded.columns);
        share_details(rim.view(), level, decoded.columns);
        const uint32_t high_columns = high_count(decoded.columns), high_rows = high_count(decoded.rows);
        QuantizedBand horizontal =
            quantize({level.horizontal, rows, high_columns}, frames, detail_steps, Orientation::kHorizontal);
        QuantizedBand vertical =
            quantize({level.vertical, high_rows, columns}, frames, detail_steps, Orientation::kVertical);
        QuantizedBand diagonal =
            quantize({level.diagonal, high_rows, high_columns}, frames, detail_steps, Orientation::kDiagonal);
        out.levels.push_back(
            {std::move(horizontal.integers), std::move(vertical.integers), std::move(diagonal.integers)});
        if (!coding.in_frames) continue;
        decoded.levels[0] = {std::move(horizontal.details), std::move(vertical.details), std::move(diagonal.details)};
        copy_details(rim.view(), decoded.levels[0], decoded.columns);
        decoded.base = restore<Irreversible97>(decoded, seams);
    }
    return {std::move(out), coding.in_frames ? std::move(decoded.base) : std::vector<float>()};
}

std::vector<std::vector<float>> decode_bands(const Pyramid<int32_t>& bands, const DetailCoding& coding,
                                             const SeamTable* seams) {
    const uint32_t steps = bands.steps();
    std::vector<std::vector<float>> images(1);
    for (const int32_t q : bands.base)
        images[0].push_back(static_cast<float>(q) * low_band_step(coding.quantizer, steps));
    Pyramid<float> one;
    one.levels.resize(1);
    for (uint32_t e = 1; e <= steps; ++e) {
        one.columns = bands.columns_at(e);
        one.rows = bands.rows_at(e);
        const DetailSteps detail_steps = coding.steps_at(steps - e + 1);
        const FrameField frames(images[e - 1].data(), low_count(one.columns), low_count(one.rows),
                                detail_steps.cell_area);
        const AnalysisLevel<int32_t>& level = bands.levels[e - 1];
        const auto details = [&](const std::vector<int32_t>& integers, Orientation orientation) {
            const uint32_t columns =
                orientation == Orientation::kVertical ? low_count(one.columns) : high_count(one.columns);
            return dequantized(integers, columns, frames, detail_steps, orientation);
        };
        one.levels[0] = {details(level.horizontal, Orientation::kHorizontal),
                         details(level.vertical, Orientation::kVertical),
                         details(level.diagonal, Orientation::kDiagonal)};
        const OwnSharedRim rim(seams, one.columns);
        copy_details(rim.view(), one.levels[0], one.columns);
        one.base = images[e - 1];
        images.push_back(restore<Irreversible97>(one, seams));
    }
    return images;
}

void code_steps(BandCoder<RangeEncoder>& coder, Pyramid<int32_t>& pyramid, uint32_t from_step, uint32_t to_level,
                const SeamTable* seams) {
    if (from_step == 0) coder.code_base({pyramid.base.data(), pyramid.rows_at(0), pyramid.columns_at(0)});
    for (uint32_t step = from_step; step < pyramid.steps() - to_level; ++step) {
        const LevelBands bands = bands_of(pyramid, step);
        const OwnSharedRim rim(seams, pyramid.columns_at(step + 1));
        if (step == 0) {
            coder.code_level(bands, nullptr, rim.view());
        } else {
            const LevelBands parents = bands_of(pyramid, step - 1);
            coder.code_level(bands, &parents, rim.view());
        }
    }
}

std::vector<std::vector<uint8_t>> code_bands(Pyramid<int32_t>& pyramid, uint32_t level_count, CoefficientKind kind,
                                             const SeamTable* seams) {
    BandModels models(kind);
    OwnBandWork work(pyramid.columns);
    std::vector<std::vector<uint8_t>> streams;
    uint32_t done = 0;
    for (uint32_t level = level_count; level-- > 0;) {
        RangeEncoder coder;
        BandCoder<RangeEncoder> band_coder(&coder, &models, work.view());
        code_steps(band_coder, pyramid, done, level, seams);
        done = pyramid.steps() - level;
        streams.push_back(coder.finish());
    }
    return streams;
}

}  // namespace gim
