#include "format/raster_table.h"

#include <algorithm>

#include "format/bytes.h"

namespace gim {
namespace {

constexpr size_t kChannelSize = 9;
constexpr uint8_t kTypeMask = 0x0F, kChannelsFirstFlag = 0x10, kReservedTypeFlags = 0xE0;

bool read_channel(ByteReader* reader, RasterChannel* channel) {
    uint8_t bits = 0;
    if (!reader->read_u8(&bits) || !reader->read_f32(&channel->origin) || !reader->read_f32(&channel->step))
        return false;
    channel->bits = bits;
    return bits >= 1 && bits <= kMaxBits && channel->origin >= -kMaxOrigin && channel->origin <= kMaxOrigin &&
           channel->step >= kMinStep && channel->step <= kMaxStep;
}

}  // namespace

RasterChannel RasterTable::channel(uint32_t index) const {
    ByteReader reader(others.subspan((index - kRasterGroup) * kChannelSize));
    RasterChannel channel;
    (void)read_channel(&reader, &channel);
    return channel;
}

RasterGroup RasterTable::group(uint32_t first, uint32_t bits) const {
    RasterGroup group{first, std::min(channels - first, kRasterGroup), {}};
    for (uint32_t k = 0; k < group.count; ++k) group.bits[k] = first == 0 ? bits : channel(first + k).bits;
    return group;
}

Status parse_raster_table(std::span<const uint8_t> payload, const Header& header, const ContainerLimits& limits,
                          RasterTable* table) {
    ByteReader reader(payload);
    uint64_t vertices = 0, triangles = 0, mask = 0, mask_value = 0, channels = 0;
    uint8_t type = 0;
    if (!reader.read_leb128(&vertices) || !reader.read_leb128(&triangles) || !reader.read_u8(&type))
        return Status::kMalformed;
    if ((type & kReservedTypeFlags) != 0 || (type & kTypeMask) >= kSampleTypes) return Status::kUnsupportedVersion;
    if (!reader.read_leb128(&mask) || !reader.read_leb128(&mask_value) || !reader.read_leb128(&channels))
        return Status::kMalformed;
    const uint64_t samples = header.sample_count;
    if (vertices < 3 || vertices > samples || triangles == 0 || triangles > 2 * samples || mask_value > UINT32_MAX ||
        channels < kRasterGroup || channels > kMaxRasterChannels || mask > channels + 2)
        return Status::kMalformed;
    const uint64_t groups = (channels + kRasterGroup - 1) / kRasterGroup;
    if (groups * samples > limits.max_samples) return Status::kLimitExceeded;
    *table = {static_cast<uint32_t>(vertices),  static_cast<uint32_t>(triangles),  uint32_t{type} & kTypeMask,
              (type & kChannelsFirstFlag) != 0, static_cast<uint32_t>(mask),       static_cast<uint32_t>(mask_value),
              static_cast<uint32_t>(channels),  payload.subspan(reader.position())};
    if (table->others.size() != (channels - kRasterGroup) * kChannelSize) return Status::kMalformed;
    RasterChannel channel;
    while (reader.left() > 0) {
        if (!read_channel(&reader, &channel)) return Status::kMalformed;
    }
    return Status::kOk;
}

std::vector<uint8_t> serialize_raster_table(const RasterTable& table, std::span<const RasterChannel> others) {
    std::vector<uint8_t> bytes;
    append_leb128(table.vertices, &bytes);
    append_leb128(table.triangles, &bytes);
    bytes.push_back(static_cast<uint8_t>(table.sample_type | (table.is_channels_first ? kChannelsFirstFlag : 0)));
    append_leb128(table.mask, &bytes);
    append_leb128(table.mask_value, &bytes);
    append_leb128(table.channels, &bytes);
    for (const RasterChannel& channel : others) {
        bytes.push_back(static_cast<uint8_t>(channel.bits));
        append_f32(channel.origin, &bytes);
        append_f32(channel.step, &bytes);
    }
    return bytes;
}

}  // namespace gim
