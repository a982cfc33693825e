// Reads the conformance vectors: what spec/vectors/README.md says a decoder must do with each of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "gim/decoder.hpp"
#include "gim/refine.h"

namespace gim::test {

// All levels that can be closed of all images, in order, then the planes, then details, then labels, then the raster. Stops at the first failure.
struct Decoded {
    gim_status status = GIM_OK;
    std::vector<float> samples;       // of gim_decode_grid
    std::vector<uint32_t> triangles;  // of gim_decode_mesh
    std::vector<float> vertices;      // normals, then texture coordinates, of gim_decode_mesh
    std::vector<float> planes;        // of gim_decode_plane
    std::vector<float> details;       // of gim_open_detailed_domain
    std::vector<float> bounds;        // errors of levels (RMS, maximum), then boxes of images (low, high), if told
    std::vector<uint8_t> labels;      // of gim_decode_labels
    std::vector<int32_t> raster;      // of gim_decode_raster: numbers, then the mask
    uint64_t prefix = 0;              // bytes of the file that all this needs
};

inline gim_status decode_one(const gim_info& info, const std::vector<uint8_t>& file, uint32_t image, uint32_t level,
                             uint32_t* coarsest, Decoded* out) {
    gim_level_info l;
    const gim_status found = gim_read_level_info(&info, file.data(), file.size(), image, level, &l);
    if (found != GIM_OK) return found;
    *coarsest = l.coarsest_level;
    out->prefix = out->prefix > l.prefix_size ? out->prefix : l.prefix_size;
    const size_t grid_size = size_t{l.width} * l.height, vertex_count = l.vertex_count;
    std::vector<float> samples(grid_size * 3), grid_normals(grid_size * 3), grid_texcoords(grid_size * 2);
    std::vector<float> positions(vertex_count * 3), normals(vertex_count * 3), texcoords(vertex_count * 2);
    std::vector<uint32_t> triangles(size_t{l.triangle_count} * 3), grid_triangles(triangles.size());
    Scratch scratch(l.scratch_size);
    gim_status s = gim_decode_grid(&info, file.data(), file.size(), image, level, samples.data(), grid_normals.data(),
                                   grid_texcoords.data(), grid_triangles.data(), scratch.data(), scratch.size());
    if (s == GIM_OK)
        s = gim_decode_mesh(&info, file.data(), file.size(), image, level, positions.data(), normals.data(),
                            texcoords.data(), triangles.data(), scratch.data(), scratch.size());
    if (s != GIM_OK) return s;
    // The split mesh has the same triangles in space.
    std::vector<float> hard_positions(grid_size * 3), hard_normals(grid_size * 3), hard_texcoords(grid_size * 2);
    std::vector<uint32_t> hard_triangles(triangles.size());
    uint32_t hard_count = 0;
    s = gim_decode_hard_mesh(&info, file.data(), file.size(), image, level, &hard_count, hard_positions.data(),
                             hard_normals.data(), hard_texcoords.data(), hard_triangles.data(), scratch.data(),
                             scratch.size());
    if (s != GIM_OK || hard_count < vertex_count || hard_count > grid_size) return s != GIM_OK ? s : GIM_BAD_ARGUMENT;
    for (size_t i = 0; i < triangles.size(); ++i) {
        if (hard_triangles[i] >= hard_count ||
            std::memcmp(&hard_positions[3 * size_t{hard_triangles[i]}], &positions[3 * size_t{triangles[i]}], 12) != 0)
            return GIM_BAD_ARGUMENT;
    }
    out->samples.insert(out->samples.end(), samples.begin(), samples.end());
    out->triangles.insert(out->triangles.end(), triangles.begin(), triangles.end());
    out->vertices.insert(out->vertices.end(), normals.begin(), normals.end());
    out->vertices.insert(out->vertices.end(), texcoords.begin(), texcoords.end());
    return GIM_OK;
}

// All levels of one plane of one image, if the file has it.
inline gim_status decode_plane(const gim_info& info, const std::vector<uint8_t>& file, uint32_t image, uint32_t kind,
                               Decoded* out) {
    gim_plane_info p{};
    for (uint32_t level = 0; level <= p.coarsest_level; ++level) {
        gim_status s = gim_read_plane_info(&info, file.data(), file.size(), image, kind, level, &p);
        if (s == GIM_NO_SUCH_PLANE) return GIM_OK;
        if (s != GIM_OK) return s;
        out->prefix = out->prefix > p.prefix_size ? out->prefix : p.prefix_size;
        std::vector<float> values(size_t{p.width} * p.height * 3);
        Scratch scratch(p.scratch_size);
        s = gim_decode_plane(&info, file.data(), file.size(), image, kind, level, values.data(), scratch.data(),
                             p.scratch_size);
        if (s != GIM_OK) return s;
        out->planes.insert(out->planes.end(), values.begin(), values.end());
    }
    return GIM_OK;
}

// The positions of one image with its displacements, at all levels of these that are fine enough.
inline gim_status decode_details(const gim_info& info, const std::vector<uint8_t>& file, uint32_t image, Decoded* out) {
    gim_level_info level;
    gim_status s = gim_read_level_info(&info, file.data(), file.size(), image, 0, &level);
    if (s != GIM_OK) return s;
    std::vector<float> positions(size_t{level.vertex_count} * 3);
    Scratch of_level(level.scratch_size);
    s = gim_decode_mesh(&info, file.data(), file.size(), image, 0, positions.data(), nullptr, nullptr, nullptr,
                        of_level.data(), of_level.size());
    if (s != GIM_OK) return s;
    for (uint32_t l = 0;; ++l) {
        gim_domain_info shape;
        s = gim_read_detailed_domain_info(&info, file.data(), file.size(), image, l, &shape);
        if (s == GIM_NO_SUCH_PLANE || s == GIM_NO_SUCH_LEVEL) return GIM_OK;
        gim_plane_info p;
        if (s == GIM_OK)
            s = gim_read_plane_info(&info, file.data(), file.size(), image, GIM_PLANE_DISPLACEMENTS, l, &p);
        if (s != GIM_OK) return s;
        std::vector<float> displacements(size_t{p.width} * p.height * 3), detailed(size_t{shape.vertex_count} * 3);
        Scratch of_plane(p.scratch_size), memory(shape.domain_size), scratch(shape.scratch_size);
        s = gim_decode_plane(&info, file.data(), file.size(), image, GIM_PLANE_DISPLACEMENTS, l, displacements.data(),
                             of_plane.data(), of_plane.size());
        if (s != GIM_OK) return s;
        const gim_domain* domain = nullptr;
        s = gim_open_detailed_domain(&info, file.data(), file.size(), image, l, positions.data(), displacements.data(),
                                     detailed.data(), memory.data(), memory.size(), scratch.data(), scratch.size(),
                                     &domain);
        if (s != GIM_OK) return s;
        out->details.insert(out->details.end(), detailed.begin(), detailed.end());
    }
}

// The labels of one image at all levels from `first` on, if the file has them.
inline gim_status decode_labels(const gim_info& info, const std::vector<uint8_t>& file, uint32_t image, Decoded* out,
                                uint32_t first = 0) {
    gim_level_info l{};
    for (uint32_t level = first; level <= first || level <= l.coarsest_level; ++level) {
        gim_labels_info of{};
        gim_status s = gim_read_labels_info(&info, file.data(), file.size(), image, level, &of);
        if (s == GIM_NO_SUCH_PLANE) return GIM_OK;
        if (s == GIM_OK) s = gim_read_level_info(&info, file.data(), file.size(), image, level, &l);
        if (s == GIM_OK && of.cell_count != l.triangle_count / 2) s = GIM_BAD_ARGUMENT;
        if (s != GIM_OK) return s;
        out->prefix = out->prefix > of.prefix_size ? out->prefix : of.prefix_size;
        std::vector<uint8_t> labels(of.cell_count), scratch(static_cast<size_t>(of.scratch_size));
        s = gim_decode_labels(&info, file.data(), file.size(), image, level, labels.data(), scratch.data(),
                              scratch.size());
        if (s != GIM_OK) return s;
        out->labels.insert(out->labels.end(), labels.begin(), labels.end());
    }
    return GIM_OK;
}

// The imported image, if the file holds one.
inline gim_status decode_raster(const gim_info& info, const std::vector<uint8_t>& file, Decoded* out) {
    gim_raster_info r{};
    gim_status s = gim_read_raster_info(&info, file.data(), file.size(), &r);
    if (s == GIM_NO_SUCH_PLANE) return GIM_OK;
    if (s != GIM_OK) return s;
    out->prefix = out->prefix > r.prefix_size ? out->prefix : r.prefix_size;
    std::vector<int32_t> values(size_t{r.width} * r.height * r.channels);
    std::vector<uint8_t> mask(size_t{r.width} * r.height);
    Scratch scratch(r.scratch_size);
    s = gim_decode_raster(&info, file.data(), file.size(), values.data(), mask.data(), scratch.data(), scratch.size());
    for (uint32_t k = 0; s == GIM_OK && k < r.channels; ++k) {
        gim_raster_channel channel;
        s = gim_read_raster_channel(&info, file.data(), file.size(), k, &channel);
    }
    out->raster = values;
    out->raster.insert(out->raster.end(), mask.begin(), mask.end());
    return s;
}

// What the index tells of errors and boxes. Empty if it tells nothing.
inline gim_status read_bounds(const gim_info& info, const std::vector<uint8_t>& file, Decoded* out) {
    if (info.level_max_error[0] == 0 && info.has_boxes == 0) return GIM_OK;
    for (uint32_t level = 0; level < info.level_count; ++level) {
        out->bounds.push_back(info.level_rms_error[level]);
        out->bounds.push_back(info.level_max_error[level]);
    }
    gim_status status = GIM_OK;
    for (uint32_t image = 0; status == GIM_OK && image < info.image_count; ++image) {
        gim_box box{};
        status = gim_read_box(&info, file.data(), file.size(), image, &box);
        out->bounds.insert(out->bounds.end(), box.low, box.low + 3);
        out->bounds.insert(out->bounds.end(), box.high, box.high + 3);
    }
    return status;
}

inline Decoded decode_all(const std::vector<uint8_t>& file) {
    Decoded out;
    gim_info info;
    out.status = gim_read_info(file.data(), file.size(), nullptr, &info);
    if (out.status == GIM_OK) out.status = read_bounds(info, file, &out);
    for (uint32_t image = 0; out.status == GIM_OK && image < info.image_count; ++image) {
        uint32_t coarsest = 0;
        for (uint32_t level = 0; out.status == GIM_OK && level <= coarsest; ++level)
            out.status = decode_one(info, file, image, level, &coarsest, &out);
    }
    for (const uint32_t kind : {GIM_PLANE_NORMALS, GIM_PLANE_COLORS, GIM_PLANE_DISPLACEMENTS}) {
        for (uint32_t image = 0; out.status == GIM_OK && image < info.image_count; ++image)
            out.status = decode_plane(info, file, image, kind, &out);
    }
    for (uint32_t image = 0; out.status == GIM_OK && info.layout != GIM_LAYOUT_MCGIM && image < info.image_count;
         ++image)
        out.status = decode_details(info, file, image, &out);
    for (uint32_t image = 0; out.status == GIM_OK && image < info.image_count; ++image)
        out.status = decode_labels(info, file, image, &out);
    if (out.status == GIM_OK) out.status = decode_raster(info, file, &out);
    return out;
}

inline std::vector<uint8_t> read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// 32-bit values as the vectors store them: little-endian.
template <class T>
std::vector<uint8_t> to_bytes(const std::vector<T>& values) {
    static_assert(sizeof(T) == 4);
    std::vector<uint8_t> bytes;
    for (const T& v : values) {
        uint32_t bits = 0;
        std::memcpy(&bits, &v, 4);
        for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<uint8_t>(bits >> shift));
    }
    return bytes;
}

// The status that the name of an invalid vector asks for: the word before the first dot. GIM_OK if there is none.
inline gim_status status_of_name(const std::string& file_name) {
    const std::string word = file_name.substr(0, file_name.find('.'));
    if (word == "need-more-input") return GIM_NEED_MORE_INPUT;
    if (word == "not-gim") return GIM_NOT_GIM;
    if (word == "unsupported-version") return GIM_UNSUPPORTED_VERSION;
    if (word == "malformed") return GIM_MALFORMED;
    if (word == "limit-exceeded") return GIM_LIMIT_EXCEEDED;
    if (word == "checksum") return GIM_CHECKSUM;
    return GIM_OK;
}

}  // namespace gim::test
