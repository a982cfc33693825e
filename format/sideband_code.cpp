#include "format/sideband_code.h"

#include <algorithm>
#include <array>
#include <bit>

#include "format/bits.h"
#include "format/ring.h"
#include "format/seam.h"

namespace gim {
namespace {

// The code of one sideband, most significant bit first:
//   4 bits  j: the node grid's side is 2^j + 1 (1..14), or 0: an open square, and nothing follows
//   start   in 0 .. ring-1
//   then, until the ring is full, one of
//     1                  the mate of the path opened last and not closed yet
//     01  length         a new path that will have a mate
//     001 length         an original boundary
//     000 number         the mate of the open path with that number, counted back from the one before the last
//   zeros up to a whole byte
// A number in 0 .. m takes bit_width(m) bits. A length is stored less one; m is what the ring has room for.

// The paths without a mate yet, oldest first, and what they leave of the ring.
struct OpenPaths {
    std::array<uint16_t, kMaxCutPaths> path;
    uint32_t count = 0;
    uint32_t room = 0;  // ring length minus all paths so far and the mates they still need

    void push(uint32_t p) { path[count++] = static_cast<uint16_t>(p); }
    uint32_t remove(uint32_t back) {  // back = 0: the one opened last
        const uint32_t at = count - 1 - back;
        const uint32_t removed = path[at];
        --count;
        for (uint32_t i = at; i < count; ++i) path[i] = path[i + 1];
        return removed;
    }
};

}  // namespace

void append_sideband(const Sideband& sideband, std::vector<uint8_t>* bytes) {
    BitWriter writer(bytes);
    if (sideband.paths.empty()) {
        writer.write(0, 4);
        return;
    }
    OpenPaths open;
    open.room = ring_length(sideband.node_side);
    writer.write(static_cast<uint32_t>(std::countr_zero(sideband.node_side - 1)), 4);
    writer.write_up_to(sideband.start, open.room - 1);
    for (uint32_t i = 0; i < sideband.paths.size(); ++i) {
        const CutPath& path = sideband.paths[i];
        if (path.mate == kNoMate) {
            writer.write(1, 3);
            writer.write_up_to(path.length - 1, open.room - 1);
            open.room -= path.length;
        } else if (path.mate > i) {
            writer.write(1, 2);
            writer.write_up_to(path.length - 1, open.room / 2 - 1);
            open.room -= 2 * path.length;
            open.push(i);
        } else {
            uint32_t back = 0;
            while (open.path[open.count - 1 - back] != path.mate) ++back;
            if (back == 0) {
                writer.write(1, 1);
            } else {
                writer.write(0, 3);
                writer.write_up_to(back - 1, open.count - 2);
            }
            open.remove(back);
        }
    }
}

Status parse_sideband(std::span<const uint8_t> bytes, std::span<CutPath> paths, ParsedSideband* parsed) {
    BitReader reader(bytes);
    *parsed = {};
    uint32_t exponent = 0;
    if (!reader.read(4, &exponent) || exponent > kMaxSideExponent) return Status::kMalformed;
    parsed->node_side = exponent == 0 ? 2 : (1u << exponent) + 1;
    OpenPaths open;
    open.room = ring_length(parsed->node_side);
    if (exponent > 0) {
        if (!reader.read_up_to(open.room - 1, &parsed->start)) return Status::kMalformed;
        uint32_t i = 0;
        for (; open.room > 0 || open.count > 0; ++i) {
            if (i == paths.size() || i == kMaxCutPaths) return Status::kMalformed;
            uint32_t bit = 0, zeros = 0, value = 0;
            while (zeros < 3) {
                if (!reader.read(1, &bit)) return Status::kMalformed;
                if (bit) break;
                ++zeros;
            }
            if (zeros == 0 || zeros == 3) {
                if (open.count < (zeros == 0 ? 1u : 2u)) return Status::kMalformed;
                if (zeros == 3) {
                    if (!reader.read_up_to(open.count - 2, &value)) return Status::kMalformed;
                    ++value;
                }
                const uint32_t mate = open.remove(value);
                paths[i] = {mate, paths[mate].length};
                paths[mate].mate = i;
            } else {
                const uint32_t each = zeros == 1 ? 2 : 1;  // a new path needs room for its mate too
                if (open.room < each || !reader.read_up_to(open.room / each - 1, &value)) return Status::kMalformed;
                paths[i] = {kNoMate, value + 1};
                open.room -= each * (value + 1);
                if (zeros == 1) open.push(i);
            }
        }
        parsed->path_count = i;
    }
    if (!reader.rest_is_zero()) return Status::kMalformed;
    parsed->size = reader.bytes_read();
    return Status::kOk;
}

Sideband with_coarsest_node_grid(Sideband sideband) {
    const auto is_even = [&] {
        return sideband.start % 2 == 0 && std::all_of(sideband.paths.begin(), sideband.paths.end(),
                                                      [](const CutPath& p) { return p.length % 2 == 0; });
    };
    if (sideband.paths.empty()) return {2, 0, {}};
    if (sideband.node_side == 2) {  // paths are stored on a grid of 3 at least
        sideband.node_side = 3;
        sideband.start *= 2;
        for (CutPath& p : sideband.paths) p.length *= 2;
    }
    while (sideband.node_side > 3 && is_even()) {
        sideband.node_side = (sideband.node_side - 1) / 2 + 1;
        sideband.start /= 2;
        for (CutPath& p : sideband.paths) p.length /= 2;
    }
    return sideband;
}

}  // namespace gim
