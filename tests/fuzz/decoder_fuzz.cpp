// libFuzzer: the whole C interface. Corrects checksums first, so that the fuzzer gets to the streams.
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "format/bytes.h"
#include "format/checksum.h"
#include "format/container.h"
#include "gim/decoder.hpp"

namespace {

constexpr gim_limits kLimits = {129 * 129 * 2, 8, 129};

// Signs the chunks in the index, then the index.
void sign(std::vector<uint8_t>* bytes) {
    using namespace gim;
    ByteReader reader(*bytes);
    uint64_t index_size = 0, images = 0, next = 0;
    uint8_t kind = 0;
    if (!reader.skip(8) || !reader.read_leb128(&index_size) || index_size < 13 || index_size > bytes->size()) return;
    const size_t body = static_cast<size_t>(index_size) - 4;
    if (!reader.read_u8(&kind) || !reader.skip(2) || !reader.read_leb128(&images)) return;
    // Images and their sides, or width and height, or three numbers and the shape of tiles.
    const int layout = kind & 3;
    const bool sizes = layout == 0   ? reader.skip(static_cast<size_t>(images))
                       : layout == 1 ? reader.read_leb128(&next)
                                     : reader.read_leb128(&next) && reader.read_leb128(&next) && reader.skip(1);
    if (!sizes) return;
    if (reader.skip(kind & 4 ? 20 : 16)) {
        uint64_t offset = index_size;
        while (reader.position() < body) {
            uint64_t tag = 0, size = 0, raw = 0;
            if (!reader.read_leb128(&tag) || !reader.read_leb128(&size) || ((tag & 2) && !reader.read_leb128(&raw)))
                break;
            const size_t at = reader.position();
            if (!reader.skip(2) || offset > bytes->size() || size > bytes->size() - offset) break;
            const uint16_t crc =
                crc16(std::span(*bytes).subspan(static_cast<size_t>(offset), static_cast<size_t>(size)));
            (*bytes)[at] = static_cast<uint8_t>(crc);
            (*bytes)[at + 1] = static_cast<uint8_t>(crc >> 8);
            offset += size;
        }
    }
    const uint32_t crc = crc32(std::span(*bytes).first(body));
    for (size_t i = 0; i < 4; ++i) (*bytes)[body + i] = static_cast<uint8_t>(crc >> (8 * i));
}

// Fills memory, so that a read before the first write shows.
void spoil(gim::Scratch& memory, int value) { std::memset(memory.data(), value, memory.size()); }
bool same(const std::vector<float>& a, const std::vector<float>& b) {
    return std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

void decode(const gim_info& info, const std::vector<uint8_t>& bytes, uint32_t image, uint32_t level) {
    gim_level_info l;
    if (gim_read_level_info(&info, bytes.data(), bytes.size(), image, level, &l) != GIM_OK) return;
    std::vector<float> x(size_t{l.vertex_count} * 3), n(x.size()), uv(size_t{l.vertex_count} * 2);
    std::vector<uint32_t> t(size_t{l.triangle_count} * 3);
    gim::Scratch scratch(l.scratch_size);
    spoil(scratch, 0xFF);
    const gim_status status = gim_decode_mesh(&info, bytes.data(), bytes.size(), image, level, x.data(), n.data(),
                                              uv.data(), t.data(), scratch.data(), l.scratch_size);
    if (l.width == 0 || l.height == 0 || uint64_t{l.width} * l.height > kLimits.max_samples) __builtin_trap();
    const size_t samples = size_t{l.width} * l.height;
    std::vector<float> grid(samples * 3), grid_normals(samples * 3), grid_uv(samples * 2);
    std::vector<uint32_t> grid_t(t.size());
    spoil(scratch, 0);
    if (gim_decode_grid(&info, bytes.data(), bytes.size(), image, level, grid.data(), grid_normals.data(),
                        grid_uv.data(), grid_t.data(), scratch.data(), l.scratch_size) != status)
        __builtin_trap();
    if (status != GIM_OK) return;
    if (l.prefix_size > bytes.size()) __builtin_trap();
    const bool charts = info.layout == GIM_LAYOUT_MCGIM;
    for (const float v : uv)
        if (!(v >= 0 && v <= 1) && !(charts && level > 0 && std::isfinite(v))) __builtin_trap();
    for (const float v : x)
        if (!std::isfinite(v)) __builtin_trap();
    for (const float v : n)
        if (!std::isfinite(v)) __builtin_trap();
    for (const float v : grid)
        if (!std::isfinite(v) && !(info.layout != GIM_LAYOUT_GIM && std::isnan(v))) __builtin_trap();
    for (size_t i = 0; i < t.size(); ++i) {
        if (t[i] >= l.vertex_count || grid_t[i] >= samples) __builtin_trap();
        // Charts of hostile files may overlap at level 0.
        if (charts && level == 0) continue;
        if (std::memcmp(&x[t[i] * size_t{3}], &grid[grid_t[i] * size_t{3}], 12) != 0) __builtin_trap();
    }
    std::vector<float> again(grid.size());
    spoil(scratch, 0x3F);
    if (gim_decode_positions(&info, bytes.data(), bytes.size(), image, level, again.data(), scratch.data(),
                             l.scratch_size) != GIM_OK ||
        !same(again, grid))
        __builtin_trap();
}

void decode_plane(const gim_info& info, const std::vector<uint8_t>& bytes, uint32_t image, uint32_t kind) {
    gim_plane_info p{};
    for (uint32_t level = 0; level <= p.coarsest_level; ++level) {
        if (gim_read_plane_info(&info, bytes.data(), bytes.size(), image, kind, level, &p) != GIM_OK) return;
        std::vector<float> values(size_t{p.width} * p.height * 3);
        gim::Scratch scratch(p.scratch_size);
        if (gim_decode_plane(&info, bytes.data(), bytes.size(), image, kind, level, values.data(), scratch.data(),
                             p.scratch_size) != GIM_OK)
            return;
        for (const float v : values)
            if (!(v >= -1.000001f && v <= 1.000001f)) __builtin_trap();
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    std::vector<uint8_t> bytes(data, data + size);
    sign(&bytes);
    gim_info info;
    if (gim_read_info(bytes.data(), bytes.size(), &kLimits, &info) != GIM_OK) return 0;
    for (uint32_t image = 0; image < info.image_count; ++image)
        for (uint32_t level = 0; level < info.level_count; ++level) decode(info, bytes, image, level);
    for (uint32_t image = 0; image < info.image_count; ++image)
        for (uint32_t kind = 0; kind < 2; ++kind) decode_plane(info, bytes, image, kind);
    uint32_t paths = 0;
    for (uint32_t level = 0; level < info.level_count; ++level)
        (void)gim_read_seams(&info, bytes.data(), bytes.size(), 0, level, nullptr, &paths);
    gim_chunk chunk;
    for (uint32_t i = 0; gim_read_chunk(&info, bytes.data(), bytes.size(), i, &chunk) == GIM_OK; ++i) {
    }
    uint64_t text_size = 0;
    std::vector<char> text(4096);
    gim::Scratch scratch(gim_text_scratch_size());
    (void)gim_read_text(&info, bytes.data(), bytes.size(), text.data(), text.size(), &text_size, scratch.data(),
                        scratch.size());
    return 0;
}
