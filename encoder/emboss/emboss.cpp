// Finds the place, lays the picture on the surface, displaces texels along the normals, codes them.
#include "gim/emboss.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "encoder/code/assemble_file.h"
#include "encoder/code/measure_boxes.h"
#include "encoder/emboss/code_displacements.h"
#include "encoder/emboss/exponential_map.h"
#include "encoder/emboss/finest_image.h"
#include "encoder/emboss/picture_heights.h"
#include "encoder/surface/closest_point.h"
#include "format/plane_code.h"
#include "format/seam.h"

namespace gim {
namespace {

constexpr uint64_t kMostTexels = uint64_t{1} << 26;  // what every reader should take
constexpr double kStepsInDepth = 32;                 // of the quantizer
constexpr double kFarthest = 0.75;  // of the map, in diagonals of the picture; half of one would do on a plane

Error wrong(const std::string& message) { return {Stage::kInput, message}; }

Result<void> check(const HeightPicture& picture, const EmbossOptions& options) {
    if (picture.width == 0 || picture.height == 0 || picture.heights.size() != size_t{picture.width} * picture.height)
        return wrong("the picture is empty, or its heights are not width * height");
    for (const float h : picture.heights)
        if (!(h >= 0 && h <= 1)) return wrong("heights of the picture must be in 0 .. 1");
    if (!(options.size > 0) || !std::isfinite(options.size)) return wrong("the size of the picture must be above 0");
    if (options.depth == 0 || !std::isfinite(options.depth)) return wrong("the depth must be a number other than 0");
    if (!std::isfinite(options.turn)) return wrong("the turn must be a number");
    if (options.texel_exponent && *options.texel_exponent > kMaxTexelExponent)
        return wrong("texels a sample: 2^0 to 2^" + std::to_string(kMaxTexelExponent) + " along each side");
    return {};
}

// The triangle and the point where the picture's middle lies.
struct Place {
    uint32_t triangle = kNone;
    Vec3 point = Vec3::Zero();
};

Place nearest_place(const Mesh& mesh, const std::array<double, 3>& at) {
    const ClosestPoint found = ClosestPointTree(mesh).find(Vec3(at[0], at[1], at[2]));
    return {found.triangle, found.point};
}

// Takes the triangle that has the texture coordinates. Its vertices on seams have those of another place of the image, so
// triangles across seams have none here.
Place textured_place(const FinestImage& image, const EmbossOptions::TextureCoordinates& at) {
    const double texel = 1.5 / std::max(1u, std::min(image.width, image.height) - 1);
    for (uint32_t f = 0; f < image.mesh.triangles.size(); ++f) {
        const Triangle& t = image.mesh.triangles[f];
        std::array<Vec2, 3> uv;
        for (size_t i = 0; i < 3; ++i) uv[i] = Vec2(image.texcoords[t[i]][0], image.texcoords[t[i]][1]);
        const Vec2 a = uv[1] - uv[0], b = uv[2] - uv[0], p = Vec2(at.u, at.v) - uv[0];
        const double area = a.x() * b.y() - a.y() * b.x();
        if (area == 0 || a.cwiseAbs().maxCoeff() > texel || b.cwiseAbs().maxCoeff() > texel) continue;
        const double s = (p.x() * b.y() - p.y() * b.x()) / area, r = (a.x() * p.y() - a.y() * p.x()) / area;
        constexpr double kSlack = -1e-9;
        if (s < kSlack || r < kSlack || s + r > 1 - kSlack) continue;
        const auto& x = image.mesh.positions;
        return {f, x[t[0]] + s * (x[t[1]] - x[t[0]]) + r * (x[t[2]] - x[t[0]])};
    }
    return {};
}

MapOrigin map_origin(const FinestImage& image, const Place& place, const EmbossOptions& options) {
    const Triangle& t = image.mesh.triangles[place.triangle];
    MapOrigin origin;
    origin.triangle = place.triangle;
    origin.point = place.point;
    origin.outside = (image.normals[t[0]] + image.normals[t[1]] + image.normals[t[2]]).normalized();
    Vec3 up = Vec3(options.up[0], options.up[1], options.up[2]);
    up -= up.dot(origin.outside) * origin.outside;
    if (!(up.norm() > 1e-3 * Vec3(options.up[0], options.up[1], options.up[2]).norm()))
        up = origin.outside.unitOrthogonal();  // the surface looks upwards
    const double turn = options.turn * std::numbers::pi / 180;
    origin.up = Eigen::AngleAxisd(turn, origin.outside) * up.normalized();
    origin.right = origin.up.cross(origin.outside);
    return origin;
}

// Calls f(tile, row, column, corners, s, t) for the texels of all tiles whose cell is on the map: the vertices at the corners
// of its cell, and where it lies between them.
template <class F>
void for_each_texel(const FinestImage& image, const std::vector<Vec2>& map, uint32_t exponent, const F& f) {
    const uint32_t parts = 1u << exponent, side = image.intervals * parts;
    for (uint32_t tile = 0; tile < image.tiles; ++tile) {
        const size_t first = size_t{image.row_of(tile)} * image.width + image.column_of(tile);
        for (uint32_t row = 0; row <= side; ++row) {
            for (uint32_t column = 0; column <= side; ++column) {
                const uint32_t r = std::min(row / parts, image.intervals - 1);
                const uint32_t c = std::min(column / parts, image.intervals - 1);
                const size_t at = first + size_t{r} * image.width + c;
                const std::array<uint32_t, 4> corners = {image.vertex_at[at], image.vertex_at[at + 1],
                                                         image.vertex_at[at + image.width],
                                                         image.vertex_at[at + image.width + 1]};
                if (!std::all_of(corners.begin(), corners.end(), [&](uint32_t v) { return map[v].allFinite(); }))
                    continue;
                f(tile, row, column, corners, double(row) / parts - r, double(column) / parts - c);
            }
        }
    }
}

template <class T>
T between(const std::vector<T>& values, const std::array<uint32_t, 4>& corners, double s, double t) {
    return (1 - s) * ((1 - t) * values[corners[0]] + t * values[corners[1]]) +
           s * ((1 - t) * values[corners[2]] + t * values[corners[3]]);
}

// The mean distance in the plane of the map between neighbouring samples under the picture; 0 if there are none.
double spacing_under(const FinestImage& image, const std::vector<Vec2>& map, const PictureHeights& picture) {
    double sum = 0, count = 0;
    for_each_texel(image, map, 0, [&](uint32_t, uint32_t, uint32_t, const std::array<uint32_t, 4>& v, double, double) {
        const Vec2 middle = 0.25 * (map[v[0]] + map[v[1]] + map[v[2]] + map[v[3]]);
        if (std::abs(middle.x()) > picture.width() / 2 || std::abs(middle.y()) > picture.height() / 2) return;
        sum += 0.5 * ((map[v[0]] - map[v[1]]).norm() + (map[v[0]] - map[v[2]]).norm());
        count += 1;
    });
    return count > 0 ? sum / count : 0;
}

uint64_t texels_of(const FinestImage& image, uint32_t exponent) {
    return texels_along(image.width, exponent) * texels_along(image.height, exponent);
}

// About one texel for each pixel, as far as every reader takes so many.
uint32_t texel_exponent(const FinestImage& image, double spacing, double pixel) {
    uint32_t exponent = 0;
    const auto fits = [&](uint32_t e) {
        return e <= kMaxTexelExponent && (uint64_t{image.intervals} << e) < (1u << kMaxSideExponent) &&
               (uint64_t{image.width - 1} << e) <= (1u << kMaxSideExponent) && texels_of(image, e) <= kMostTexels;
    };
    while (spacing / (1u << exponent) > 1.25 * pixel && fits(exponent + 1)) ++exponent;
    return exponent;
}

// The plane of an image as the file has it, or zeros, with 2^exponent texels a sample.
Result<Displacements> plane_so_far(Decoder& decoder, uint32_t image, const FinestImage& finest, uint32_t exponent) {
    Displacements d;
    const auto width = static_cast<uint32_t>(texels_along(finest.width, exponent));
    const auto height = static_cast<uint32_t>(texels_along(finest.height, exponent));
    d.width = width;
    d.values.assign(3 * size_t{width} * height, 0.0f);
    DecoderPlane plane;
    gim_status status = decoder.read_plane(image, GIM_PLANE_DISPLACEMENTS, 0, &plane);
    if (status == GIM_NO_SUCH_PLANE) return d;
    std::vector<float> values;
    if (status == GIM_OK) {
        values.resize(3 * size_t{plane.width} * plane.height);
        status = decoder.plane(plane, values);
    }
    if (status != GIM_OK) return wrong("its displacements do not decode");
    const uint32_t parts = (width - 1) / (plane.width - 1);
    for (size_t y = 0; y < height; ++y) {
        const size_t r = std::min<size_t>(y / parts, plane.height - 2);
        const double s = double(y) / parts - double(r);
        for (size_t x = 0; x < width; ++x) {
            const size_t c = std::min<size_t>(x / parts, plane.width - 2);
            const double t = double(x) / parts - double(c);
            const auto at = [&](size_t row, size_t column, size_t k) {
                return double{values[3 * (row * plane.width + column) + k]};
            };
            for (size_t k = 0; k < 3; ++k) {
                d.values[3 * (y * width + x) + k] =
                    static_cast<float>((1 - s) * ((1 - t) * at(r, c, k) + t * at(r, c + 1, k)) +
                                       s * ((1 - t) * at(r + 1, c, k) + t * at(r + 1, c + 1, k)));
            }
        }
    }
    return d;
}

// How fine the plane of an image is by now: 2^this texels a sample. 0 if there is none.
uint32_t exponent_so_far(const Decoder& decoder, uint32_t image, const FinestImage& finest) {
    DecoderPlane plane;
    uint32_t exponent = 0;
    if (decoder.read_plane(image, GIM_PLANE_DISPLACEMENTS, 0, &plane) != GIM_OK) return 0;
    while (texels_along(finest.width, exponent) < plane.width) ++exponent;
    return exponent;
}

}  // namespace

Result<Embossed> emboss(std::span<const uint8_t> file, const HeightPicture& picture, const EmbossOptions& options) {
    GIM_CHECK(check(picture, options));
    Decoder decoder;
    if (const gim_status s = decoder.open(file); s != GIM_OK) return wrong(gim_status_text(s));
    if (options.image >= decoder.info().image_count)
        return wrong("there is no image " + std::to_string(options.image) + "; the file has " +
                     std::to_string(decoder.info().image_count));
    GIM_TRY(finest, finest_image(decoder, file, options.image));

    const auto* point = std::get_if<std::array<double, 3>>(&options.at);
    const Place place = point ? nearest_place(finest.mesh, *point)
                              : textured_place(finest, std::get<EmbossOptions::TextureCoordinates>(options.at));
    if (place.triangle == kNone)
        return wrong("no cell of the image has these texture coordinates; take another place, or a point in space");
    PictureHeights heights(picture, options.size);
    const double diagonal = std::hypot(heights.width(), heights.height());
    const std::vector<Vec2> map =
        exponential_map(finest.mesh, finest.normals, map_origin(finest, place, options), kFarthest * diagonal);
    const double spacing = spacing_under(finest, map, heights);
    if (!(spacing > 0)) return wrong("the picture is smaller than the samples of the image; take a larger --size");

    Embossed embossed;
    embossed.texel_exponent =
        std::max(options.texel_exponent.value_or(texel_exponent(finest, spacing, heights.pixel())),
                 exponent_so_far(decoder, options.image, finest));
    if (texels_of(finest, embossed.texel_exponent) > kMostTexels)
        return wrong("so fine displacements would have more texels than readers take; take fewer texels a sample");
    embossed.spacing = std::ldexp(spacing, -static_cast<int>(embossed.texel_exponent));
    heights.filter_for(embossed.spacing);

    // The header's step turns units into object space.
    Header header;
    if (parse_header(file, kNoLimits, &header) != Status::kOk) return wrong("the .gim file is damaged");
    std::vector<Displacements> planes;
    for (uint32_t i = 0; i < header.image_count(); ++i) {
        std::optional<FinestImage> other;
        if (i != options.image) {
            GIM_TRY(read, finest_image(decoder, file, i));
            other = std::move(read);
        }
        const FinestImage& image = other ? *other : finest;
        const uint32_t exponent = other ? exponent_so_far(decoder, i, image) : embossed.texel_exponent;
        GIM_TRY(plane, plane_so_far(decoder, i, image, exponent));
        for (float& v : plane.values) v /= header.step;
        const bool is_square = header.layout == FileLayout::kSquares;
        plane.exponent = static_cast<uint8_t>(exponent + (is_square ? header.side_exponents[i] : 0));
        planes.push_back(std::move(plane));
    }
    Displacements& plane = planes[options.image];
    const double depth = options.depth / double{header.step};
    const uint32_t e = embossed.texel_exponent;
    std::vector<bool> is_done(plane.values.size() / 3, false);  // tiles of a square share texels
    const auto displace = [&](uint32_t tile, uint32_t row, uint32_t column, const std::array<uint32_t, 4>& corners,
                              double s, double t) {
        const double height = heights.at(between(map, corners, s, t));
        if (height == 0) return;
        const Vec3 by = depth * height * between(finest.normals, corners, s, t).normalized();
        const size_t y = (size_t{finest.row_of(tile)} << e) + row, x = (size_t{finest.column_of(tile)} << e) + column;
        const size_t texel = y * plane.width + x;
        if (is_done[texel]) return;
        is_done[texel] = true;
        for (size_t k = 0; k < 3; ++k) plane.values[3 * texel + k] += static_cast<float>(by[k]);
        ++embossed.displaced_texels;
    };
    for_each_texel(finest, map, e, displace);
    if (embossed.displaced_texels == 0) return wrong("the picture displaces nothing: its heights are 0 where it lies");
    const auto quantizer =
        std::clamp(static_cast<float>(std::abs(depth) / kStepsInDepth), kMinQuantizer, kMaxQuantizer);
    GIM_TRY(coded, code_displacements(file, planes, quantizer));
    embossed.plane_bytes = coded.payload.size();
    embossed.bytes = replace_planes(file, std::span(&coded, 1));
    GIM_TRY(boxes, measure_boxes(embossed.bytes));
    embossed.bytes = set_boxes(embossed.bytes, boxes);
    return embossed;
}

}  // namespace gim
