#include "encoder/planes/measure_planes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "encoder/code/decode_surface.h"
#include "encoder/surface/surface_samples.h"
#include "format/plane_code.h"

namespace gim {
namespace {

constexpr uint32_t kMeasuredPoints = 100000;

using Kind = PlaneReport::Kind;

// The grids of all images in one mesh. Vertex v has the texture coordinates texcoords[v].
struct DecodedGrids {
    Mesh mesh;
    std::vector<Vec2> texcoords;
    std::vector<uint32_t> image_of;  // per triangle
};

gim_status append_grid(Decoder& decoder, uint32_t image, DecodedGrids* grids) {
    DecoderLevel level;
    gim_status status = decoder.read_level(image, 0, &level);
    if (status != GIM_OK) return status;
    std::vector<float> positions(size_t{level.width} * level.height * 3), texcoords(positions.size() / 3 * 2);
    std::vector<uint32_t> triangles(size_t{level.triangle_count} * 3);
    status = decoder.grid(level, {positions, {}, texcoords, triangles});
    if (status != GIM_OK) return status;
    const auto first = static_cast<uint32_t>(grids->mesh.positions.size());
    append_positions(decoder.info(), positions, grids->mesh);
    for (size_t i = 0; i < texcoords.size(); i += 2) grids->texcoords.emplace_back(texcoords[i], texcoords[i + 1]);
    for (size_t i = 0; i < triangles.size(); i += 3) {
        grids->mesh.triangles.push_back({first + triangles[i], first + triangles[i + 1], first + triangles[i + 2]});
        grids->image_of.push_back(image);
    }
    return GIM_OK;
}

struct DecodedPlane {
    uint32_t width = 0, height = 0;
    std::vector<float> values;

    Vec3 at(const Vec2& uv) const {
        const double x = std::clamp(uv.x(), 0.0, 1.0) * (width - 1), y = std::clamp(uv.y(), 0.0, 1.0) * (height - 1);
        const uint32_t c = std::min(static_cast<uint32_t>(x), width - 2),
                       r = std::min(static_cast<uint32_t>(y), height - 2);
        const double s = x - c, t = y - r;
        const auto texel = [&](uint32_t row, uint32_t column) {
            const float* v = values.data() + (size_t{row} * width + column) * 3;
            return Vec3(v[0], v[1], v[2]);
        };
        return (1 - t) * ((1 - s) * texel(r, c) + s * texel(r, c + 1)) +
               t * ((1 - s) * texel(r + 1, c) + s * texel(r + 1, c + 1));
    }
};

Result<std::vector<DecodedPlane>> decode_planes(Decoder& decoder, Kind kind) {
    std::vector<DecodedPlane> planes(decoder.info().image_count);
    for (uint32_t i = 0; i < planes.size(); ++i) {
        DecoderPlane shape;
        gim_status status = decoder.read_plane(i, static_cast<uint32_t>(kind), 0, &shape);
        if (status != GIM_OK) return decoding_error(Stage::kPlanes, status);
        planes[i].width = shape.width;
        planes[i].height = shape.height;
        planes[i].values.resize(size_t{shape.width} * shape.height * 3);
        status = decoder.plane(shape, planes[i].values);
        if (status != GIM_OK) return decoding_error(Stage::kPlanes, status);
    }
    return planes;
}

uint64_t chunk_size(const Decoder& decoder, Kind kind) {
    gim_chunk chunk;
    const auto type = static_cast<uint32_t>(plane_type(static_cast<uint32_t>(kind)));
    for (uint32_t i = 0; decoder.read_chunk(i, &chunk) == GIM_OK; ++i) {
        if (chunk.type == type) return chunk.size;
    }
    return 0;
}

Vec3 scaled_normal(const Mesh& mesh, uint32_t face) {
    const Triangle& t = mesh.triangles[face];
    const Vec3& a = mesh.positions[t[0]];
    return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
}

// Points of the input, and their places on the decoded images.
struct Correspondence {
    SurfaceSamples samples;
    std::vector<uint32_t> image;  // kNone: the nearest face looks the other way, so it is on another sheet
    std::vector<Vec2> texcoords;
};

Correspondence correspond(const Mesh& input, const DecodedGrids& grids, uint64_t seed, uint32_t threads) {
    Correspondence c;
    c.samples = sample_by_area(input, kMeasuredPoints, seed, threads);
    const ClosestPointTree tree(grids.mesh, threads);
    const std::vector<ClosestPoint> found = tree.find_all(c.samples.points, threads);
    for (size_t i = 0; i < found.size(); ++i) {
        const uint32_t t = found[i].triangle;
        const bool same_side = scaled_normal(grids.mesh, t).dot(scaled_normal(input, c.samples.triangles[i])) > 0;
        Vec2 uv = Vec2::Zero();
        for (size_t k = 0; k < 3; ++k) uv += found[i].barycentric[k] * grids.texcoords[grids.mesh.triangles[t][k]];
        c.image.push_back(same_side ? grids.image_of[t] : kNone);
        c.texcoords.push_back(uv);
    }
    return c;
}

double angle_between(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

// Compares decoded planes with the input. Colours: mean squared difference. Normals: mean angle.
double mean_difference(Kind kind, const std::vector<DecodedPlane>& planes, const Correspondence& c,
                       const PlaneReference& reference) {
    std::vector<float> colors;
    if (kind == Kind::kColors) colors = reference.colors->at(c.samples.points);
    double sum = 0;
    uint64_t count = 0;
    for (size_t i = 0; i < c.image.size(); ++i) {
        if (c.image[i] == kNone) continue;
        const Vec3 value = planes[c.image[i]].at(c.texcoords[i]);
        ++count;
        if (kind == Kind::kColors) {
            const Vec3 color(colors[3 * i], colors[3 * i + 1], colors[3 * i + 2]);
            sum += (value - color / 255).squaredNorm() / 3;
        } else {
            const Vec2& b = c.samples.barycentrics[i];
            ClosestPoint at;
            at.triangle = c.samples.triangles[i];
            at.barycentric = {1 - b[0] - b[1], b[0], b[1]};
            sum += angle_between(value, reference.normals.normal(at));
        }
    }
    return count > 0 ? sum / static_cast<double>(count) : 0;
}

}  // namespace

Result<std::vector<PlaneReport>> measure_planes(std::span<const uint8_t> file, std::span<const Kind> kinds,
                                                const PlaneReference& reference) {
    Decoder decoder;
    gim_status status = open_own_file(file, &decoder);
    DecodedGrids grids;
    for (uint32_t i = 0; status == GIM_OK && i < decoder.info().image_count; ++i)
        status = append_grid(decoder, i, &grids);
    if (status != GIM_OK) return decoding_error(Stage::kPlanes, status);
    const Correspondence c = correspond(reference.surface, grids, reference.seed, reference.threads);
    std::vector<PlaneReport> reports;
    for (const Kind kind : kinds) {
        GIM_TRY(planes, decode_planes(decoder, kind));
        const double mean = mean_difference(kind, planes, c, reference);
        PlaneReport report;
        report.kind = kind;
        for (const DecodedPlane& plane : planes) {
            report.width = std::max(report.width, plane.width);
            report.height = std::max(report.height, plane.height);
        }
        report.bytes = chunk_size(decoder, kind);
        (kind == Kind::kColors ? report.psnr : report.mean_angle) =
            kind == Kind::kColors ? -10 * std::log10(mean) : mean;
        reports.push_back(report);
    }
    return reports;
}

}  // namespace gim
