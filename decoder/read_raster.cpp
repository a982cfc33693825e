// Imported images of the C interface.  spec/gim-format.md, "Rasters".
#include "decoder/raster/read_raster.h"

#include "decoder/with_image.h"
#include "gim/decoder.h"

using namespace gim;

namespace {

template <class F>
gim_status with_raster(const gim_info* info, const void* bytes, size_t size, const F& f) {
    return with_image(info, bytes, size, 0, [&](const LevelReader&, const LevelRequest& request) {
        return request.header.layout == FileLayout::kRaster ? f(request) : Status::kNoSuchPlane;
    });
}

}  // namespace

gim_status gim_read_raster_info(const gim_info* info, const void* bytes, size_t size, gim_raster_info* raster) {
    if (!raster) return GIM_BAD_ARGUMENT;
    return with_raster(info, bytes, size, [&](const LevelRequest& request) { return raster_info(request, raster); });
}

gim_status gim_read_raster_channel(const gim_info* info, const void* bytes, size_t size, uint32_t channel,
                                   gim_raster_channel* out) {
    if (!out) return GIM_BAD_ARGUMENT;
    return with_raster(info, bytes, size,
                       [&](const LevelRequest& request) { return raster_channel(request, channel, out); });
}

gim_status gim_decode_raster(const gim_info* info, const void* bytes, size_t size, int32_t* values, uint8_t* mask,
                             void* scratch, size_t scratch_size) {
    if (!values || !mask) return GIM_BAD_ARGUMENT;
    return with_raster(info, bytes, size, [&](const LevelRequest& request) {
        return decode_raster_values(request, values, mask, {scratch, scratch_size});
    });
}
