#include "encoder/emboss/code_displacements.h"

#include <algorithm>
#include <utility>

#include "decoder/squares/square_decoder.h"
#include "decoder/tiles/tile_decoder.h"
#include "encoder/code/wavelet_analysis.h"
#include "encoder/planes/plane_images.h"
#include "encoder/tiles/tile_plane.h"
#include "format/plane_code.h"
#include "format/ring.h"
#include "format/tile_atlas.h"

namespace gim {
namespace {

// Gives all samples of a class the values of its first one.
void equalize_classes(const SeamTable& seams, uint32_t side, std::vector<float>& values) {
    std::vector<uint32_t> class_of(ring_length(side));
    ring_classes(seams, side, class_of);
    const auto at = [&](uint32_t k) {
        const GridPoint p = ring_point(side, k);
        return values.begin() + static_cast<ptrdiff_t>(3 * (size_t{p.row} * side + p.column));
    };
    std::vector<uint32_t> first(class_of.size(), UINT32_MAX);
    for (uint32_t k = 0; k < class_of.size(); ++k) {
        uint32_t& f = first[class_of[k]];
        if (f == UINT32_MAX) f = k;
        std::copy_n(at(f), 3, at(k));
    }
}

Status square_coder(const Header& header, std::span<const uint8_t> file, uint32_t image, const Displacements& of,
                    PlaneCoder* coder) {
    SeamTable seams;
    if (Status s = read_seams(header, file, image, &seams); s != Status::kOk) return s;
    std::vector<float> values = of.values;
    equalize_classes(seams, of.width, values);
    *coder = coder_of(analyse<Irreversible97>(std::move(values), of.width));
    return Status::kOk;
}

Status tile_coder(const Header& header, std::span<const uint8_t> file, const Displacements& of, PlaneCoder* coder) {
    const TileShape& shape = header.tiles;
    Arena counter(nullptr);
    (void)lay_out_complex(shape, &counter);
    std::vector<std::max_align_t> memory(counter.used() / sizeof(std::max_align_t) + 1);
    Arena arena(memory.data());
    TileWorkspace ws = lay_out_complex(shape, &arena);
    if (Status s = read_complex(header, file, ws); s != Status::kOk) return s;
    OwnComplex complex(shape.tiles);
    std::copy_n(ws.complex.mate, ws.complex.half_edges(), complex.view().mate);
    if (!number_complex(&complex.view())) return Status::kMalformed;

    const TileAtlas atlas(shape.tiles, shape.intervals(0));
    const uint32_t side = shape.intervals(0) << of.exponent;
    std::vector<float> grids;
    grids.reserve(3 * shape.tiles * size_t{side + 1} * (side + 1));
    for (uint32_t t = 0; t < shape.tiles; ++t) {
        for (uint32_t row = 0; row <= side; ++row) {
            const size_t at =
                ((size_t{atlas.row(t)} << of.exponent) + row) * of.width + (size_t{atlas.column(t)} << of.exponent);
            const auto from = of.values.begin() + static_cast<ptrdiff_t>(3 * at);
            grids.insert(grids.end(), from, from + static_cast<ptrdiff_t>(3 * (size_t{side} + 1)));
        }
    }
    *coder = tile_grid_coder(std::move(complex), shape, of.exponent, std::move(grids));
    return Status::kOk;
}

}  // namespace

Result<CodedPlane> code_displacements(std::span<const uint8_t> file, std::span<const Displacements> images,
                                      float quantizer) {
    Header header;
    Status status = parse_header(file, kNoLimits, &header);
    std::vector<uint8_t> exponents;
    std::vector<std::vector<uint8_t>> streams;
    for (uint32_t i = 0; i < images.size() && status == Status::kOk; ++i) {
        PlaneCoder coder;
        status = header.layout == FileLayout::kTiles ? tile_coder(header, file, images[i], &coder)
                                                     : square_coder(header, file, i, images[i], &coder);
        if (status != Status::kOk) break;
        exponents.push_back(images[i].exponent);
        streams.push_back(coder(quantizer));
    }
    if (status != Status::kOk) return Error{Stage::kInput, "the .gim file is damaged"};
    return CodedPlane{ChunkType::kDisplacements, serialize_plane(quantizer, exponents, streams)};
}

}  // namespace gim
