// Words for what is wrong with a mesh, and where.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "encoder/surface/topology_summary.h"
#include "encoder/surface/weld_places.h"

namespace gim {

inline constexpr size_t kListed = 3;  // most elements that a message describes

std::string count_of(uint64_t n, const char* one, const char* many);
std::string text_of(const Point& p);
Point middle_of_edge(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, uint32_t half_edge);

// Describes what is not a manifold, one line each, with advice.
std::string describe_defects(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                             const TopologyAnalysis& topology);

std::string describe_edge(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, uint32_t h);

// sizes: triangles of each component.
std::string describe_components(std::vector<uint64_t> sizes);

}  // namespace gim
