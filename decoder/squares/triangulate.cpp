#include "decoder/squares/triangulate.h"

#include <algorithm>

#include "decoder/pyramid/cells.h"
#include "decoder/pyramid/vector3.h"
#include "format/seam.h"

namespace gim {

uint32_t VertexNumbers::at(uint32_t row, uint32_t column) const {
    if (!class_of) return row * side + column;
    if (on_rim(side, row, column)) return class_of[ring_index(side, row, column)];
    return class_count + (row - 1) * (side - 2) + column - 1;
}

void triangulate(const float* samples, uint32_t side, const uint32_t* class_of, const VertexNumbers& numbers,
                 const TriangulateWork& work, uint32_t* triangles) {
    const auto class_at = [class_of](uint32_t k) { return class_of[k]; };
    const uint32_t cells = side - 1;
    const uint32_t* is_main = work.is_main;
    float *top = work.rows, *bottom = work.rows + size_t{side} * 3;
    split_row(samples, side, top);
    for (uint32_t r = 0; r < cells; ++r, triangles += size_t{cells} * 6) {
        split_row(samples + size_t{r + 1} * side * 3, side, bottom);
        find_shorter_main(top, bottom, side, work.is_main);
        std::swap(top, bottom);
        const auto write_rim_cells = [&](uint32_t begin, uint32_t end) {
            uint32_t id[4] = {numbers.at(r, begin), 0, numbers.at(r + 1, begin), 0};
            for (uint32_t i = begin; i < end; ++i) {
                id[1] = numbers.at(r, i + 1);
                id[3] = numbers.at(r + 1, i + 1);
                const Split split = rim_split(side, r, i, class_at);
                const bool main = split == Split::kMain || (split != Split::kAnti && is_main[i] != 0);
                write_cell(id[0], id[1], id[2], id[3], main, triangles + size_t{i} * 6);
                id[0] = id[1];
                id[2] = id[3];
            }
        };
        if (r == 0 || r + 1 == cells) {
            write_rim_cells(0, cells);
        } else {
            write_rim_cells(0, 1);
            write_rising_cells(numbers.at(r, 1), numbers.at(r + 1, 1), is_main + 1, cells - 2, triangles + 6);
            write_rim_cells(cells - 1, cells);
        }
    }
}

void sample_normals(const float* samples, uint32_t side, const uint32_t* class_of, uint32_t class_count, float* sums,
                    float* normals) {
    const size_t width = size_t{side} * 3;
    for (uint32_t r = 0; r < side; ++r) {
        const float* up = samples + size_t{r == 0 ? 0 : r - 1} * width;
        const float* down = samples + size_t{std::min(r + 1, side - 1)} * width;
        const float* row = samples + size_t{r} * width;
        for (uint32_t c = 0; c < side; ++c) {
            const float* left = row + size_t{c == 0 ? 0 : c - 1} * 3;
            const float* right = row + size_t{std::min(c + 1, side - 1)} * 3;
            float u[3], v[3];
            for (int k = 0; k < 3; ++k) {
                u[k] = right[k] - left[k];
                v[k] = down[size_t{c} * 3 + k] - up[size_t{c} * 3 + k];
            }
            float* n = normals + size_t{r} * width + size_t{c} * 3;
            cross(u, v, n);
        }
    }
    const uint32_t ring = ring_length(side);
    const auto normal_at = [&](uint32_t k) {
        const GridPoint p = ring_point(side, k);
        return normals + size_t{p.row} * width + size_t{p.column} * 3;
    };
    std::fill_n(sums, size_t{class_count} * 3, 0.0f);
    for (uint32_t i = 0; i < ring; ++i) {
        for (int k = 0; k < 3; ++k) sums[size_t{class_of[i]} * 3 + k] += normal_at(i)[k];
    }
    for (uint32_t i = 0; i < ring; ++i) std::copy_n(sums + size_t{class_of[i]} * 3, 3, normal_at(i));
    for (size_t i = 0; i < size_t{side} * side; ++i) normalize(normals + i * 3);
}

}  // namespace gim
