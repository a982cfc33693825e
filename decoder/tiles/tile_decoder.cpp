#include "decoder/tiles/tile_decoder.h"

#include <algorithm>
#include <bit>
#include <new>

#include "decoder/pyramid/pyramid_decoder.h"
#include "decoder/pyramid/range_decoder.h"
#include "decoder/tiles/tile_details.h"
#include "format/tile_base.h"
#include "format/tile_lifting.h"
#include "format/tile_norms.h"
#include "format/tile_seams.h"

namespace gim {
namespace {

// What the streams of a complex hold: positions or a plane.
struct TileCoding {
    const TileShape& shape;
    DetailCoding details;
    CoefficientKind kind;
    int32_t middle;  // what the base is stored relative to
    const TileArithmetic& arithmetic;
};

// Lets the decoder take part in traversals that ask a writer for the complex.
struct NoSource {};

// Does what join_planes does, row by row.
void join_rows(const TilePlanes& planes, const Number* tile, Number* grid) {
    const size_t h = planes.h, row = 3 * h, low_row = row + 3, width = 3 * (2 * h + 1);
    for (size_t r = 0; r <= h; ++r) {
        interleave(h + 1, h, tile + r * low_row, tile + planes.horizontal() + r * row, grid + 2 * r * width);
        if (r < h)
            interleave(h + 1, h, tile + planes.vertical() + r * low_row, tile + planes.diagonal() + r * row,
                       grid + (2 * r + 1) * width);
    }
}

void scale(float* values, size_t count, float factor) {
    for (size_t i = 0; i < count; ++i) values[i] = values[i] * factor;
}

// Decodes from the base up to the level asked for, stream by stream. Samples are integers if the arithmetic is, else
// floats.
class TileDecoder {
  public:
    TileDecoder(const TileCoding& coding, uint32_t level, TileWorkspace& ws)
        : shape_(coding.shape),
          coding_(coding.details),
          middle_(coding.middle),
          arithmetic_(coding.arithmetic),
          steps_(coding.shape.exponent),
          level_(level),
          ws_(ws) {
        new (ws.models) BandModels(coding.kind);
    }

    // Decodes the stream of a level. The coarsest level comes first.
    bool decode(RangeDecoder& coder, uint32_t to_level) {
        if (done_ == 0 && !decode_base(coder)) return false;
        while (done_ < steps_ - to_level) {
            if (!decode_step(coder, ++done_)) return false;
        }
        return true;
    }

  private:
    // Those of the level asked for are in slot 0.
    uint32_t slot(uint32_t step) const { return (steps_ - level_ - step) & 1; }
    Number* samples(uint32_t step) const { return static_cast<Number*>(ws_.samples[slot(step)]); }
    static size_t samples_after(uint32_t step) { return TilePlanes(1u << step).size(); }

    bool decode_base(RangeDecoder& coder) {
        const QuadComplex& complex = ws_.complex;
        BaseCoder<RangeDecoder> base_coder(&coder, ws_.models);
        if (!base_coder.code(complex, ws_.base)) return false;
        const float step = tile_base_step(shape_, coding_.quantizer);
        const TilePlanes planes(1);
        for (uint32_t h = 0; h < complex.half_edges(); ++h) {
            auto* to = samples(0) + tile_of(h) * planes.size() + planes.sides[side_of(h)].low.at(0);
            const int32_t* value = ws_.base + 3 * size_t{complex.vertex[h]};
            for (size_t k = 0; k < 3; ++k) to[k] = number_of(value[k], step);
        }
        return true;
    }

    // From the small images in the planes of this step to those of the next, or to the level asked for.
    bool decode_step(RangeDecoder& coder, uint32_t step) {
        const QuadComplex& complex = ws_.complex;
        const TilePlanes planes(1u << (step - 1));
        int32_t* details = ws_.details[slot(step)];
        std::fill_n(details, complex.tiles * planes.details(), 0);
        TileCoder<RangeDecoder> tile_coder(&coder, ws_.models, ws_.band_work);
        if (!tile_coder.code_step(complex, planes, details, step > 1 ? ws_.details[slot(step - 1)] : nullptr,
                                  ws_.flags))
            return false;
        void* from = ws_.samples[slot(step - 1)];
        const DetailSteps detail_steps = tile_steps_at(shape_, coding_, steps_ - step + 1);
        if (arithmetic_.is_integer()) {
            load_tile_details(complex, planes, details, static_cast<int32_t*>(from));
        } else {
            auto* floats = static_cast<float*>(from);
            TileDetails(complex, planes, detail_steps, floats).load(details);
            for (uint32_t t = 0; t < complex.tiles && arithmetic_.low_gain != 1; ++t)
                scale(floats + t * planes.size(), static_cast<size_t>(planes.horizontal()), arithmetic_.low_gain);
        }
        TileSteps(arithmetic_, complex, planes, from, ws_.sums).synthesize();
        const bool is_last = step == steps_ - level_;
        const size_t stride = is_last ? planes.size() : samples_after(step);
        for (uint32_t t = 0; t < complex.tiles; ++t)
            join_rows(planes, samples(step - 1) + t * planes.size(), samples(step) + t * stride);
        return true;
    }

