#include "tools/glb_atlas.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tools/glb_frames.h"

namespace gim::gltf {
namespace {

constexpr uint32_t kMostSide = 4096;
constexpr uint32_t kTexelsOfASample = 2;  // at least, on tiles: else filters reach from tile to tile
constexpr uint32_t kLeastOfSeveral = 256;

uint32_t multiple_of_4(double side) {
    return 4 * static_cast<uint32_t>(std::clamp(std::ceil(side / 4), 1.0, kMostSide / 4.0));
}

// Squares are alone in their image. Tiles have others beside them.
bool is_square(const DecodedImage& image) {
    return image.columns == image.rows && ((image.columns - 1) & (image.columns - 2)) == 0;
}

double area_of(const DecodedImage& image) {
    const auto at = [&](uint32_t v) {
        const float* p = &image.positions[3 * size_t{v}];
        return Eigen::Vector3d(double{p[0]}, double{p[1]}, double{p[2]});
    };
    double area = 0;
    for (size_t i = 0; i + 2 < image.triangles.size(); i += 3) {
        const Eigen::Vector3d a = at(image.triangles[i]);
        area += (at(image.triangles[i + 1]) - a).cross(at(image.triangles[i + 2]) - a).norm() / 2;
    }
    return area;
}

}  // namespace

std::vector<AtlasPlace> places_of(const std::vector<DecodedImage>& images) {
    if (images.size() == 1) return {};
    std::vector<double> sides;
    for (const DecodedImage& image : images) sides.push_back(std::sqrt(area_of(image)));
    return pack_squares(sides);
}

MeshAtlas::MeshAtlas(const MeshSurface& surface, const GimGeometry& geometry, uint32_t threads)
    : surface_(surface), arrays_(arrays_of(geometry, {{}, true, true})), threads_(threads) {
    const DecodedImage& first = geometry.images.front();
    if (geometry.images.size() > 1) {
        least_width_ = kLeastOfSeveral;
    } else if (!is_square(first)) {
        aspect_ = double(first.columns - 1) / (first.rows - 1);
        least_width_ = kTexelsOfASample * (first.columns - 1);
    }
    for (const auto& labels : geometry.labels) labels_.insert(labels_.end(), labels.begin(), labels.end());
}

AtlasSize MeshAtlas::size_for(double texels, const std::function<bool(uint32_t)>& is_asked) const {
    PrimitiveArrays part;
    part.texcoords = arrays_.texcoords;
    for (uint32_t t = 0; 3 * size_t{t} < arrays_.indices.size(); ++t) {
        if (!is_asked(primitive_of(t))) continue;
        for (size_t k = 0; k < 3; ++k) part.indices.push_back(arrays_.indices[3 * size_t{t} + k]);
    }
    const double share = std::max(covered_share(part), 1e-6);
    const double width = std::max(std::sqrt(texels / share * aspect_), static_cast<double>(least_width_));
    return {multiple_of_4(width), multiple_of_4(width / aspect_)};
}

const std::vector<MeshAtlas::Texel>& MeshAtlas::texels(const AtlasSize& size) {
    const auto [found, is_new] = located_.try_emplace({size.width, size.height});
    if (!is_new) return found->second;
    std::map<uint32_t, std::vector<AtlasTexel>> of_primitive;
    for (const AtlasTexel& texel : texels_of(arrays_, size))
        of_primitive[primitive_of(texel.triangle)].push_back(texel);
    for (const auto& [primitive, texels] : of_primitive) locate(primitive, texels, found->second);
    return found->second;
}

void MeshAtlas::locate(uint32_t primitive, const std::vector<AtlasTexel>& texels, std::vector<Texel>& found) const {
    constexpr size_t kBatch = size_t{1} << 18;  // bounds the memory
    TriangleMesh part;
    std::vector<uint32_t> triangles;
    part.positions = surface_.mesh.positions;
    for (uint32_t t = 0; t < surface_.mesh.triangles.size(); ++t) {
        if (surface_.mesh.labels[t] != primitive) continue;
        part.triangles.push_back(surface_.mesh.triangles[t]);
        triangles.push_back(t);
    }
    const NearestPoints nearest(part, threads_);
    std::vector<SurfaceQuery> queries;
    for (size_t begin = 0; begin < texels.size(); begin += kBatch) {
        const size_t end = std::min(texels.size(), begin + kBatch);
        queries.clear();
        for (size_t i = begin; i < end; ++i) {
            const FrameAt at = frame_at(arrays_, texels[i].triangle, texels[i].weights);
            queries.push_back({{at.position.x(), at.position.y(), at.position.z()},
                               {at.normal.x(), at.normal.y(), at.normal.z()},
                               at.spacing});
        }
        std::vector<SurfacePoint> points = nearest.find(queries);
        for (size_t i = begin; i < end; ++i) {
            SurfacePoint& at = points[i - begin];
            if (at.triangle == UINT32_MAX) continue;
            at.triangle = triangles[at.triangle];
            found.push_back({texels[i], at});
        }
    }
}

}  // namespace gim::gltf
