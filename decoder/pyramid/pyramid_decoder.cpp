#include "decoder/pyramid/pyramid_decoder.h"

namespace gim {

void lay_out_samples(uint32_t columns, uint32_t rows, Arena* arena, PyramidWorkspace* ws) {
    const uint32_t low_columns = low_count(columns), low_rows = low_count(rows);
    const size_t all = size_t{columns} * rows * 3, low = size_t{low_columns} * low_rows * 3;
    // Bands need less memory, but the base is decoded there, too.
    ws->bands[0] = arena->take<int32_t>(all);
    ws->bands[1] = arena->take<int32_t>(low);
    ws->images[0] = arena->take<float>(all);
    ws->images[1] = arena->take<float>(low);
}

void lay_out_coder(uint32_t columns, Arena* arena, PyramidWorkspace* ws) {
    ws->models = arena->take<BandModels>(1);
    ws->band_work = BandWork(arena->take<uint32_t>(BandWork::size(columns)), columns);
    ws->synthesis = arena->take<float>(synthesis_work_size(columns));
}

}  // namespace gim
