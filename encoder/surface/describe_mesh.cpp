#include "encoder/surface/describe_mesh.h"

#include <algorithm>
#include <array>
#include <cstdio>

namespace gim {

std::string count_of(uint64_t n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

std::string text_of(const Point& p) {
    std::array<char, 96> buffer{};
    std::snprintf(buffer.data(), buffer.size(), "(%.8g, %.8g, %.8g)", p[0], p[1], p[2]);
    return buffer.data();
}

Point middle_of_edge(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, uint32_t half_edge) {
    const Triangle& t = triangles[half_edge / 3];
    const Point &p = positions[t[half_edge % 3]], &q = positions[t[(half_edge % 3 + 1) % 3]];
    return {p[0] / 2 + q[0] / 2, p[1] / 2 + q[1] / 2, p[2] / 2 + q[2] / 2};  // the whole sum may be infinite
}

std::string describe_edge(const std::vector<Point>& positions, const std::vector<Triangle>& triangles, uint32_t h) {
    const Triangle& t = triangles[h / 3];
    return "edge " + std::to_string(t[h % 3]) + "-" + std::to_string(t[(h % 3 + 1) % 3]) + " at " +
           text_of(middle_of_edge(positions, triangles, h));
}

std::string describe_defects(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                             const TopologyAnalysis& topology) {
    std::string text;
    if (!topology.nonmanifold_edges.empty()) {
        text += count_of(topology.nonmanifold_edges.size(), "edge has", "edges have") + " more than two faces";
        for (size_t k = 0; k < std::min(kListed, topology.nonmanifold_edges.size()); ++k) {
            const auto around = topology.edges.around(topology.nonmanifold_edges[k]);
            text += "\n  " + describe_edge(positions, triangles, around[0]) + " has " + std::to_string(around.size()) +
                    " faces";
        }
    }
    if (!topology.nonmanifold_vertices.empty()) {
        if (!text.empty()) text += "\n";
        text += count_of(topology.nonmanifold_vertices.size(), "vertex joins", "vertices join") +
                " faces that are not one fan (the surface is pinched there)";
        for (size_t k = 0; k < std::min(kListed, topology.nonmanifold_vertices.size()); ++k) {
            const uint32_t v = topology.nonmanifold_vertices[k];
            text += "\n  vertex " + std::to_string(v) + " at " + text_of(positions[v]);
        }
    }
    return text +
           "\nThe surface must be a 2-manifold: leave out --strict, which repairs it, or repair it in a mesh editor "
           "(\"make manifold\")";
}

std::string describe_components(std::vector<uint64_t> sizes) {
    std::sort(sizes.rbegin(), sizes.rend());
    std::string text = "the mesh has " + std::to_string(sizes.size()) + " connected components (of ";
    for (size_t k = 0; k < std::min(size_t{4}, sizes.size()); ++k)
        text += (k > 0 ? ", " : "") + std::to_string(sizes[k]);
    return text + (sizes.size() > 4 ? ", ..." : "") +
           " triangles), and this layout takes one. Use --layout mcgim, or encode the pieces one by one";
}

}  // namespace gim
