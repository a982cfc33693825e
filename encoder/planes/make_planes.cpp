#include "encoder/planes/make_planes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "encoder/code/code_bands.h"
#include "encoder/code/extend_chart.h"
#include "encoder/planes/input_colors.h"
#include "encoder/planes/measure_planes.h"
#include "encoder/planes/sample_planes.h"
#include "format/chart_table.h"
#include "format/plane_code.h"
#include "format/sideband_code.h"

namespace gim {

namespace {

constexpr double kQualityOfLossless = 90, kUsualQuality = 75;
// Quantizer steps at quality 75: levels of 8 bits, and 1/1024 of a unit normal.
constexpr double kColorStep = 16, kNormalStep = 64;
constexpr uint32_t kMostAutomaticSide = 1025;

using Kind = PlaneReport::Kind;

uint32_t exponent_of(uint32_t side) { return static_cast<uint32_t>(std::countr_zero(side - 1)); }

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

    // Smaller images get smaller planes; never below the grid that their seams need.
    uint32_t exponent(Kind kind, const GeometryImage& image, uint32_t largest_image) const {
        const int wanted = static_cast<int>(exponent_of(side_of(kind)) + exponent_of(image.side)) -
                           static_cast<int>(exponent_of(largest_image));
        const uint32_t nodes = with_coarsest_node_grid(image.sideband).node_side;
        return static_cast<uint32_t>(std::max({wanted, 1, static_cast<int>(exponent_of(std::max(nodes, 3u)))}));
    }

    Result<std::vector<AnalysedPlane>> analyse_all(std::span<const GeometryImage> images) const {
        uint32_t largest = 0;
        for (const GeometryImage& image : images) largest = std::max(largest, image.side);
        std::vector<AnalysedPlane> planes;
        for (const Kind kind : kinds()) planes.push_back({kind, {}, {}});
        for (const GeometryImage& image : images) {
            std::vector<ClosestPoint> points;  // shared by planes of one side
            uint32_t located = 0;
            for (AnalysedPlane& plane : planes) {
                const uint32_t j = exponent(plane.kind, image, largest), side = (1u << j) + 1;
                if (located != side) {
                    GIM_TRY(found, source->locate(image, side));
                    points = std::move(found);
                    located = side;
                }
                std::vector<float> values = samples(plane.kind, points);
                GIM_TRY(equal, equalize_ring(with_coarsest_node_grid(image.sideband), side, values));
                (void)equal;
                plane.side_exponents.push_back(static_cast<uint8_t>(j));
                plane.pyramids.push_back(analyse<Irreversible97>(std::move(values), side));
            }
        }
        return planes;
    }
};

Result<std::vector<CodedPlane>> code_to_budget(const std::vector<AnalysedPlane>& planes, const EncodeOptions& options) {
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

Result<std::vector<CodedPlane>> PlaneMaker::make(std::span<const GeometryImage> images) const {
    if (!wants_any()) return std::vector<CodedPlane>{};
    GIM_TRY(planes, impl_->analyse_all(images));
    return code_to_budget(planes, impl_->options);
}

Result<std::vector<CodedPlane>> PlaneMaker::make(const MultiChartImage& image) const {
    if (!wants_any()) return std::vector<CodedPlane>{};
    std::vector<AnalysedPlane> planes;
    AttributeSource::Texels texels;
    for (const Kind kind : impl_->kinds()) {
        const double per_sample = impl_->side_of(kind) / std::sqrt(double(image.width()) * image.height());
        const auto exponent = static_cast<uint32_t>(
            std::clamp(std::lround(std::log2(per_sample)), 0l, static_cast<long>(kMaxTexelExponent)));
        if (planes.empty() || planes.back().side_exponents[0] != exponent) {
            GIM_TRY(found, impl_->source->locate(image, exponent));
            texels = std::move(found);
        }
        const auto columns = static_cast<uint32_t>(chart_plane_side(image.width(), exponent)),
                   rows = static_cast<uint32_t>(chart_plane_side(image.height(), exponent));
        const std::vector<float> values = impl_->samples(kind, texels.points);
        std::vector<float> plane(size_t{columns} * rows * 3, 0.0f);
        std::vector<uint8_t> defined(plane.size() / 3, 0);
        for (size_t i = 0; i < texels.texels.size(); ++i) {
            defined[texels.texels[i]] = 1;
            std::copy_n(values.begin() + static_cast<ptrdiff_t>(3 * i), 3,
                        plane.begin() + static_cast<ptrdiff_t>(3 * size_t{texels.texels[i]}));
        }
        const uint32_t steps = halvings(columns, rows);
        constexpr int kRounds = 12;
        plane = extend_chart<Irreversible97>(std::move(plane), defined, columns, rows, steps,
                                             quantizer_of(kind, plane_quality(impl_->options)), kRounds);
        planes.push_back({kind, {static_cast<uint8_t>(exponent)}, {}});
        planes.back().pyramids.push_back(analyse<Irreversible97>(std::move(plane), columns, rows, steps));
    }
    return code_to_budget(planes, impl_->options);
}

Result<std::vector<PlaneReport>> PlaneMaker::measure(std::span<const uint8_t> file) const {
    if (!wants_any()) return std::vector<PlaneReport>{};
    const PlaneReference reference = {impl_->clean, *impl_->source, impl_->colors ? &*impl_->colors : nullptr,
                                      impl_->options.seed, impl_->options.threads};
    return measure_planes(file, impl_->kinds(), reference);
}

}  // namespace gim
