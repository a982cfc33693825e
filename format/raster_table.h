// What an imported image holds besides its mask and its values: the size of its surface, and how the array looked that was
// imported.  spec/gim-format.md, "Rasters".
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/container.h"
#include "format/raster_code.h"
#include "format/status.h"

namespace gim {

inline constexpr uint32_t kSampleTypes = 9;  // gim/decoder.h names them
inline constexpr uint32_t kMaxRasterChannels = 4096;

// A number v of a channel stands for origin + step * v.
struct RasterChannel {
    uint32_t bits = 0;
    float origin = 0, step = 1;
};

struct RasterTable {
    uint32_t vertices = 0, triangles = 0;  // of the glued surface
    uint32_t sample_type = 0;
    bool is_channels_first = false;
    uint32_t mask = 0, mask_value = 0;  // where the array's mask was, and what it said of defined samples
    uint32_t channels = kRasterGroup;   // x, y, z and others
    std::span<const uint8_t> others;    // the records of channels from 3 on

    RasterChannel channel(uint32_t index) const;  // index: 3 .. channels - 1
    // The group that begins at a channel, a multiple of kRasterGroup. bits: of the positions.
    RasterGroup group(uint32_t first, uint32_t bits) const;
};

// Checks everything, also the samples of all groups of channels against the limits.
Status parse_raster_table(std::span<const uint8_t> payload, const Header& header, const ContainerLimits& limits,
                          RasterTable* table);

// table.others is not read.
std::vector<uint8_t> serialize_raster_table(const RasterTable& table, std::span<const RasterChannel> others);

}  // namespace gim
