// Makes the surface of a zippered image a manifold again if the zippers glued too much together.
//
// Two charts that are zipped together may both have an edge between the same two points of their border. That edge then
// has four triangles. The repair merges the border point between its ends with one of them, which flattens the
// triangles there on both sides. The method is ours; the paper of zipper.h does not mention the case.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "encoder/charts/multi_chart_image.h"
#include "gim/encoder.h"

namespace gim {

// In:  an image with zippers; its gluing is made here. `close_seams` moves border samples onto the cut-paths as the
//      zippers say.
// Out: empty if the surface is a manifold now; the zippers have changed if it was none before. Otherwise samples to
//      take out of the mask, so that the surface may become a manifold. Fails if it finds no such samples.
Result<std::vector<uint32_t>> repair_zippers(MultiChartImage& image, const std::function<void()>& close_seams);

// Returns the error for an image that cannot be repaired: `edges` edges with too many triangles remain.
Error charts_too_small(size_t edges);

}  // namespace gim
