#include "tools/glb_geometry.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "gim/decoder.hpp"
#include "tools/glb_file.h"

namespace gim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// One image as a mesh, before its triangles are chosen.
struct ImageMesh {
    std::vector<float> positions, normals, texcoords;
    const std::vector<uint32_t>* triangles = nullptr;
    std::vector<Vector3d> tangents;

    Vector3d position(uint32_t v) const { return triple(positions, v); }
    Vector3d normal(uint32_t v) const { return triple(normals, v); }
    Vector2d texcoord(uint32_t v) const {
        return {double{texcoords[2 * size_t{v}]}, double{texcoords[2 * size_t{v} + 1]}};
    }
    static Vector3d triple(const std::vector<float>& values, uint32_t v) {
        const float* p = &values[3 * size_t{v}];
        return {double{p[0]}, double{p[1]}, double{p[2]}};
    }
};

void place_in_space(const std::array<double, 3>& origin, std::vector<float>& positions) {
    for (size_t i = 0; i < positions.size(); ++i)
        positions[i] = static_cast<float>(origin[i % 3] + double{positions[i]});
}

void place_in_atlas(const AtlasPlace& place, std::vector<float>& texcoords) {
    for (size_t i = 0; i < texcoords.size(); ++i)
        texcoords[i] = static_cast<float>((i % 2 == 0 ? place.x : place.y) + place.size * double{texcoords[i]});
}

// The direction of rising u at each vertex, summed over its triangles. Its length means nothing.
void add_tangents(ImageMesh& mesh) {
    mesh.tangents.assign(mesh.positions.size() / 3, Vector3d::Zero());
    const std::vector<uint32_t>& t = *mesh.triangles;
    for (size_t i = 0; i + 2 < t.size(); i += 3) {
        const Vector3d along = mesh.position(t[i + 1]) - mesh.position(t[i]);
        const Vector3d across = mesh.position(t[i + 2]) - mesh.position(t[i]);
        const Vector2d uv_along = mesh.texcoord(t[i + 1]) - mesh.texcoord(t[i]);
        const Vector2d uv_across = mesh.texcoord(t[i + 2]) - mesh.texcoord(t[i]);
        const double area = uv_along.x() * uv_across.y() - uv_across.x() * uv_along.y();
        const Vector3d rising = (area < 0 ? -1.0 : 1.0) * (along * uv_across.y() - across * uv_along.y());
        for (size_t k = 0; k < 3; ++k) mesh.tangents[t[i + k]] += rising;
    }
}

Vector3d any_perpendicular(const Vector3d& n) {
    return n.cross(std::abs(n.x()) < 0.6 ? Vector3d::UnitX() : Vector3d::UnitY()).normalized();
}

void append_tangent(const ImageMesh& mesh, uint32_t v, std::vector<float>& tangents) {
    const Vector3d n = mesh.normal(v).normalized(), along = mesh.tangents[v];
    Vector3d t = along - n * n.dot(along);
    t = t.norm() > 1e-6 * along.norm() ? t.normalized() : any_perpendicular(n);
    for (const double x : {t.x(), t.y(), t.z(), -1.0}) tangents.push_back(static_cast<float>(x));
}

ImageMesh mesh_of(const DecodedImage& image, const AtlasPlace& place, const WantedArrays& wanted) {
    ImageMesh mesh;
    if (wanted.texcoords) {
        mesh.positions = image.grid;
        mesh.normals = image.shading_normals();
        mesh.texcoords = image.grid_texcoords;
        mesh.triangles = &image.grid_triangles;
        place_in_atlas(place, mesh.texcoords);
    } else {
        const bool hard = image.hard.is_there();
        mesh.positions = hard ? image.hard.positions : image.positions;
        mesh.normals = hard ? image.hard.normals : image.normals;
        mesh.triangles = hard ? &image.hard.triangles : &image.triangles;
    }
    place_in_space(image.origin, mesh.positions);
    replace_zero_normals(mesh.normals);
    if (wanted.texcoords && wanted.tangents) add_tangents(mesh);
    return mesh;
}

