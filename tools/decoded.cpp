#include "tools/decoded.h"

#include <algorithm>

namespace gim {
namespace {

Error failed(const std::string& what, gim_status status) {
    return {Stage::kInput, what + ": " + describe_status(status)};
}

// Scratch memory must be 16-byte aligned.
struct alignas(16) Block {
    uint8_t bytes[16];
};

// Nothing where the file has no such plane.
gim_status decode_plane(const gim_info& info, const Bytes& file, uint32_t image, uint32_t kind, ImagePlane* plane) {
    gim_plane_info shape;
    const gim_status status = gim_read_plane_info(&info, file.data(), file.size(), image, kind, 0, &shape);
    if (status == GIM_NO_SUCH_PLANE) return GIM_OK;
    if (status != GIM_OK) return status;
    plane->columns = shape.width;
    plane->rows = shape.height;
    plane->values.resize(size_t{3} * shape.width * shape.height);
    std::vector<Block> scratch(shape.scratch_size / sizeof(Block) + 1);
    return gim_decode_plane(&info, file.data(), file.size(), image, kind, 0, plane->values.data(), scratch.data(),
                            shape.scratch_size);
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

bool is_gim(const Bytes& file) {
    gim_info info;
    return !file.empty() && gim_read_info(file.data(), file.size(), nullptr, &info) != GIM_NOT_GIM;
}

Result<std::vector<DecodedImage>> decode_images(const Bytes& file, uint32_t level, WithPlanes planes) {
    gim_info info;
    gim_status status = gim_read_info(file.data(), file.size(), nullptr, &info);
    if (status != GIM_OK) return failed("header", status);

    std::vector<DecodedImage> images(info.image_count);
    std::vector<Block> scratch;
    uint32_t reached = 0;
    for (uint32_t i = 0; i < info.image_count; ++i) {
        const std::string what = "image " + std::to_string(i);
        DecodedImage& image = images[i];
        gim_level_info shape;
        status = gim_read_level_info(&info, file.data(), file.size(), i, 0, &shape);
        if (status != GIM_OK) return failed(what, status);
        image.level = std::min(level, shape.coarsest_level);
        reached = std::max(reached, image.level);
        status = gim_read_level_info(&info, file.data(), file.size(), i, image.level, &shape);
        if (status != GIM_OK) return failed(what, status);

        image.columns = shape.width;
        image.rows = shape.height;
        const size_t samples = size_t{shape.width} * shape.height;
        image.grid.resize(3 * samples);
        image.grid_normals.resize(3 * samples);
        image.grid_texcoords.resize(2 * samples);
        image.grid_triangles.resize(size_t{3} * shape.triangle_count);
        image.positions.resize(size_t{3} * shape.vertex_count);
        image.normals.resize(size_t{3} * shape.vertex_count);
        image.texcoords.resize(size_t{2} * shape.vertex_count);
        image.triangles.resize(size_t{3} * shape.triangle_count);
        scratch.resize(shape.scratch_size / sizeof(Block) + 1);
        status = gim_decode_grid(&info, file.data(), file.size(), i, image.level, image.grid.data(),
                                 image.grid_normals.data(), image.grid_texcoords.data(), image.grid_triangles.data(),
                                 scratch.data(), shape.scratch_size);
        if (status != GIM_OK) return failed(what, status);
        status = gim_decode_mesh(&info, file.data(), file.size(), i, image.level, image.positions.data(),
                                 image.normals.data(), image.texcoords.data(), image.triangles.data(), scratch.data(),
                                 shape.scratch_size);
        if (status != GIM_OK) return failed(what, status);
        if (planes == WithPlanes::kNo) continue;
        status = decode_plane(info, file, i, GIM_PLANE_NORMALS, &image.normal_map);
        if (status != GIM_OK) return failed(what + ", normal map", status);
        status = decode_plane(info, file, i, GIM_PLANE_COLORS, &image.colors);
        if (status != GIM_OK) return failed(what + ", colours", status);
    }
    if (reached < level) {
        return Error{Stage::kInput, "level " + std::to_string(level) + ": " + describe_status(GIM_NO_SUCH_LEVEL) +
                                        "; the coarsest level of this file is " + std::to_string(reached)};
    }
    return images;
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

TriangleMesh to_mesh(const std::vector<DecodedImage>& images) {
    TriangleMesh mesh;
    for (const DecodedImage& image : images) {
        const auto base = static_cast<uint32_t>(mesh.positions.size());
        for (size_t i = 0; i + 2 < image.positions.size(); i += 3) {
            mesh.positions.push_back({image.positions[i], image.positions[i + 1], image.positions[i + 2]});
        }
        for (size_t i = 0; i + 2 < image.triangles.size(); i += 3) {
            mesh.triangles.push_back(
                {base + image.triangles[i], base + image.triangles[i + 1], base + image.triangles[i + 2]});
        }
    }
    return mesh;
}

}  // namespace gim
