#include "encoder/fit/measure_start.h"

#include <algorithm>
#include <cstdio>

#include "encoder/surface/compare_meshes.h"

namespace gim {
namespace {

// Beyond it, image and mesh most likely differ in unit or place.
constexpr double kFarthest = 0.1;  // RMS, in diagonals of the mesh

}  // namespace

Result<FitQuality> measure_start(const GeometryImage& image, const Mesh& mesh, uint32_t threads) {
    GIM_TRY(quality, measure_fit(image, mesh, {}, threads));
    const double distance = std::max(quality.to_image, quality.to_reference), diagonal = bounding_diagonal(mesh);
    if (distance <= kFarthest * diagonal) return quality;
    char text[200];
    std::snprintf(
        text, sizeof text,
        "image and mesh lie %.3g apart on the average, and the mesh has a diagonal of %.3g; both must show the "
        "same surface in the same coordinates",
        distance, diagonal);
    return Error{Stage::kFit, text};
}

}  // namespace gim
