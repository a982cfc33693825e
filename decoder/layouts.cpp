#include "decoder/layouts.h"

#include "decoder/charts/read_charts.h"
#include "decoder/raster/read_raster.h"
#include "decoder/squares/read_squares.h"
#include "decoder/tiles/read_tiles.h"

namespace gim {
namespace {

// In the order of FileLayout.
constexpr LevelReader kReaders[] = {
    {square_level_info, decode_square_mesh, decode_square_grid, read_square_seams, open_square_plane,
     square_plane_scratch_size, decode_square_plane},
    {chart_level_info, decode_chart_mesh, decode_chart_grid, read_chart_seams, open_chart_plane,
     chart_plane_scratch_size, decode_chart_plane},
    {tile_level_info, decode_tile_mesh, decode_tile_grid, read_tile_seams, open_tile_plane, tile_plane_scratch_size,
     decode_tile_plane},
    {raster_level_info, decode_raster_mesh, decode_raster_grid, read_raster_seams, open_raster_plane,
     raster_plane_scratch_size, decode_raster_plane},
};
static_assert(static_cast<size_t>(FileLayout::kSquares) == 0 && static_cast<size_t>(FileLayout::kCharts) == 1 &&
              static_cast<size_t>(FileLayout::kTiles) == 2);
constexpr size_t kRasters = 3;

}  // namespace

const LevelReader& reader_of(FileLayout layout) {
    return kReaders[layout == FileLayout::kRaster ? kRasters : static_cast<size_t>(layout)];
}

}  // namespace gim
