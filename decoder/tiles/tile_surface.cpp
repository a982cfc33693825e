#include "decoder/tiles/tile_surface.h"

#include <algorithm>
#include <utility>

#include "decoder/pyramid/cells.h"
#include "decoder/pyramid/vector3.h"

namespace gim {

void triangulate_tiles(const TileSurface& surface, const TriangulateTilesWork& work, const TileNumbers& numbers,
                       uint32_t* triangles) {
    const uint32_t side = surface.side, last = side - 1;
    const size_t width = size_t{side} + 1;
    float *top = work.rows, *bottom = work.rows + 3 * width;
    uint32_t *above = work.numbers, *below = work.numbers + width;
    for (uint32_t t = 0; t < surface.complex.tiles; ++t) {
        const float* samples = surface.samples + 3 * t * surface.tile_size();
        split_row(samples, width, top);
        numbers.load(t, 0, above);
        for (uint32_t r = 0; r < side; ++r) {
            split_row(samples + 3 * (r + 1) * width, width, bottom);
            numbers.load(t, r + 1, below);
            find_shorter_main(top, bottom, width, work.is_main);
            if (r == 0 || r == last) {  // through the corners of the tile
                work.is_main[0] = r == 0;
                work.is_main[last] = r == last;
            }
            write_cells(above, below, work.is_main, side, triangles);
            triangles += size_t{6} * side;
            std::swap(top, bottom);
            std::swap(above, below);
        }
    }
}

void tile_normals(const TileSurface& surface, const TileNumbers& numbers, uint32_t count, uint32_t* row,
                  float* normals) {
    const uint32_t side = surface.side;
    const size_t width = 3 * (size_t{side} + 1);
    std::fill_n(normals, 3 * size_t{count}, 0.0f);
    for (uint32_t t = 0; t < surface.complex.tiles; ++t) {
        const float* samples = surface.samples + 3 * t * surface.tile_size();
        for (uint32_t r = 0; r <= side; ++r) {
            numbers.load(t, r, row);
            const float *here = samples + r * width, *up = r > 0 ? here - width : here,
                        *down = r < side ? here + width : here;
            for (uint32_t c = 0; c <= side; ++c) {
                const size_t at = 3 * size_t{c};
                const float *left = here + (c > 0 ? at - 3 : at), *right = here + (c < side ? at + 3 : at);
                float u[3], v[3], n[3];
                for (size_t k = 0; k < 3; ++k) {
                    u[k] = right[k] - left[k];
                    v[k] = down[at + k] - up[at + k];
                }
                cross(u, v, n);
                float* sum = normals + 3 * size_t{row[c]};
                for (size_t k = 0; k < 3; ++k) sum[k] = sum[k] + n[k];
            }
        }
    }
    for (size_t i = 0; i < count; ++i) normalize(normals + 3 * i);
}

}  // namespace gim
