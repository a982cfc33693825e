// Decodes an imported image: its mask and the numbers of its channels.  spec/gim-format.md, "Rasters".
#pragma once

#include <cstdint>

#include "decoder/layout/level_reader.h"
#include "decoder/pyramid/arena.h"
#include "format/raster_code.h"
#include "format/raster_table.h"

namespace gim {

// The chunk of seams, read and checked.
struct OpenRaster {
    RasterTable table;
    uint64_t prefix = 0;  // bytes of the file, from its start, that the samples need
};

// request.level other than 0: kNoSuchLevel.
Status open_raster(const LevelRequest& request, OpenRaster* raster);

// The arrays of a decoder but for the values.
RasterWork lay_out_raster(const RasterShape& shape, Arena* arena);

// Decodes the mask and shape.channels channels of each sample: all of the file, or the positions alone.
Status decode_raster(const LevelRequest& request, const OpenRaster& raster, const RasterShape& shape,
                     const RasterWork& work);

}  // namespace gim
