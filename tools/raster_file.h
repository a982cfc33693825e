// Images of other programs, and what becomes of them: .npz and .exr to RasterImage and back.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "gim/encoder.h"
#include "tools/file.h"
#include "tools/memory_budget.h"

namespace gim {

// How to read an array. EXR channels have names that tell.
struct RasterOptions {
    std::optional<uint32_t> mask_channel;        // its place among the channels of the array
    bool no_mask = false;                        // all channels are data
    std::optional<bool> is_channels_first = {};  // else the shape tells
};

enum class RasterFormat { kNpz, kExr };
// By content, else by extension.
std::optional<RasterFormat> raster_format_of(std::span<const uint8_t> bytes, std::string_view extension);

Result<RasterImage> read_raster(std::span<const uint8_t> bytes, RasterFormat format, const RasterOptions& options,
                                MemoryBudget& memory);
Result<Bytes> write_raster_file(const RasterImage& image, RasterFormat format);

// Decodes the imported image of a .gim file. Fails with what `describe_status` says, also if there is none.
Result<RasterImage> decode_raster_image(const Bytes& file);
bool holds_raster(const Bytes& file);

// One format each.
Result<RasterImage> read_raster_npz(std::span<const uint8_t> bytes, const RasterOptions& options, MemoryBudget& memory);
Result<RasterImage> read_raster_exr(std::span<const uint8_t> bytes, MemoryBudget& memory);
Result<Bytes> write_raster_npz(const RasterImage& image);
Result<Bytes> write_raster_exr(const RasterImage& image);

}  // namespace gim
