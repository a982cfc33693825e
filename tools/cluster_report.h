// What the clusters of an image are worth to a renderer (gim/clusters.h), for gim info --clusters.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "gim/decoder.h"

namespace gim {

// The clusters of one depth.
struct ClusterFigures {
    uint32_t depth = 0, clusters = 0, triangles = 0, vertices = 0;  // vertices: counted again in each cluster
    double acmr = 0;  // misses for each triangle of a cache of 16 vertices
    double culled =
        0;  // share of the triangles whose cluster looks away; mean over the directions of both ends of each axis
    double error = 0;  // object units
};

// The depths of level 0 that have triangles, finest first. Returns the decoder's status if there are none: GIM_BAD_ARGUMENT
// for charts.
gim_status measure_clusters(const gim_info& info, std::span<const uint8_t> file, uint32_t image,
                            std::vector<ClusterFigures>* figures);

nlohmann::ordered_json to_json(const std::vector<ClusterFigures>& figures);
void print_clusters(uint32_t image, const std::vector<ClusterFigures>& figures);

}  // namespace gim
