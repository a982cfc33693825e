#include "encoder/charts/chart_set.h"

#include <algorithm>

namespace gim {

namespace {

// Knows the border half-edges, and which one follows another around a chart.
class Borders {
  public:
    Borders(const Mesh& mesh, const Topology& topology, const Chartification& charts)
        : mesh_(mesh), topology_(topology), charts_(charts) {}

    uint32_t chart(uint32_t h) const { return charts_.chart_of_face[face_of(h)]; }
    bool is_border(uint32_t h) const { return topology_.twin[h] == kNone || chart(topology_.twin[h]) != chart(h); }
    uint32_t following(uint32_t h) const {
        h = next(h);
        while (!is_border(h)) h = next(topology_.twin[h]);
        return h;
    }

    // Returns for each vertex of the surface whether it is a cut-node.
    std::vector<uint8_t> find_nodes() const {
        std::vector<uint32_t> valence(mesh_.positions.size(), 0);
        for (uint32_t h = 0; h < topology_.twin.size(); ++h) {
            if (!is_border(h) || (topology_.twin[h] != kNone && topology_.twin[h] < h)) continue;
            ++valence[from(mesh_, h)], ++valence[to(mesh_, h)];
        }
        std::vector<uint8_t> node(valence.size());
        for (size_t v = 0; v < node.size(); ++v) node[v] = valence[v] != 0 && valence[v] != 2;
        add_nodes_to_bare_loops(node);
        return node;
    }

  private:
    void add_nodes_to_bare_loops(std::vector<uint8_t>& node) const {
        std::vector<uint8_t> seen(topology_.twin.size(), 0);
        std::vector<uint32_t> loop;
        for (uint32_t start = 0; start < seen.size(); ++start) {
            if (seen[start] || !is_border(start)) continue;
            loop.clear();
            bool bare = true;
            uint32_t h = start;
            do {
                seen[h] = 1;
                loop.push_back(from(mesh_, h));
                bare &= !node[loop.back()];
                h = following(h);
            } while (h != start);
            if (!bare) continue;
            const size_t wanted = topology_.twin[start] == kNone ? 1 : 3;
            for (size_t k = 0; k < wanted; ++k) node[loop[k * loop.size() / wanted]] = 1;
        }
    }

    const Mesh& mesh_;
    const Topology& topology_;
    const Chartification& charts_;
};

}  // namespace

std::vector<double> Chart::of_own_faces(const std::vector<double>& values) const {
    std::vector<double> own;
    if (values.empty()) return own;
    for (const uint32_t f : source_face) own.push_back(values[f]);
    return own;
}

std::vector<Chart> take_apart(const Mesh& mesh, const Topology& topology, const Chartification& charts) {
    std::vector<Chart> result(charts.count);
    // A chart meets a vertex in one fan, so (chart, vertex) names a copy. Charts are filled one after the other.
    std::vector<std::vector<uint32_t>> faces(charts.count);
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) faces[charts.chart_of_face[f]].push_back(f);
    std::vector<uint32_t> local(mesh.positions.size(), kNone);
    const Borders borders(mesh, topology, charts);
    const std::vector<uint8_t> node = borders.find_nodes();
    std::vector<std::array<uint32_t, 2>> path_of(topology.twin.size(), {kNone, kNone});
    std::vector<std::vector<uint32_t>> loop_edges(charts.count);

    for (uint32_t c = 0; c < charts.count; ++c) {
        Chart& chart = result[c];
        chart.source_face = faces[c];
        uint32_t start = kNone;
        for (const uint32_t f : faces[c]) {
            Triangle t = mesh.triangles[f];
            for (uint32_t i = 0; i < 3; ++i) {
                uint32_t& copy = local[t[i]];
                if (copy == kNone) {
                    copy = static_cast<uint32_t>(chart.source_vertex.size());
                    chart.source_vertex.push_back(t[i]);
                    chart.mesh.positions.push_back(mesh.positions[t[i]]);
                }
                const uint32_t h = 3 * f + i;
                if (borders.is_border(h) && (start == kNone || (node[t[i]] && !node[from(mesh, start)]))) start = h;
            }
            chart.mesh.triangles.push_back({local[t[0]], local[t[1]], local[t[2]]});
        }
        uint32_t h = start;
        do {
            const uint32_t v = from(mesh, h);
            if (h == start || node[v]) {
                chart.paths.push_back({static_cast<uint32_t>(chart.loop.size()), kNone, kNone, v, 0});
            }
            path_of[h] = {c, static_cast<uint32_t>(chart.paths.size() - 1)};
            chart.loop.push_back(local[v]);
            loop_edges[c].push_back(h);
            h = borders.following(h);
        } while (h != start);
        for (const uint32_t v : chart.source_vertex) local[v] = kNone;
    }
    for (uint32_t c = 0; c < charts.count; ++c) {
        std::vector<ChartPath>& paths = result[c].paths;
        for (size_t p = 0; p < paths.size(); ++p) {
            paths[p].end_node = paths[(p + 1) % paths.size()].begin_node;
            const uint32_t twin = topology.twin[loop_edges[c][paths[p].first]];
            if (twin == kNone) continue;
            paths[p].mate_chart = path_of[twin][0];
            paths[p].mate_path = path_of[twin][1];
        }
    }
    return result;
}

}  // namespace gim