    // A number of the base as a sample, as its bits.
    Number number_of(int32_t value, float step) const {
        if (arithmetic_.is_integer()) return static_cast<uint32_t>(value) + static_cast<uint32_t>(middle_);
        return std::bit_cast<uint32_t>(static_cast<float>(value) * step + static_cast<float>(middle_));
    }

    const TileShape& shape_;
    DetailCoding coding_;
    int32_t middle_;
    const TileArithmetic& arithmetic_;
    uint32_t steps_, level_;
    TileWorkspace& ws_;
    uint32_t done_ = 0;
};

const TileArithmetic& arithmetic_of(const Header& header) {
    if (header.coding == Coding::kLossless) return kTiles53;
    return header.tiles.is_sharp ? kTilesSharp : kTiles97;
}

Status decode_levels(const Header& header, std::span<const uint8_t> file, uint32_t level, TileWorkspace& ws) {
    TileDecoder decoder(
        {header.tiles, detail_coding_of(header), tile_kind_of(header), 1 << (header.bits - 1), arithmetic_of(header)},
        level, ws);
    for (uint32_t l = header.level_count; l-- > level;) {
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload;
        if (Status s = find_level_chunk(header, l, &chunk, &offset); s != Status::kOk) return s;
        if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
        RangeDecoder coder(payload);
        if (!decoder.decode(coder, l) || !coder.intact()) return Status::kMalformed;
    }
    return Status::kOk;
}

}  // namespace

TileWorkspace lay_out_complex(const TileShape& shape, Arena* arena) {
    const size_t half_edges = size_t{4} * shape.tiles;
    TileWorkspace ws;
    QuadComplex& c = ws.complex;
    for (uint32_t** array : {&c.mate, &c.vertex, &c.edge, &c.lower, &c.valence, &ws.quad_code.next,
                             &ws.quad_code.previous, &ws.quad_code.fan})
        *array = arena->take<uint32_t>(half_edges);
    c.on_boundary = arena->take<uint8_t>(half_edges);
    return ws;
}

TileWorkspace lay_out_tiles(const TileShape& shape, uint32_t level, Arena* arena) {
    const uint32_t h = shape.intervals(level) / 2;
    const TilePlanes planes(h), before(h / 2);  // `before` is empty where h is 1
    TileWorkspace ws = lay_out_complex(shape, arena);
    ws.models = arena->take<BandModels>(1);
    ws.band_work = BandWork(arena->take<uint32_t>(BandWork::size(2 * h + 1)), 2 * h + 1);
    ws.flags = arena->take<TileFlags>(shape.tiles);
    ws.base = arena->take<int32_t>(size_t{3} * shape.vertices);
    ws.sums = arena->take<int64_t>(size_t{6} * shape.vertices);
    ws.details[0] = arena->take<int32_t>(shape.tiles * planes.details());
    ws.details[1] = arena->take<int32_t>(shape.tiles * before.details());
    // A step begins with the planes that it ends with.
    ws.samples[0] = arena->take<float>(shape.tiles * planes.size());
    ws.samples[1] = arena->take<float>(shape.tiles * planes.size());
    return ws;
}

Status read_complex(const Header& header, std::span<const uint8_t> file, TileWorkspace& ws) {
    std::span<const uint8_t> payload;
    if (Status s = read_seam_payload(header, file, &payload); s != Status::kOk) return s;
    RangeDecoder coder(payload);
    ws.complex.tiles = header.tiles.tiles;
    NoSource source;
    if (!code_tile_seams(coder, source, header.tiles, ws.quad_code, &ws.complex)) return Status::kMalformed;
    if (header.tiles.has_sharp_edges) ws.is_sharp = ws.quad_code.fan;
    const bool as_told = ws.complex.vertices == header.tiles.vertices && ws.complex.edges == header.tiles.edges();
    return as_told && coder.intact() ? Status::kOk : Status::kMalformed;
}

Status decode_tiles(const Header& header, std::span<const uint8_t> file, uint32_t level, TileWorkspace& ws,
                    float** samples) {
    if (Status s = read_complex(header, file, ws); s != Status::kOk) return s;
    if (Status s = decode_levels(header, file, level, ws); s != Status::kOk) return s;
    const size_t side = header.tiles.intervals(level) + 1;
    *samples = to_units(header.coding == Coding::kLossless, ws.samples[0], ws.complex.tiles * side * side * 3);
    return Status::kOk;
}

Status decode_tile_samples(const TileShape& shape, const PlaneChunk& plane, uint32_t level, TileWorkspace& ws,
                           float** samples) {
    TileDecoder decoder({shape, {plane.quantizer}, CoefficientKind::kPlanes, 0, kTiles97}, level, ws);
    RangeDecoder coder(plane.stream);
    if (!decoder.decode(coder, level) || !coder.intact()) return Status::kMalformed;
    const size_t side = shape.intervals(level) + 1;
    *samples = to_units(false, ws.samples[0], ws.complex.tiles * side * side * 3);
    return Status::kOk;
}

}  // namespace gim
