#include "encoder/planes/make_planes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "encoder/code/code_bands.h"
#include "encoder/planes/input_colors.h"
#include "encoder/planes/sample_planes.h"
#include "encoder/surface/surface_samples.h"
#include "format/plane_code.h"
#include "gim/decoder.h"

namespace gim {

namespace {

constexpr double kQualityOfLossless = 90, kUsualQuality = 75;
// Quantizer steps at quality 75: levels of 8 bits, and 1/1024 of a unit normal.
constexpr double kColorStep = 16, kNormalStep = 64;
constexpr uint32_t kMostAutomaticSide = 1025;
constexpr uint32_t kMeasuredPoints = 100000;

using Kind = PlaneReport::Kind;

// Smallest 2^j+1 that is not below.
uint32_t grid_side_from(double least) {
    uint32_t side = 5;
    while (side < least && side < kMostAutomaticSide) side = 2 * side - 1;
    return side;
}

// Four texels per coloured vertex; of textures about half the pixels, because atlases have gaps.
uint32_t automatic_color_side(const TriangleMesh& mesh) {
    double wanted = 0;
    if (!mesh.appearance.corner_colors.empty()) wanted = 4.0 * static_cast<double>(mesh.positions.size());
    double pixels = 0;
    for (const TextureImage& image : mesh.appearance.textures) pixels += double(image.width) * image.height;
    return grid_side_from(std::sqrt(std::max(wanted, 0.5 * pixels)));
}

uint32_t color_side(const TriangleMesh& mesh, const EncodeOptions& options) {
    if (mesh.appearance.empty()) return 0;
    return options.color_side ? *options.color_side : automatic_color_side(mesh);
}

double plane_quality(const EncodeOptions& options) {
    if (options.plane_quality) return *options.plane_quality;
    if (options.rate.kind == RateTarget::Kind::kQuality) return options.rate.value;
    return options.rate.kind == RateTarget::Kind::kLossless ? kQualityOfLossless : kUsualQuality;
}

float quantizer_of(Kind kind, double quality) {
    const double step = (kind == Kind::kColors ? kColorStep : kNormalStep) * std::exp2((kUsualQuality - quality) / 10);
    return std::clamp(static_cast<float>(step), kMinQuantizer, kMaxQuantizer);
}

// A plane of all images as wavelet bands.
struct AnalysedPlane {
    Kind kind = Kind::kNormals;
    std::vector<uint8_t> side_exponents;
    std::vector<Pyramid<float>> pyramids;
};

CodedPlane code(const AnalysedPlane& plane, double quality) {
    const float quantizer = quantizer_of(plane.kind, quality);
    std::vector<std::vector<uint8_t>> streams;
    for (const Pyramid<float>& pyramid : plane.pyramids) {
        Pyramid<int32_t> bands = quantize_bands(pyramid, {quantizer}).bands;
        streams.push_back(std::move(code_bands(bands, 1, CoefficientKind::kPlanes)[0]));
    }
    return {plane_type(static_cast<uint32_t>(plane.kind)), serialize_plane(quantizer, plane.side_exponents, streams)};
}

// ---- decoded again ---------------------------------------------------------------------------------------------------

Error decoding_error(gim_status status) {
    return {Stage::kPlanes, std::string("own output: ") + gim_status_text(status)};
}

// The grids of all images in one mesh; sample v of the mesh is at texcoords[v].
struct DecodedGrids {
    Mesh mesh;
    std::vector<Vec2> texcoords;
    std::vector<uint32_t> image_of;  // per triangle
};

gim_status append_grid(const gim_info& info, std::span<const uint8_t> file, uint32_t image, DecodedGrids* grids) {
    gim_level_info level;
    gim_status status = gim_read_level_info(&info, file.data(), file.size(), image, 0, &level);
    if (status != GIM_OK) return status;
    std::vector<float> positions(size_t{level.width} * level.height * 3), texcoords(positions.size() / 3 * 2);
    std::vector<uint32_t> triangles(size_t{level.triangle_count} * 3);
    std::vector<std::max_align_t> scratch(level.scratch_size / sizeof(std::max_align_t) + 1);
    status = gim_decode_grid(&info, file.data(), file.size(), image, 0, positions.data(), nullptr, texcoords.data(),
                             triangles.data(), scratch.data(), level.scratch_size);
    if (status != GIM_OK) return status;
    const auto first = static_cast<uint32_t>(grids->mesh.positions.size());
    for (size_t i = 0; i < positions.size(); i += 3) {
        grids->mesh.positions.emplace_back(positions[i], positions[i + 1], positions[i + 2]);
        grids->texcoords.emplace_back(texcoords[i / 3 * 2], texcoords[i / 3 * 2 + 1]);
    }
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

Result<std::vector<DecodedPlane>> decode_planes(const gim_info& info, std::span<const uint8_t> file, Kind kind) {
    const auto number = static_cast<uint32_t>(kind);
    std::vector<DecodedPlane> planes(info.image_count);
    for (uint32_t i = 0; i < info.image_count; ++i) {
        gim_plane_info shape;
        gim_status status = gim_read_plane_info(&info, file.data(), file.size(), i, number, 0, &shape);
        if (status != GIM_OK) return decoding_error(status);
        planes[i].width = shape.width;
        planes[i].height = shape.height;
        planes[i].values.resize(size_t{shape.width} * shape.height * 3);
        std::vector<std::max_align_t> scratch(shape.scratch_size / sizeof(std::max_align_t) + 1);
        status = gim_decode_plane(&info, file.data(), file.size(), i, number, 0, planes[i].values.data(),
                                  scratch.data(), shape.scratch_size);
        if (status != GIM_OK) return decoding_error(status);
    }
    return planes;
}

uint64_t chunk_size(const gim_info& info, std::span<const uint8_t> file, Kind kind) {
    gim_chunk chunk;
    const auto type = static_cast<uint32_t>(plane_type(static_cast<uint32_t>(kind)));
    for (uint32_t i = 0; gim_read_chunk(&info, file.data(), file.size(), i, &chunk) == GIM_OK; ++i) {
        if (chunk.type == type) return chunk.size;
    }
    return 0;
}

Vec3 scaled_normal(const Mesh& mesh, uint32_t face) {
    const Triangle& t = mesh.triangles[face];
    const Vec3& a = mesh.positions[t[0]];
    return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
}

// Points of the input, and where they are on the decoded image.
struct Correspondence {
    SurfaceSamples samples;
    std::vector<uint32_t> image;  // kNone: the nearest face looks the other way, so it is another sheet
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

}  // namespace

struct PlaneMaker::Impl {
    const Mesh& clean;
    const TriangleMesh& input;
    const EncodeOptions& options;
    uint32_t color_side = 0;
    std::optional<AttributeSource> source;
    std::optional<InputColors> colors;

    std::vector<Kind> kinds() const {
        std::vector<Kind> kinds;
        if (options.normal_side > 0) kinds.push_back(Kind::kNormals);
        if (color_side > 0) kinds.push_back(Kind::kColors);
        return kinds;
    }
    uint32_t side_of(Kind kind) const { return kind == Kind::kNormals ? options.normal_side : color_side; }

    std::vector<float> samples(Kind kind, std::span<const ClosestPoint> points) const {
        if (kind == Kind::kNormals) {
            std::vector<float> values = source->normals(points);
            for (float& v : values) v *= kNormalUnit;
            return values;
        }
        std::vector<Vec3> positions;
        positions.reserve(points.size());
        for (const ClosestPoint& p : points) positions.push_back(p.point);
        std::vector<float> values = colors->at(positions);
        for (size_t i = 0; i < values.size(); i += 3) to_luma(&values[i]);
        return values;
    }

    // Values of the grid's texels; zero elsewhere. points: of the texels, on the input.
    std::vector<float> plane_values(Kind kind, const TexelGrid& grid, std::span<const ClosestPoint> points) const {
        const std::vector<float> values = samples(kind, points);
        std::vector<float> plane(size_t{grid.columns} * grid.rows * 3, 0.0f);
        for (size_t i = 0; i < grid.texels.size(); ++i) {
            std::copy_n(values.begin() + static_cast<ptrdiff_t>(3 * i), 3,
                        plane.begin() + static_cast<ptrdiff_t>(3 * size_t{grid.texels[i].index}));
        }
        return plane;
    }

    std::vector<AnalysedPlane> analyse_all(const PlaneImages& images) const {
        std::vector<AnalysedPlane> planes;
        for (const Kind kind : kinds()) planes.push_back({kind, images.plane_exponents(side_of(kind)), {}});
        for (size_t image = 0; !planes.empty() && image < planes[0].side_exponents.size(); ++image) {
            TexelGrid grid;  // shared by planes that are equally fine
            std::vector<ClosestPoint> points;
            std::optional<uint8_t> located;
            for (AnalysedPlane& plane : planes) {
                const uint8_t exponent = plane.side_exponents[image];
                if (located != exponent) {
                    grid = images.texel_grid(image, exponent);
                    points = source->locate(grid.texels);
                    located = exponent;
                }
                plane.pyramids.push_back(images.analyse_plane(image, grid, plane_values(plane.kind, grid, points),
                                                              quantizer_of(plane.kind, plane_quality(options))));
            }
        }
        return planes;
    }
};

std::vector<CodedPlane> code_to_budget(const std::vector<AnalysedPlane>& planes, const EncodeOptions& options) {
    const RateTarget& rate = options.rate;
    for (double quality = plane_quality(options);; quality -= 5) {
        std::vector<CodedPlane> coded;
        size_t bytes = 0;
        for (const AnalysedPlane& plane : planes) {
            coded.push_back(code(plane, quality));
            bytes += coded.back().payload.size();
        }
        const bool fits = rate.kind != RateTarget::Kind::kBytes || 2.0 * static_cast<double>(bytes) <= rate.value;
        if (fits || quality <= 0) return coded;
    }
}

PlaneMaker::PlaneMaker(const Mesh& clean, const TriangleMesh& input, const EncodeOptions& options)
    : impl_(new Impl{clean, input, options, gim::color_side(input, options), {}, {}}) {
    if (impl_->kinds().empty()) return;
    impl_->source.emplace(clean, options.threads);
    if (impl_->color_side > 0) impl_->colors.emplace(input, options.threads);
}
PlaneMaker::~PlaneMaker() = default;

bool PlaneMaker::wants_any() const { return impl_->source.has_value(); }

std::vector<CodedPlane> PlaneMaker::make(const PlaneImages& images) const {
    if (!wants_any()) return {};
    return code_to_budget(impl_->analyse_all(images), impl_->options);
}

Result<std::vector<PlaneReport>> PlaneMaker::measure(std::span<const uint8_t> file) const {
    std::vector<PlaneReport> reports;
    if (!wants_any()) return reports;
    const gim_limits no_limits{UINT64_MAX, UINT32_MAX, UINT32_MAX};
    gim_info info;
    gim_status status = gim_read_info(file.data(), file.size(), &no_limits, &info);
    DecodedGrids grids;
    for (uint32_t i = 0; status == GIM_OK && i < info.image_count; ++i) status = append_grid(info, file, i, &grids);
    if (status != GIM_OK) return decoding_error(status);
    const Correspondence c = correspond(impl_->clean, grids, impl_->options.seed, impl_->options.threads);
    for (const Kind kind : impl_->kinds()) {
        GIM_TRY(planes, decode_planes(info, file, kind));
        std::vector<float> colors;
        if (kind == Kind::kColors) colors = impl_->colors->at(c.samples.points);
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
                sum += angle_between(value, impl_->source->normal(at));
            }
        }
        PlaneReport report;
        report.kind = kind;
        for (const DecodedPlane& plane : planes) {
            report.width = std::max(report.width, plane.width);
            report.height = std::max(report.height, plane.height);
        }
        report.bytes = chunk_size(info, file, kind);
        const double mean = count > 0 ? sum / static_cast<double>(count) : 0;
        (kind == Kind::kColors ? report.psnr : report.mean_angle) =
            kind == Kind::kColors ? -10 * std::log10(mean) : mean;
        reports.push_back(report);
    }
    return reports;
}

}  // namespace gim
