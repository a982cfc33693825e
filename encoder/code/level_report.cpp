#include "encoder/code/level_report.h"

#include <algorithm>
#include <string>

#include "encoder/base/result.h"
#include "encoder/code/decode_surface.h"
#include "gim/decoder.h"

namespace gim {

namespace {

constexpr uint32_t kSamples = 100000;  // each way; enough for half a decibel many times over

// The sizes of one level; width 0 where no image has it.
Result<LevelReport> describe_level(std::span<const uint8_t> bytes, const gim_info& info, uint32_t level) {
    LevelReport report;
    report.level = level;
    for (uint32_t image = 0; image < info.image_count; ++image) {
        gim_level_info shape;
        gim_status status = gim_read_level_info(&info, bytes.data(), bytes.size(), image, 0, &shape);
        if (status == GIM_OK && shape.coarsest_level < level) {
            status = gim_read_level_info(&info, bytes.data(), bytes.size(), image, shape.coarsest_level, &shape);
        } else if (status == GIM_OK) {
            status = gim_read_level_info(&info, bytes.data(), bytes.size(), image, level, &shape);
            report.width = std::max(report.width, shape.width);
            report.height = std::max(report.height, shape.height);
        }
        if (status != GIM_OK) return Error{Stage::kCode, std::string("own output: ") + gim_status_text(status)};
        report.vertices += shape.vertex_count;
        report.triangles += shape.triangle_count;
        report.prefix_bytes = std::max(report.prefix_bytes, shape.prefix_size);
    }
    return report;
}

}  // namespace

Result<std::vector<LevelReport>> measure_levels(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                                const Comparison& full, uint32_t threads) {
    GIM_TRY(info, read_own_info(bytes));
    CompareOptions options;
    options.samples = kSamples;
    options.threads = threads;
    std::vector<LevelReport> levels;
    for (uint32_t level = 0; level < info.level_count; ++level) {
        GIM_TRY(report, describe_level(bytes, info, level));
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
