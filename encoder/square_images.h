// The layout gim: one square image per connected component.
#pragma once

#include <vector>

#include "encoder/geometry_image.h"
#include "encoder/mesh.h"
#include "encoder/result.h"
#include "encoder/stage_clock.h"
#include "gim/encoder.h"

namespace gim {

// One image per component, and the surface that it was made of.
struct SquareImages {
    std::vector<GeometryImage> images;
    std::vector<Mesh> surfaces;
};

// In the order of the components' first faces; smaller components get smaller images. Adds its figures to the report.
Result<SquareImages> make_square_images(const Mesh& mesh, const EncodeOptions& options, StageClock& clock,
                                        const Observer& observer, EncodeReport& report);

}  // namespace gim
