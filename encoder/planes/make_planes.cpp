#include "encoder/planes/make_planes.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "encoder/planes/input_colors.h"
#include "encoder/planes/measure_planes.h"
#include "encoder/planes/sample_planes.h"
#include "format/plane_code.h"

namespace gim {

namespace {

constexpr double kQualityOfLossless = 90, kUsualQuality = 75;
// Quantizer steps at quality 75. Colours: in levels of 8 bits. Normals: in 1/1024 of unit length.
constexpr double kColorStep = 16, kNormalStep = 64;
constexpr uint32_t kMostAutomaticSide = 1025;

using Kind = PlaneReport::Kind;

// Returns the smallest 2^j + 1 that is at least `least`.
uint32_t grid_side_from(double least) {
    uint32_t side = 5;
    while (side < least && side < kMostAutomaticSide) side = 2 * side - 1;
    return side;
}

// Wants four texels per coloured vertex, and about half as many texels as texture pixels, because atlases have gaps.
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

// One plane of all images, ready to be coded.
struct AnalysedPlane {
    Kind kind = Kind::kNormals;
    std::vector<uint8_t> side_exponents;
    std::vector<PlaneCoder> coders;
};

CodedPlane code(const AnalysedPlane& plane, double quality) {
    const float quantizer = quantizer_of(plane.kind, quality);
    std::vector<std::vector<uint8_t>> streams;
    for (const PlaneCoder& coder : plane.coders) streams.push_back(coder(quantizer));
    return {plane_type(static_cast<uint32_t>(plane.kind)), serialize_plane(quantizer, plane.side_exponents, streams)};
}

}  // namespace

// Chunks without a payload, to tell how large the rest of a file is.
std::vector<CodedPlane> empty_planes(const std::vector<AnalysedPlane>& planes) {
    std::vector<CodedPlane> empty;
    for (const AnalysedPlane& plane : planes) empty.push_back({plane_type(static_cast<uint32_t>(plane.kind)), {}});
    return empty;
}

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

    // Returns the values of the grid's texels; zero elsewhere. points: the input's points of the texels.
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
            TexelGrid grid;  // planes of the same size share it
            std::vector<ClosestPoint> points;
            std::optional<uint8_t> located;
            for (AnalysedPlane& plane : planes) {
                const uint8_t exponent = plane.side_exponents[image];
                if (located != exponent) {
                    grid = images.texel_grid(image, exponent);
                    points = source->locate(grid.texels);
                    located = exponent;
                }
                plane.coders.push_back(images.analyse_plane(image, grid, plane_values(plane.kind, grid, points),
                                                            quantizer_of(plane.kind, plane_quality(options))));
            }
        }
        return planes;
    }
};

size_t bytes_of(const std::vector<CodedPlane>& planes) {
    size_t bytes = 0;
    for (const CodedPlane& plane : planes) bytes += plane.payload.size();
    return bytes;
}

// Takes the best quality with which the planes have at most so many bytes, but none above the one asked for.
std::vector<CodedPlane> code_within(double most_bytes, const std::vector<AnalysedPlane>& planes,
                                    const EncodeOptions& options) {
    for (double quality = plane_quality(options);; quality -= 5) {
        std::vector<CodedPlane> coded;
        for (const AnalysedPlane& plane : planes) coded.push_back(code(plane, quality));
        if (static_cast<double>(bytes_of(coded)) <= most_bytes || quality <= 0) return coded;
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
    const RateTarget& rate = impl_->options.rate;
    const double most = rate.kind == RateTarget::Kind::kBytes ? rate.value / 2 : HUGE_VAL;
    return code_within(most, impl_->analyse_all(images), impl_->options);
}

std::vector<uint8_t> PlaneMaker::renew(std::vector<uint8_t> file, const PlaneImages& images) const {
    if (!wants_any()) return file;
    const RateTarget& rate = impl_->options.rate;
    const std::vector<AnalysedPlane> planes = impl_->analyse_all(images);
    if (rate.kind != RateTarget::Kind::kBytes)
        return replace_planes(file, code_within(HUGE_VAL, planes, impl_->options));
    // Chunks of other sizes may change the index by a few bytes.
    constexpr double kIndexSlack = 16;
    const std::vector<uint8_t> bare = replace_planes(file, empty_planes(planes));
    const double most = std::min(rate.value / 2, rate.value - double(bare.size()) - kIndexSlack);
    std::vector<uint8_t> renewed = replace_planes(file, code_within(most, planes, impl_->options));
    return double(renewed.size()) <= std::max(rate.value, double(file.size())) ? renewed : file;
}

Result<std::vector<PlaneReport>> PlaneMaker::measure(std::span<const uint8_t> file) const {
    if (!wants_any()) return std::vector<PlaneReport>{};
    const PlaneReference reference = {impl_->clean, *impl_->source, impl_->colors ? &*impl_->colors : nullptr,
                                      impl_->options.seed, impl_->options.threads};
    return measure_planes(file, impl_->kinds(), reference);
}

}  // namespace gim
