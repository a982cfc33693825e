// libFuzzer: the whole C interface. Corrects checksums first, so that the fuzzer gets to the streams.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "format/bytes.h"
#include "format/checksum.h"
#include "format/container.h"
#include "gim/clusters.h"
#include "gim/decoder.hpp"
#include "gim/refine.h"

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
            if (kind == GIM_PLANE_DISPLACEMENTS ? !std::isfinite(v) : !(v >= -1.000001f && v <= 1.000001f))
                __builtin_trap();
    }
}

void decode_labels(const gim_info& info, const std::vector<uint8_t>& bytes, uint32_t image, uint32_t level) {
    gim_labels_info of;
    gim_level_info l;
    if (gim_read_labels_info(&info, bytes.data(), bytes.size(), image, level, &of) != GIM_OK) return;
    if (gim_read_level_info(&info, bytes.data(), bytes.size(), image, level, &l) != GIM_OK) __builtin_trap();
    if (2 * of.cell_count != l.triangle_count || of.prefix_size < l.prefix_size) __builtin_trap();
    std::vector<uint8_t> labels(of.cell_count), again(labels), scratch(of.scratch_size, 0xFF), clear(of.scratch_size);
    const gim_status status = gim_decode_labels(&info, bytes.data(), bytes.size(), image, level, labels.data(),
                                                scratch.data(), scratch.size());
    if (gim_decode_labels(&info, bytes.data(), bytes.size(), image, level, again.data(), clear.data(), clear.size()) !=
        status)
        __builtin_trap();
    if (status == GIM_OK && labels != again) __builtin_trap();
}

// Refines over a domain, goes back to the base, and makes clusters.
void use_domain(const gim_domain* domain, const gim_domain_info& shape) {
    const auto most = static_cast<uint32_t>(std::min<uint64_t>(shape.most_triangles, 2 * shape.tile_count + 500));
    gim::Scratch memory(gim_refined_size(domain, most));
    gim_refined* mesh = nullptr;
    if (gim_begin_refined(domain, most, memory.data(), memory.size(), &mesh) != GIM_OK) __builtin_trap();
    gim_rule rule{};
    for (const float error : {1e-30f, 1e30f}) {
        rule.object_error = error;
        if (gim_refine(mesh, &rule, 2000, nullptr) != GIM_OK) __builtin_trap();
        uint32_t count = 0, patches = 0;
        const uint32_t* triangles = gim_refined_triangles(mesh, &count);
        if (count > most) __builtin_trap();
        for (size_t i = 0; i < 3 * size_t{count}; ++i)
            if (triangles[i] >= shape.vertex_count) __builtin_trap();
        std::vector<gim_patch> list(2 * size_t{count});
        if (gim_read_patches(mesh, list.data(), 2 * count, &patches) != GIM_OK) __builtin_trap();
    }
    gim_cluster_sizes sizes;
    if (gim_read_cluster_sizes(domain, 4, &sizes) != GIM_OK) return;
    std::vector<gim_cluster> clusters(sizes.cluster_count);
    std::vector<uint32_t> vertices(sizes.vertex_count);
    std::vector<uint8_t> triangles(3 * size_t{sizes.triangle_count});
    gim::Scratch scratch(sizes.scratch_size);
    gim_cluster_tree tree;
    if (gim_decode_clusters(domain, 4, clusters.data(), vertices.data(), triangles.data(), scratch.data(),
                            scratch.size(), &tree) != GIM_OK)
        __builtin_trap();
    if (tree.cluster_count > sizes.cluster_count || tree.vertex_count > sizes.vertex_count) __builtin_trap();
}

// Opens the domain of level 0, and that of its displacements.
void refine(const gim_info& info, const std::vector<uint8_t>& bytes, uint32_t image) {
    gim_level_info l;
    if (gim_read_level_info(&info, bytes.data(), bytes.size(), image, 0, &l) != GIM_OK) return;
    std::vector<float> x(size_t{l.vertex_count} * 3);
    gim::Scratch of_level(l.scratch_size);
    if (gim_decode_mesh(&info, bytes.data(), bytes.size(), image, 0, x.data(), nullptr, nullptr, nullptr,
                        of_level.data(), of_level.size()) != GIM_OK)
        return;
    gim_domain_info shape;
    if (gim_read_domain_info(&info, bytes.data(), bytes.size(), image, 0, &shape) != GIM_OK) return;
    gim::Scratch memory(shape.domain_size), scratch(shape.scratch_size);
    const gim_domain* domain = nullptr;
    if (gim_open_domain(&info, bytes.data(), bytes.size(), image, 0, x.data(), memory.data(), memory.size(),
                        scratch.data(), scratch.size(), &domain) != GIM_OK)
        return;
    use_domain(domain, shape);
    gim_plane_info p;
    if (gim_read_detailed_domain_info(&info, bytes.data(), bytes.size(), image, 0, &shape) != GIM_OK ||
        gim_read_plane_info(&info, bytes.data(), bytes.size(), image, GIM_PLANE_DISPLACEMENTS, 0, &p) != GIM_OK)
        return;
    std::vector<float> values(size_t{p.width} * p.height * 3), detailed(size_t{shape.vertex_count} * 3);
    gim::Scratch of_plane(p.scratch_size), fine_memory(shape.domain_size), fine_scratch(shape.scratch_size);
    if (gim_decode_plane(&info, bytes.data(), bytes.size(), image, GIM_PLANE_DISPLACEMENTS, 0, values.data(),
                         of_plane.data(), of_plane.size()) != GIM_OK)
        return;
    if (gim_open_detailed_domain(&info, bytes.data(), bytes.size(), image, 0, x.data(), values.data(), detailed.data(),
                                 fine_memory.data(), fine_memory.size(), fine_scratch.data(), fine_scratch.size(),
                                 &domain) != GIM_OK)
        __builtin_trap();
    use_domain(domain, shape);
}

// Decodes the imported image, if the file holds one.
void decode_raster(const gim_info& info, const std::vector<uint8_t>& bytes) {
    gim_raster_info r;
    if (gim_read_raster_info(&info, bytes.data(), bytes.size(), &r) != GIM_OK) return;
    std::vector<int32_t> values(size_t{r.width} * r.height * r.channels);
    std::vector<uint8_t> mask(size_t{r.width} * r.height);
    gim::Scratch scratch(r.scratch_size);
    (void)gim_decode_raster(&info, bytes.data(), bytes.size(), values.data(), mask.data(), scratch.data(),
                            scratch.size());
    gim_raster_channel channel;
    for (uint32_t k = 0; gim_read_raster_channel(&info, bytes.data(), bytes.size(), k, &channel) == GIM_OK; ++k) {
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
        for (uint32_t kind = 0; kind < 3; ++kind) decode_plane(info, bytes, image, kind);
    for (uint32_t image = 0; image < info.image_count; ++image)
        for (uint32_t level = 0; level < info.level_count; ++level) decode_labels(info, bytes, image, level);
    for (uint32_t image = 0; image < info.image_count; ++image) refine(info, bytes, image);
    decode_raster(info, bytes);
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
