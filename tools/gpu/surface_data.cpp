#include "tools/gpu/surface_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gim/decoder.hpp"
#include "gim/refine.h"

namespace gim {
namespace {

Error error_of(gim_status status) { return {Stage::kInput, std::string(gim_status_text(status))}; }

// An image as bytes, with what the calls of the decoder want.
struct Source {
    const gim_info& info;
    std::span<const uint8_t> bytes;
    uint32_t image;
};

gim_status read_level(const Source& source, uint32_t level, gim_level_info* shape) {
    return gim_read_level_info(&source.info, source.bytes.data(), source.bytes.size(), source.image, level, shape);
}

struct NormalMap {
    uint32_t width = 0, height = 0;
    std::vector<float> normals;
};

gim_status read_plane(const Source& source, NormalMap* map) {
    gim_plane_info plane;
    gim_status s = gim_read_plane_info(&source.info, source.bytes.data(), source.bytes.size(), source.image,
                                       GIM_PLANE_NORMALS, 0, &plane);
    if (s != GIM_OK) return s;
    map->width = plane.width;
    map->height = plane.height;
    map->normals.resize(size_t{3} * plane.width * plane.height);
    Scratch scratch(plane.scratch_size);
    return gim_decode_plane(&source.info, source.bytes.data(), source.bytes.size(), source.image, GIM_PLANE_NORMALS, 0,
                            map->normals.data(), scratch.data(), scratch.size());
}

gim_status read_normals(const Source& source, const gim_level_info& finest, NormalMap* map) {
    const gim_status s = read_plane(source, map);
    if (s != GIM_NO_SUCH_PLANE) return s;
    map->width = finest.width;
    map->height = finest.height;
    const size_t samples = size_t{finest.width} * finest.height;
    map->normals.resize(3 * samples);
    std::vector<float> positions(3 * samples);
    Scratch scratch(finest.scratch_size);
    return gim_decode_grid(&source.info, source.bytes.data(), source.bytes.size(), source.image, 0, positions.data(),
                           map->normals.data(), nullptr, nullptr, scratch.data(), scratch.size());
}

// Triples as 8 bits each, with a fourth. Undefined ones are 0.
std::vector<int8_t> coarse_normals(std::span<const float> normals) {
    std::vector<int8_t> coarse(normals.size() / 3 * 4, 0);
    for (size_t i = 0; i < normals.size(); ++i) {
        if (std::isfinite(normals[i]))
            coarse[i / 3 * 4 + i % 3] = static_cast<int8_t>(std::lround(127 * std::clamp(normals[i], -1.0f, 1.0f)));
    }
    return coarse;
}

void place_in_map(const Source& source, const gim_level_info& finest, const gim_level_info& shape, uint32_t intervals,
                  uint32_t level, SurfaceData* out) {
    const bool has_slots = source.info.layout == GIM_LAYOUT_TILES;
    out->slot = has_slots ? intervals + 1 : std::max(shape.width, shape.height);
    const double slot = has_slots ? std::ldexp(intervals, static_cast<int>(level)) + 1 : 0;
    const double spans[2] = {(out->map_width - 1.0) / (finest.width - 1.0),
                             (out->map_height - 1.0) / (finest.height - 1.0)};
    for (size_t k = 0; k < 2; ++k) {
        out->slot_texels[k] = slot * spans[k];
        out->interval_texels[k] = std::ldexp(spans[k], static_cast<int>(level));
    }
}

}  // namespace

Result<SurfaceData> read_surface_data(const gim_info& info, std::span<const uint8_t> bytes, uint32_t image,
                                      uint32_t level) {
    const Source source{info, bytes, image};
    gim_level_info finest, shape;
    gim_domain_info domain;
    gim_status s = read_level(source, 0, &finest);
    if (s == GIM_OK) s = read_level(source, level, &shape);
    if (s == GIM_OK) s = gim_read_domain_info(&info, bytes.data(), bytes.size(), image, level, &domain);
    if (s != GIM_OK) return error_of(s);

    SurfaceData out;
    out.width = shape.width;
    out.height = shape.height;
    out.positions.resize(size_t{3} * shape.width * shape.height);
    Scratch scratch(shape.scratch_size);
    s = gim_decode_positions(&info, bytes.data(), bytes.size(), image, level, out.positions.data(), scratch.data(),
                             scratch.size());
    NormalMap map;
    if (s == GIM_OK) s = read_normals(source, finest, &map);
    if (s != GIM_OK) return error_of(s);
    out.map_width = map.width;
    out.map_height = map.height;
    out.normals = coarse_normals(map.normals);
    place_in_map(source, finest, shape, domain.intervals, level, &out);
    return out;
}

SurfaceData surface_data_of(const gim_domain* domain, const gim_domain_info& shape, bool is_tiles,
                            std::span<const float> positions, std::span<const float> normals) {
    SurfaceData out;
    out.width = out.map_width = shape.width;
    out.height = out.map_height = shape.height;
    std::vector<float> laid(size_t{3} * shape.width * shape.height);
    gim_lay_out_samples(domain, normals.data(), 3, laid.data());
    out.normals = coarse_normals(laid);
    gim_lay_out_samples(domain, positions.data(), 3, laid.data());
    out.positions = std::move(laid);
    out.slot = is_tiles ? shape.intervals + 1 : std::max(shape.width, shape.height);
    out.slot_texels.fill(is_tiles ? out.slot : 0);
    out.interval_texels.fill(1);
    return out;
}

SurfaceStore join_surfaces(std::span<const SurfaceData> surfaces) {
    SurfaceStore store;
    for (const SurfaceData& s : surfaces) {
        store.map_width = std::max(store.map_width, s.map_width);
        store.map_height += s.map_height;
    }
    store.normals.resize(size_t{4} * store.map_width * store.map_height);
    uint32_t top = 0;
    for (const SurfaceData& s : surfaces) {
        ShaderDomain domain;
        domain.first_sample = static_cast<uint32_t>(store.positions.size() / 3);
        domain.width = s.width;
        domain.slot = s.slot;
        const double sizes[2] = {static_cast<double>(store.map_width), static_cast<double>(store.map_height)};
        for (size_t k = 0; k < 2; ++k) {
            domain.map_origin[k] = static_cast<float>(((k == 1 ? top : 0) + 0.5) / sizes[k]);
            domain.map_slot[k] = static_cast<float>(s.slot_texels[k] / sizes[k]);
            domain.map_interval[k] = static_cast<float>(s.interval_texels[k] / sizes[k]);
        }
        store.domains.push_back(domain);
        store.positions.insert(store.positions.end(), s.positions.begin(), s.positions.end());
        for (uint32_t row = 0; row < s.map_height; ++row)
            std::copy_n(s.normals.begin() + static_cast<ptrdiff_t>(size_t{4} * row * s.map_width),
                        size_t{4} * s.map_width,
                        store.normals.begin() + static_cast<ptrdiff_t>(size_t{4} * (top + row) * store.map_width));
        top += s.map_height;
    }
    return store;
}

}  // namespace gim
