#include "decoder/triangulate.h"

#include <algorithm>

#include "decoder/vector3.h"
#include "format/seam.h"

namespace gim {
namespace {

// a b   a: first sample of the cell; rows go down, columns to the right; seen from outside the row axis points up, so
// c d   that a, b, d is counter-clockwise (format/ring.h).
void write_cell(uint32_t a, uint32_t b, uint32_t c, uint32_t d, bool main, uint32_t* out) {
    out[0] = a;
    out[1] = b;
    out[2] = main ? d : c;
    out[3] = main ? a : b;
    out[4] = d;
    out[5] = c;
}

}  // namespace

void VertexNumbers::row(uint32_t r, uint32_t* ids) const {
    if (!class_of) {
        for (uint32_t c = 0; c < side; ++c) ids[c] = r * side + c;
        return;
    }
    if (r == 0 || r == side - 1) {
        for (uint32_t c = 0; c < side; ++c) ids[c] = class_of[ring_index(side, r, c)];
        return;
    }
    ids[0] = class_of[ring_index(side, r, 0)];
    ids[side - 1] = class_of[ring_index(side, r, side - 1)];
    const uint32_t begin = class_count + (r - 1) * (side - 2);
    for (uint32_t c = 1; c + 1 < side; ++c) ids[c] = begin + c - 1;
}

void triangulate(const float* samples, uint32_t side, const uint32_t* class_of, const VertexNumbers& numbers,
                 uint32_t* row_ids, uint32_t* triangles) {
    uint32_t* top = row_ids;
    uint32_t* bottom = row_ids + side;
    const auto class_at = [class_of](uint32_t k) { return class_of[k]; };
    numbers.row(0, top);
    for (uint32_t r = 0; r + 1 < side; ++r) {
        numbers.row(r + 1, bottom);
        const float* a = samples + size_t{r} * side * 3;
        const float* c = a + size_t{side} * 3;
        const auto is_shorter_main = [&](uint32_t i) {
            return squared_distance(a + size_t{i} * 3, c + size_t{i} * 3 + 3) <=
                   squared_distance(a + size_t{i} * 3 + 3, c + size_t{i} * 3);
        };
        const auto write_rim_cell = [&](uint32_t i) {
            const Split split = rim_split(side, r, i, class_at);
            const bool main = split == Split::kMain || (split != Split::kAnti && is_shorter_main(i));
            write_cell(top[i], top[i + 1], bottom[i], bottom[i + 1], main, triangles + size_t{i} * 6);
        };
        if (r == 0 || r + 2 == side) {
            for (uint32_t i = 0; i + 1 < side; ++i) write_rim_cell(i);
        } else {
            write_rim_cell(0);
            for (uint32_t i = 1; i + 2 < side; ++i)
                write_cell(top[i], top[i + 1], bottom[i], bottom[i + 1], is_shorter_main(i), triangles + size_t{i} * 6);
            write_rim_cell(side - 2);
        }
        triangles += size_t{side - 1} * 6;
        std::swap(top, bottom);
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
