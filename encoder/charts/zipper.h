// Closes the cracks between packed charts: finds the sample of every cut-node, snaps border samples onto the cut-paths,
// and unifies the two sides of each.
//
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5. We differ from the paper:
// (1) Dynamic programming finds the cut-node samples of a chart all at once, not one by one. It minimises the sum of
// squared distances in the map, keeps the order of the nodes around the border, and leaves a sample between neighbours
// if it can. (2) Dynamic programming also finds the zipper: of all lock-step traversals the one that moves samples
// least, not a greedy one. (3) A unified point lies at the mean position of its samples along the path, not at one of
// them. Points keep a distance along the path.
#pragma once

#include <vector>

#include "encoder/charts/chart_parametrize.h"
#include "encoder/charts/chart_set.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/charts/pack.h"

namespace gim {

// In:  the image as sampled, and what it was sampled from. Every chart's mask is a disk with at least two border
//      samples per path.
// Out: the same image with its seams filled in and border samples moved onto the cut-paths. Samples that are one
//      surface point have bit-equal positions. If the surface would touch itself along an edge, a few border samples
//      leave the mask. Fails if that does not help; another packing may help.
// Cost: O(sum over seams of the product of the lengths of both sides).
Result<MultiChartImage> zip(MultiChartImage image, const std::vector<Chart>& charts, const std::vector<ChartMap>& maps,
                            const Packing& packing);

}  // namespace gim
