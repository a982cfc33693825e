#include "encoder/code/level_report.h"

#include <algorithm>

#include "encoder/base/result.h"
#include "encoder/code/decode_surface.h"

namespace gim {

namespace {

constexpr uint32_t kSamples = 100000;  // each way; enough for half a decibel many times over

// The sizes of one level; width 0 where no image has it.
Result<LevelReport> describe_level(const Decoder& decoder, uint32_t level) {
    LevelReport report;
    report.level = level;
    for (uint32_t image = 0; image < decoder.info().image_count; ++image) {
        DecoderLevel shape;
        gim_status status = decoder.read_level(image, 0, &shape);
        if (status == GIM_OK && shape.coarsest_level < level) {
            status = decoder.read_level(image, shape.coarsest_level, &shape);
        } else if (status == GIM_OK) {
            status = decoder.read_level(image, level, &shape);
            report.width = std::max(report.width, shape.width);
            report.height = std::max(report.height, shape.height);
        }
        if (status != GIM_OK) return decoding_error(Stage::kCode, status);
        report.vertices += shape.vertex_count;
        report.triangles += shape.triangle_count;
        report.prefix_bytes = std::max(report.prefix_bytes, shape.prefix_size);
    }
    return report;
}

}  // namespace

Result<std::vector<LevelReport>> measure_levels(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                                const Comparison& full, uint32_t threads) {
    Decoder decoder;
    if (const gim_status status = open_own_file(bytes, &decoder); status != GIM_OK)
        return decoding_error(Stage::kCode, status);
    CompareOptions options;
    options.samples = kSamples;
    options.threads = threads;
    std::vector<LevelReport> levels;
    for (uint32_t level = 0; level < decoder.info().level_count; ++level) {
        GIM_TRY(report, describe_level(decoder, level));
        if (report.width == 0) break;
        report.psnr = full.psnr;
        if (level > 0) {
            GIM_TRY(surface, decode_surface(bytes, level));
            GIM_TRY(comparison, reference.compare(surface, options));
            report.psnr = comparison.psnr;
        }
        levels.push_back(report);
    }
    return levels;
}

}  // namespace gim
