#include "encoder/tiles/code_complex.h"

#include <algorithm>
#include <string>
#include <utility>

#include "encoder/code/range_encoder.h"
#include "format/tile_seams.h"

namespace gim {
namespace {

Error error(const QuadFault& fault) {
    const std::string at = std::to_string(fault.at);
    switch (fault.kind) {
        case QuadFault::Kind::kNoVertex:
            return {Stage::kWrite, "tile " + at + " has a corner that is no vertex"};
        case QuadFault::Kind::kRepeated:
            return {Stage::kWrite, "tile " + at + " has one vertex at two corners: split the tile"};
        case QuadFault::Kind::kCrowdedEdge:
            return {Stage::kWrite, "tile " + std::to_string(tile_of(fault.at)) + ", side " +
                                       std::to_string(side_of(fault.at)) +
                                       ": another tile runs along this edge in the same direction"};
        case QuadFault::Kind::kUnusedVertex:
            return {Stage::kWrite, "vertex " + at + " belongs to no tile"};
        default:
            return {Stage::kWrite, "vertex " + at + ": its tiles are not one fan"};
    }
}

// Follows the code through the complex of the image.
class Follower {
  public:
    Follower(const TileImage& image, const QuadComplex& complex)
        : image_(image), complex_(complex), code_of_(complex.half_edges(), kNoMate) {}

    bool joins(uint32_t h, uint32_t other) const { return complex_.mate[from_[h]] == from_[other]; }
    bool is_boundary(uint32_t h) const { return complex_.mate[from_[h]] == kNoMate; }
    // A half-edge that is not in the code yet counts as beyond its end.
    uint32_t mate(uint32_t h) const { return code_of_[complex_.mate[from_[h]]]; }
    void start(uint32_t) {
        while (code_of_[4 * next_] != kNoMate) ++next_;
        add(4 * next_);
    }
    void cross(uint32_t, uint32_t h) { add(complex_.mate[from_[h]]); }
    bool is_sharp(uint32_t h) const {
        const uint32_t from = from_[h], mate = complex_.mate[from];
        return image_.sharp[from] || (mate != kNoMate && image_.sharp[mate]);
    }

    std::vector<uint32_t> take_half_edges() { return std::move(from_); }

  private:
    // Adds the tile whose side 0 is to be a half-edge of the image.
    void add(uint32_t first) {
        for (uint32_t i = 0; i < 4; ++i, first = next_side(first)) {
            code_of_[first] = static_cast<uint32_t>(from_.size());
            from_.push_back(first);
        }
    }

    const TileImage& image_;
    const QuadComplex& complex_;
    std::vector<uint32_t> from_;     // per half-edge of the code: that of the image
    std::vector<uint32_t> code_of_;  // per half-edge of the image
    uint32_t next_ = 0;              // all tiles before are in the code
};

}  // namespace

Result<OwnComplex> complex_of(const std::vector<Quad>& quads, uint32_t vertices) {
    OwnComplex own(static_cast<uint32_t>(quads.size()));
    QuadComplex& c = own.view();
    std::vector<uint32_t> work(4 * quads.size() + vertices + 1);
    const QuadFault fault = find_mates(quads, vertices, work, c.mate);
    if (fault.kind != QuadFault::Kind::kFine) return error(fault);
    (void)number_complex(&c);  // no tile repeats a vertex
    // The vertices keep the numbers of the image.
    std::vector<uint32_t> valence(vertices);
    std::vector<uint8_t> on_boundary(vertices);
    for (uint32_t h = 0; h < c.half_edges(); ++h) {
        const uint32_t v = quads[tile_of(h)][side_of(h)];
        valence[v] = c.valence[c.vertex[h]];
        on_boundary[v] = c.on_boundary[c.vertex[h]];
    }
    for (uint32_t h = 0; h < c.half_edges(); ++h) c.vertex[h] = quads[tile_of(h)][side_of(h)];
    std::copy(valence.begin(), valence.end(), c.valence);
    std::copy(on_boundary.begin(), on_boundary.end(), c.on_boundary);
    return own;
}

CodedComplex code_complex(const TileImage& image, const QuadComplex& complex) {
    CodedComplex coded{OwnComplex(complex.tiles), {}, {}};
    std::vector<uint32_t> next(complex.half_edges()), previous(next.size()), fan(next.size());
    TileShape shape;
    shape.has_sharp_edges = !image.sharp.empty();
    Follower follower(image, complex);
    RangeEncoder coder;
    (void)code_tile_seams(coder, follower, shape, {next.data(), previous.data(), fan.data()}, &coded.complex.view());
    coded.half_edges = follower.take_half_edges();
    coded.payload = coder.finish();
    return coded;
}

std::vector<uint32_t> coded_samples(const CodedComplex& coded, const QuadComplex& complex, uint32_t side) {
    const TileSamples samples(complex, side);
    std::vector<uint32_t> grid;
    grid.reserve(size_t{complex.tiles} * (side + 1) * (side + 1));
    for_each_coded_sample(coded, side, [&](uint32_t tile, uint32_t row, uint32_t column) {
        grid.push_back(samples.at(tile, row, column));
    });
    return grid;
}

}  // namespace gim
