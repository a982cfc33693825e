#include "encoder/tiles/tile_complex.h"

#include <algorithm>
#include <string>

namespace gim {

Result<TileComplex> TileComplex::make(const std::vector<Quad>& quads) {
    TileComplex complex;
    std::vector<Quad> compact = quads;
    {
        uint32_t most = 0;
        for (const Quad& quad : quads) most = std::max(most, *std::max_element(quad.begin(), quad.end()));
        std::vector<uint32_t> number(size_t{most} + 1, kNoMate);
        for (Quad& quad : compact) {
            for (uint32_t& v : quad) {
                if (number[v] == kNoMate) {
                    number[v] = static_cast<uint32_t>(complex.vertices_.size());
                    complex.vertices_.push_back(v);
                }
                v = number[v];
            }
        }
    }
    const size_t half_edges = 4 * quads.size(), vertices = complex.vertices_.size();
    complex.mates_.resize(half_edges);
    std::vector<uint32_t> work(half_edges + vertices + 1);
    const QuadFault fault = find_mates(compact, static_cast<uint32_t>(vertices), work, complex.mates_.data());
    if (fault.kind != QuadFault{}.kind)
        return Error{Stage::kParametrize, "the tiles are no surface (at " + std::to_string(fault.at) +
                                              "); this is an error of the program"};
    complex.vertex_.resize(half_edges);
    complex.edge_.resize(half_edges);
    complex.lower_.resize(half_edges);
    complex.valence_.resize(half_edges);
    complex.on_boundary_.resize(half_edges);
    QuadComplex view = complex.view();
    if (!number_complex(&view))
        return Error{Stage::kParametrize, "a tile has a corner twice; this is an error of the program"};
    complex.edge_count_ = view.edges;
    return complex;
}

QuadComplex TileComplex::view() {
    QuadComplex view;
    view.tiles = static_cast<uint32_t>(mates_.size() / 4);
    view.vertices = static_cast<uint32_t>(vertices_.size());
    view.edges = edge_count_;
    view.mate = mates_.data();
    view.vertex = vertex_.data();
    view.edge = edge_.data();
    view.lower = lower_.data();
    view.valence = valence_.data();
    view.on_boundary = on_boundary_.data();
    return view;
}

}  // namespace gim
