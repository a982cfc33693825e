#include "format/rim.h"

namespace gim {

namespace {

// A number that rises in the order of the stream: the first row, the last one, then both columns row by row.
uint32_t place_in_stream(uint32_t side, uint32_t k) {
    const GridPoint p = ring_point(side, k);
    if (p.row % 2 == 0) return p.row == 0 ? p.column : side + p.column;
    return 2 * side + 2 * p.row + (p.column != 0);
}

}  // namespace

void rim_sources(const SeamTable& seams, uint32_t side, std::span<uint32_t> source) {
    const uint32_t ring = ring_length(side);
    for (uint32_t k = 0; k < ring; ++k) source[k] = k;
    if (seams.path_count == 0 || side <= seams.node_side) return;
    const uint32_t scale = (side - 1) / (seams.node_side - 1);
    const auto wrap = [ring](uint32_t k) { return k >= ring ? k - ring : k; };
    const auto is_corner = [side](uint32_t k) { return (k & (side - 2)) == 0; };  // side - 1 is a power of two
    for (uint32_t i = 0; i < seams.path_count; ++i) {
        const uint32_t mate = seams.mate[i], length = seams.length(i) * scale;
        source[wrap(seams.first[i] * scale)] = kRunEnd;
        if (mate == kNoMate || mate < i) continue;
        for (uint32_t t = 1; t < length; ++t) {
            const uint32_t a = wrap(seams.first[i] * scale + t), b = wrap(seams.first[mate] * scale + length - t);
            if (is_corner(a)) source[b] = kRunEnd;
            if (is_corner(b)) source[a] = kRunEnd;
            if (a % 2 == 0) continue;  // then b is even, too
            place_in_stream(side, a) < place_in_stream(side, b) ? source[b] = a : source[a] = b;
        }
    }
}

}  // namespace gim
