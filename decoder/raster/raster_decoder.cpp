#include "decoder/raster/raster_decoder.h"

#include "decoder/pyramid/range_decoder.h"

namespace gim {

Status open_raster(const LevelRequest& request, OpenRaster* raster) {
    if (request.level != 0) return Status::kNoSuchLevel;
    std::span<const uint8_t> payload;
    if (Status s = read_seam_payload(request.header, request.file, &payload); s != Status::kOk) return s;
    Chunk chunk;
    uint64_t offset = 0;
    if (Status s = find_level_chunk(request.header, 0, &chunk, &offset); s != Status::kOk) return s;
    raster->prefix = offset + chunk.size;
    return parse_raster_table(payload, request.header, request.limits, &raster->table);
}

RasterWork lay_out_raster(const RasterShape& shape, Arena* arena) {
    RasterWork work;
    work.depth = arena->take<uint8_t>(shape.samples());
    work.point = arena->take<uint32_t>(shape.samples());
    work.link = arena->take<uint32_t>(shape.samples());
    work.border = arena->take<uint32_t>(shape.samples());
    work.errors = arena->take<uint32_t>(size_t{2} * shape.columns * kRasterPredictors);
    work.magnitudes = arena->take<uint32_t>(size_t{2} * shape.columns * kRasterGroup);
    return work;
}

Status decode_raster(const LevelRequest& request, const OpenRaster& raster, const RasterShape& shape,
                     const RasterWork& work) {
    Chunk chunk;
    uint64_t offset = 0;
    std::span<const uint8_t> stream;
    if (Status s = find_level_chunk(request.header, 0, &chunk, &offset); s != Status::kOk) return s;
    if (Status s = read_payload(request.file, chunk, offset, &stream); s != Status::kOk) return s;
    RangeDecoder decoder(stream);
    RasterCoder<RangeDecoder> coder(&decoder, shape, work);
    coder.code_mask();
    for (uint32_t first = 0; first < shape.channels; first += kRasterGroup) {
        if (!coder.code_group(raster.table.group(first, request.header.bits))) return Status::kMalformed;
    }
    return decoder.intact() && coder.point_count() == raster.table.vertices ? Status::kOk : Status::kMalformed;
}

}  // namespace gim
