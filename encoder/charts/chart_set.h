// Takes a chartified surface apart. Every chart becomes a mesh of its own, and its border a loop of cut-paths. Each
// path knows the path on its other side.
// Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.5, "Cut-Nodes", "Cut-Paths".
//
// A cut-node is a vertex where the number of border edges is not two. We differ from the paper for seams that close
// upon themselves without a cut-node. Such a seam between two charts (that make up a sphere) gets three cut-nodes, an
// input boundary of a single chart gets one. So every border is made of paths.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/charts/chartify.h"
#include "encoder/surface/mesh.h"
#include "format/mate.h"

namespace gim {

// A directed run of border edges between two cut-nodes.
struct ChartPath {
    uint32_t first = 0;  // index into Chart::loop of its first vertex; it ends where the next path begins
    uint32_t mate_chart = kNoMate, mate_path = kNoMate;  // the path on the other side; it runs the other way
    uint32_t begin_node = 0, end_node = 0;               // vertices of the surface
};

struct Chart {
    Mesh mesh;
    std::vector<uint32_t> source_vertex, source_face;  // in the surface, per vertex and face of `mesh`
    std::vector<uint32_t> loop;    // border vertices of `mesh`, faces on the left; starts at a cut-node
    std::vector<ChartPath> paths;  // in loop order

    // Returns the values of its own faces, of one per face of the surface. Empty if there are none.
    std::vector<double> of_own_faces(const std::vector<double>& values) const;
    // Returns the index in `loop` at which path p ends. Its end node is loop[path_end(p) % loop.size()].
    uint32_t path_end(size_t p) const {
        return p + 1 < paths.size() ? paths[p + 1].first : static_cast<uint32_t>(loop.size());
    }
};

// In: charts that are disks with simple borders (charts_are_disks). O(F).
std::vector<Chart> take_apart(const Mesh& mesh, const Topology& topology, const Chartification& charts);

}  // namespace gim