// Appends the triangles of the label, with the vertices that they use in ascending order.
void append_mesh(const ImageMesh& mesh, const std::vector<uint8_t>& labels, const WantedArrays& wanted,
                 PrimitiveArrays& out) {
    const std::vector<uint32_t>& triangles = *mesh.triangles;
    const auto is_wanted = [&](size_t corner) {
        return !wanted.label || (labels.empty() ? 0 : labels[corner / 6]) == *wanted.label;
    };
    std::vector<uint32_t> number(mesh.positions.size() / 3, UINT32_MAX);
    for (size_t i = 0; i < triangles.size(); ++i)
        if (is_wanted(i)) number[triangles[i]] = 0;
    auto next = static_cast<uint32_t>(out.vertices());
    for (uint32_t v = 0; v < number.size(); ++v) {
        if (number[v] == UINT32_MAX) continue;
        number[v] = next++;
        for (size_t k = 0; k < 3; ++k) out.positions.push_back(mesh.positions[3 * size_t{v} + k]);
        for (size_t k = 0; k < 3; ++k) out.normals.push_back(mesh.normals[3 * size_t{v} + k]);
        for (size_t k = 0; k < 2 && wanted.texcoords; ++k) out.texcoords.push_back(mesh.texcoords[2 * size_t{v} + k]);
        if (!mesh.tangents.empty()) append_tangent(mesh, v, out.tangents);
    }
    for (size_t i = 0; i < triangles.size(); ++i)
        if (is_wanted(i)) out.indices.push_back(number[triangles[i]]);
}

// Decodes the labels of an image at the level that it has.
gim_status decode_labels(Decoder& decoder, uint32_t image, uint32_t level, std::vector<uint8_t>* labels) {
    DecoderLevel shape;
    gim_labels_info of;
    gim_status status = decoder.read_level(image, level, &shape);
    if (status == GIM_OK) status = decoder.read_labels(shape, &of);
    if (status == GIM_NO_SUCH_PLANE) return GIM_OK;
    if (status != GIM_OK) return status;
    labels->resize(of.cell_count);
    return decoder.labels(shape, *labels);
}

// The coarsest level that an image of the file has.
gim_status coarsest_of_all(Decoder& decoder, uint32_t* coarsest) {
    *coarsest = 0;
    for (uint32_t image = 0; image < decoder.info().image_count; ++image) {
        DecoderLevel level;
        const gim_status status = decoder.read_level(image, 0, &level);
        if (status != GIM_OK) return status;
        *coarsest = std::max(*coarsest, level.coarsest_level);
    }
    return GIM_OK;
}

}  // namespace

Result<GimGeometry> decode_geometry(const Bytes& gim, uint32_t level, std::vector<AtlasPlace> places) {
    const auto failed = [](gim_status status) { return Error{Stage::kInput, describe_status(status)}; };
    Decoder decoder;
    uint32_t coarsest = 0;
    gim_status status = decoder.open(gim);
    if (status == GIM_OK) status = coarsest_of_all(decoder, &coarsest);
    if (status != GIM_OK) return failed(status);
    auto images = decode_images(gim, std::min(level, coarsest), WithPlanes::kNo, WithDetails::kNo);
    if (!images.ok()) return images.error();
    GimGeometry geometry{std::move(images.value()), {}, std::move(places)};
    if (!geometry.places.empty() && geometry.places.size() != geometry.images.size())
        return Error{Stage::kInput, "it has places in the atlas for another number of images"};
    geometry.places.resize(geometry.images.size());
    geometry.labels.resize(geometry.images.size());
    for (uint32_t i = 0; i < geometry.images.size(); ++i) {
        status = decode_labels(decoder, i, geometry.images[i].level, &geometry.labels[i]);
        if (status != GIM_OK) return failed(status);
    }
    return geometry;
}

PrimitiveArrays arrays_of(const GimGeometry& geometry, const WantedArrays& wanted) {
    PrimitiveArrays arrays;
    for (size_t i = 0; i < geometry.images.size(); ++i) {
        const ImageMesh mesh = mesh_of(geometry.images[i], geometry.places[i], wanted);
        append_mesh(mesh, geometry.labels[i], wanted, arrays);
    }
    return arrays;
}

}  // namespace gim
