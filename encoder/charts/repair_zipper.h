// Makes the surface of a zippered image a manifold again where the zippers glued too much together.
//
// Two triangles side by side in one chart may meet two others in its neighbour with the same three vertices: an edge with
// four triangles. The repair merges the vertex between the ends of that edge with one of them, which flattens both pairs.
// The method is ours; the paper of zipper.h does not mention the case.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "encoder/charts/multi_chart_image.h"
#include "gim/encoder.h"

namespace gim {

// In:  an image with zippers; its gluing is made here. `close_seams` moves the border samples onto the cut-paths as the zippers say.
// Out: nothing if the surface is a manifold now; the zippers have changed if it was not before. Otherwise samples of the
//      image: without them in the mask it should be one. Fails where it knows of no such samples.
Result<std::vector<uint32_t>> repair_zippers(MultiChartImage& image, const std::function<void()>& close_seams);

// The error of an image that cannot be repaired: `edges` with too many triangles remain.
Error charts_too_small(size_t edges);

}  // namespace gim
