// Streams -> bands -> inverse wavelet: the part of decoding that positions and attribute planes share.
#pragma once

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>
#include <span>
#include <type_traits>

#include "decoder/pyramid/arena.h"
#include "decoder/pyramid/band_decoder.h"
#include "decoder/pyramid/synthesis.h"
#include "format/status.h"

namespace gim {

// Memory for one pyramid, laid out in the caller's scratch.
struct PyramidWorkspace {
    BandModels* models = nullptr;  // to be constructed before the first stream
    BandWork band_work;
    int32_t* bands[2] = {};  // of the level being decoded and of its parent, in turn
    void* images[2] = {};    // int32_t or float triples, in turn; the requested level ends in images[0]
    void* synthesis = nullptr;
    uint32_t* rim = nullptr;  // ring_length(side) numbers where a shape has seams
};

// Takes bands and images. columns, rows: of the requested level. The rest is shared by the charts of an image.
void lay_out_samples(uint32_t columns, uint32_t rows, Arena* arena, PyramidWorkspace* ws);
// Takes models, band_work and synthesis. columns: of the widest level.
void lay_out_coder(uint32_t columns, Arena* arena, PyramidWorkspace* ws);

struct PyramidShape {
    uint32_t columns = 2, rows = 2;    // at full resolution
    uint32_t steps = 0;                // from the base to full resolution
    uint32_t level = 0;                // the requested one: that many steps are left out
    DetailCoding details;              // 9/7 only
    int32_t middle = 0;                // what base samples are stored relative to
    bool chained_base = false;         // a base value is stored relative to the one before it
    const SeamTable* seams = nullptr;  // only of a square whose mates share details
};

// Places the three bands of one image in one array.
inline LevelBands bands_in(int32_t* memory, uint32_t columns, uint32_t rows) {
    LevelBands bands;
    bands.horizontal = {memory, low_count(rows), high_count(columns)};
    bands.vertical = {bands.horizontal.values + bands.horizontal.count(), high_count(rows), low_count(columns)};
    bands.diagonal = {bands.vertical.values + bands.vertical.count(), high_count(rows), high_count(columns)};
    return bands;
}

// Decodes from the base up to the requested level.
class PyramidDecoder {
  public:
    // integers: 5/3, else 9/7. done: steps that an earlier decoder of this shape has done in this memory.
    PyramidDecoder(bool integers, const PyramidShape& shape, const PyramidWorkspace& ws, uint32_t done = 0)
        : lifting_(integers), shape_(shape), ws_(ws), done_(done), started_(done > 0) {}

    // Decodes up to a level (0: full resolution), from where the last call stopped. Returns false on invalid values.
    bool advance(BandDecoder& coder, uint32_t to_level) {
        if (!started_ && !decode_base(coder)) return false;
        started_ = true;
        while (done_ < shape_.steps - to_level) {
            if (!decode_step(coder, ++done_)) return false;
        }
        return true;
    }

  private:
    // Size of the image that the first `step` steps lead to.
    uint32_t columns_at(uint32_t step) const { return halved(shape_.columns, shape_.steps - step); }
    uint32_t rows_at(uint32_t step) const { return halved(shape_.rows, shape_.steps - step); }

    // Images and bands alternate between two slots. Those of the requested level are in slot 0.
    uint32_t slot(uint32_t step) const { return (shape_.steps - shape_.level - step) & 1; }
    Number* image(uint32_t step) const { return static_cast<Number*>(ws_.images[slot(step)]); }

    bool decode_base(BandDecoder& coder) {
        const Band base = {ws_.bands[slot(0)], rows_at(0), columns_at(0)};
        if (!coder.code_base(base)) return false;
        if (shape_.chained_base) {
            for (size_t i = 3; i < base.count(); ++i) {
                base.values[i] = static_cast<int32_t>(static_cast<uint32_t>(base.values[i]) +
                                                      static_cast<uint32_t>(base.values[i - 3]));
            }
        }
        const float step = low_band_step(shape_.details.quantizer, shape_.steps);
        for (size_t i = 0; i < base.count(); ++i) image(0)[i] = base_number(base.values[i], step);
        return true;
    }

    // A number of the base image.
    Number base_number(int32_t value, float step) const {
        if (lifting_.integers()) return static_cast<uint32_t>(value) + static_cast<uint32_t>(shape_.middle);
        return std::bit_cast<uint32_t>(static_cast<float>(value) * step + static_cast<float>(shape_.middle));
    }

    bool decode_step(BandDecoder& coder, uint32_t step) {
        const uint32_t columns = columns_at(step), rows = rows_at(step);
        const LevelBands bands = bands_in(ws_.bands[slot(step)], columns, rows);
        LevelBands parents;
        const bool has_parents = step > 1;
        if (has_parents) parents = bands_in(ws_.bands[slot(step - 1)], columns_at(step - 1), rows_at(step - 1));
        SharedRim rim;
        if (shape_.seams) {
            rim_sources(*shape_.seams, columns, {ws_.rim, ring_length(columns)});
            rim = {ws_.rim, columns};
        }
        if (!coder.code_level(bands, has_parents ? &parents : nullptr, rim)) return false;
        DetailSteps steps;
        if (!lifting_.integers()) steps = shape_.details.steps_at(shape_.steps - step + 1);
        synthesize(lifting_, columns, rows, image(step - 1), bands, steps, static_cast<Number*>(ws_.synthesis),
                   image(step), rim);
        return true;
    }

    RowLifting lifting_;
    PyramidShape shape_;
    const PyramidWorkspace& ws_;
    uint32_t done_;  // steps that are done
    bool started_;   // the base is decoded
};

// Decodes one stream of an image that has streams of its own.
inline Status decode_stream(PyramidDecoder& decoder, const PyramidWorkspace& ws, std::span<const uint8_t> stream,
                            uint32_t to_level) {
    RangeDecoder coder(stream);
    BandDecoder band_coder(&coder, ws.models, ws.band_work);
    return decoder.advance(band_coder, to_level) && coder.intact() ? Status::kOk : Status::kMalformed;
}

}  // namespace gim
