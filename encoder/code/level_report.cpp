#include "encoder/code/level_report.h"

#include <algorithm>
#include <string>
#include <string_view>

#include "encoder/base/result.h"
#include "encoder/code/decode_surface.h"

namespace gim {

namespace {

// Samples of a comparison, each way: enough for half a decibel many times over.
uint32_t samples_for(const Mesh& surface, const ReferenceSurface& reference) {
    constexpr size_t kFewest = 20000, kMost = 100000, kEachFace = 32;
    const size_t faces = surface.triangles.size() + reference.mesh().triangles.size();
    return static_cast<uint32_t>(std::clamp(kEachFace * faces, kFewest, kMost));
}

// Returns the sizes of one level; width is 0 if no image has the level.
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

void tell_error(const Comparison& comparison, LevelReport* report) {
    report->psnr = comparison.psnr;
    report->rms_error = comparison.rms;
    report->max_error = comparison.hausdorff;
    report->defects = *comparison.defects;
}

uint64_t sideband_size(std::span<const uint8_t> bytes) {
    Decoder decoder;
    if (decoder.open(bytes) != GIM_OK) return 0;
    gim_chunk chunk;
    for (uint32_t i = 0; decoder.read_chunk(i, &chunk) == GIM_OK; ++i) {
        if (std::string_view(chunk.name) == "SEAM") return chunk.size;
    }
    return 0;
}

}  // namespace

Result<std::vector<LevelReport>> measure_levels(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                                const Comparison& full, uint32_t threads) {
    Decoder decoder;
    if (const gim_status status = open_own_file(bytes, &decoder); status != GIM_OK)
        return decoding_error(Stage::kCode, status);
    CompareOptions options;
    options.threads = threads;
    options.defects = true;
    std::vector<LevelReport> levels;
    for (uint32_t level = 0; level < decoder.info().level_count; ++level) {
        GIM_TRY(report, describe_level(decoder, level));
        if (report.width == 0) break;
        if (level == 0) {
            tell_error(full, &report);
        } else {
            GIM_TRY(surface, decode_surface(bytes, level));
            options.samples = samples_for(surface, reference);
            GIM_TRY(comparison, reference.compare(surface, options));
            tell_error(comparison, &report);
        }
        levels.push_back(report);
    }
    return levels;
}

std::vector<LevelError> errors_of_levels(std::span<const LevelReport> levels, uint32_t level_count) {
    std::vector<LevelError> errors(level_count);
    for (const LevelReport& level : levels) errors[level.level] = {level.rms_error, level.max_error};
    return errors;
}

void describe_file(std::span<const uint8_t> bytes, EncodeReport& report) {
    const double bits = 8.0 * static_cast<double>(bytes.size());
    report.file_bytes = bytes.size();
    report.sideband_bytes = sideband_size(bytes);
    report.bits_per_sample = bits / static_cast<double>(report.samples);
    report.bits_per_vertex = report.input_vertices > 0 ? bits / static_cast<double>(report.input_vertices) : 0;
}

}  // namespace gim
