// LEMON 1.3.1 does not compile as C++20 (it uses std::allocator::construct), so this unit is C++17 and includes nothing
// of ours but its header.
#include "encoder/tiles/perfect_matching.h"

#include <lemon/matching.h>
#include <lemon/smart_graph.h>

namespace gim {

std::vector<uint32_t> perfect_matching(uint32_t nodes, const std::vector<WeightedEdge>& edges) {
    using Graph = lemon::SmartGraph;
    Graph graph;
    graph.reserveNode(static_cast<int>(nodes));
    graph.reserveEdge(static_cast<int>(edges.size()));
    for (uint32_t n = 0; n < nodes; ++n) graph.addNode();
    Graph::EdgeMap<int64_t> weights(graph);
    for (const WeightedEdge& e : edges)
        weights[graph.addEdge(Graph::nodeFromId(static_cast<int>(e.a)), Graph::nodeFromId(static_cast<int>(e.b)))] =
            e.weight;
    lemon::MaxWeightedPerfectMatching<Graph, Graph::EdgeMap<int64_t>> matching(graph, weights);
    if (!matching.run()) return {};
    std::vector<uint32_t> partner(nodes);
    for (uint32_t n = 0; n < nodes; ++n)
        partner[n] = static_cast<uint32_t>(Graph::id(matching.mate(Graph::nodeFromId(static_cast<int>(n)))));
    return partner;
}

}  // namespace gim
