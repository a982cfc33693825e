#include "tools/decoded.h"

#include <algorithm>
#include <utility>

#include "gim/decoder.hpp"
#include "tools/details.h"

namespace gim {
namespace {

Error failed(const std::string& what, gim_status status) {
    return {Stage::kInput, what + ": " + describe_status(status)};
}

// Leaves `plane` empty if the file has no such plane.
gim_status decode_plane(Decoder& decoder, uint32_t image, uint32_t kind, ImagePlane* plane) {
    DecoderPlane shape;
    const gim_status status = decoder.read_plane(image, kind, 0, &shape);
    if (status == GIM_NO_SUCH_PLANE) return GIM_OK;
    if (status != GIM_OK) return status;
    plane->columns = shape.width;
    plane->rows = shape.height;
    plane->values.resize(size_t{3} * shape.width * shape.height);
    return decoder.plane(shape, plane->values);
}

// Leaves the mesh empty if it has no vertices but the fused ones.
gim_status decode_hard_mesh(Decoder& decoder, const DecoderLevel& shape, HardMesh* mesh) {
    const size_t most = size_t{shape.width} * shape.height;
    HardMesh hard{std::vector<float>(3 * most), std::vector<float>(3 * most), std::vector<float>(2 * most),
                  std::vector<uint32_t>(size_t{3} * shape.triangle_count)};
    uint32_t count = 0;
    const gim_status status =
        decoder.hard_mesh(shape, &count, {hard.positions, hard.normals, hard.texcoords, hard.triangles});
    if (status != GIM_OK || count == shape.vertex_count) return status;
    hard.positions.resize(size_t{3} * count);
    hard.normals.resize(size_t{3} * count);
    hard.texcoords.resize(size_t{2} * count);
    *mesh = std::move(hard);
    return status;
}

// Decodes the level, or the coarsest one if the image has no such level.
gim_status decode_image(Decoder& decoder, uint32_t index, uint32_t level, DecodedImage* image) {
    DecoderLevel shape;
    gim_status status = decoder.read_level(index, 0, &shape);
    if (status != GIM_OK) return status;
    image->level = std::min(level, shape.coarsest_level);
    status = decoder.read_level(index, image->level, &shape);
    if (status != GIM_OK) return status;
    if (decoder.info().is_relative) std::copy_n(decoder.info().origin, 3, image->origin.begin());
    image->columns = shape.width;
    image->rows = shape.height;
    const size_t samples = size_t{shape.width} * shape.height;
    image->grid.resize(3 * samples);
    image->grid_normals.resize(3 * samples);
    image->grid_texcoords.resize(2 * samples);
    image->grid_triangles.resize(size_t{3} * shape.triangle_count);
    image->positions.resize(size_t{3} * shape.vertex_count);
    image->normals.resize(size_t{3} * shape.vertex_count);
    image->texcoords.resize(size_t{2} * shape.vertex_count);
    image->triangles.resize(size_t{3} * shape.triangle_count);
    status = decoder.grid(shape, {image->grid, image->grid_normals, image->grid_texcoords, image->grid_triangles});
    if (status != GIM_OK) return status;
    status = decoder.mesh(shape, {image->positions, image->normals, image->texcoords, image->triangles});
    if (status != GIM_OK || decoder.info().layout != GIM_LAYOUT_TILES) return status;
    return decode_hard_mesh(decoder, shape, &image->hard);
}

}  // namespace

std::string describe_status(gim_status status) {
    std::string text = gim_status_text(status);
    switch (status) {
        case GIM_NEED_MORE_INPUT:
            return text + " (is the file cut short?)";
        case GIM_UNSUPPORTED_VERSION:
            return text + " (a newer gim may read it)";
        case GIM_MALFORMED:
        case GIM_CHECKSUM:
            return text + " (the file is damaged; get a fresh copy)";
        default:
            return text;
    }
}

bool is_gim(const Bytes& file) { return !file.empty() && Decoder().open(file) != GIM_NOT_GIM; }

Result<std::vector<DecodedImage>> decode_images(const Bytes& file, uint32_t level, WithPlanes planes,
                                                WithDetails details) {
    Decoder decoder;
    gim_status status = decoder.open(file);
    if (status != GIM_OK) return failed("header", status);

    std::vector<DecodedImage> images(decoder.info().image_count);
    uint32_t reached = 0;
    for (uint32_t i = 0; i < images.size(); ++i) {
        const std::string what = "image " + std::to_string(i);
        DecodedImage& image = images[i];
        status = decode_image(decoder, i, level, &image);
        if (status != GIM_OK) return failed(what, status);
        reached = std::max(reached, image.level);
        status = level == 0 && details == WithDetails::kYes ? add_details(decoder, file, i, &image) : GIM_OK;
        if (status != GIM_OK) return failed(what + ", displacements", status);
        if (planes == WithPlanes::kNo) continue;
        status = decode_plane(decoder, i, GIM_PLANE_NORMALS, &image.normal_map);
        if (status != GIM_OK) return failed(what + ", normal map", status);
        status = decode_plane(decoder, i, GIM_PLANE_COLORS, &image.colors);
        if (status != GIM_OK) return failed(what + ", colours", status);
    }
    if (reached < level) {
        return Error{Stage::kInput, "level " + std::to_string(level) + ": " + describe_status(GIM_NO_SUCH_LEVEL) +
                                        "; the coarsest level of this file is " + std::to_string(reached)};
    }
    return images;
}

std::vector<float> DecodedImage::shading_normals() const {
    std::vector<float> result = grid_normals;
    for (size_t i = 0; i < hard.triangles.size(); ++i)
        std::copy_n(&hard.normals[size_t{3} * hard.triangles[i]], 3, &result[size_t{3} * grid_triangles[i]]);
    return result;
}

GridMesh grid_mesh(const DecodedImage& image) {
    GridMesh mesh;
    std::vector<uint32_t> vertex(image.grid.size() / 3, 0);
    for (uint32_t i = 0; i < vertex.size(); ++i) {
        if (!image.is_defined(i)) continue;
        vertex[i] = static_cast<uint32_t>(mesh.samples.size());
        mesh.samples.push_back(i);
    }
    mesh.triangles.reserve(image.grid_triangles.size());
    for (const uint32_t sample : image.grid_triangles) mesh.triangles.push_back(vertex[sample]);
    return mesh;
}

std::vector<float> at_samples(const GridMesh& mesh, const std::vector<float>& values, size_t width) {
    std::vector<float> result;
    result.reserve(mesh.samples.size() * width);
    for (const uint32_t sample : mesh.samples) {
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(sample * width);
        result.insert(result.end(), begin, begin + static_cast<std::ptrdiff_t>(width));
    }
    return result;
}

namespace {

void add_shading(const std::vector<float>& normals, const std::vector<uint32_t>& triangles, Shading& shading) {
    const auto base = static_cast<uint32_t>(shading.normals.size());
    for (size_t i = 0; i + 2 < normals.size(); i += 3)
        shading.normals.push_back({normals[i], normals[i + 1], normals[i + 2]});
    for (size_t i = 0; i + 2 < triangles.size(); i += 3)
        shading.corners.push_back({base + triangles[i], base + triangles[i + 1], base + triangles[i + 2]});
}

}  // namespace

TriangleMesh to_mesh(const std::vector<DecodedImage>& images) {
    const bool has_hard_edges =
        std::any_of(images.begin(), images.end(), [](const DecodedImage& image) { return image.hard.is_there(); });
    TriangleMesh mesh;
    for (const DecodedImage& image : images) {
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        for (size_t v = 0; v < image.positions.size() / 3; ++v) mesh.positions.push_back(image.vertex(v));
        if (has_hard_edges) {
            add_shading(image.hard.is_there() ? image.hard.normals : image.normals,
                        image.hard.is_there() ? image.hard.triangles : image.triangles, mesh.shading);
        }
        for (size_t i = 0; i + 2 < image.triangles.size(); i += 3) {
            mesh.triangles.push_back(
                {base + image.triangles[i], base + image.triangles[i + 1], base + image.triangles[i + 2]});
        }
    }
    return mesh;
}

}  // namespace gim
