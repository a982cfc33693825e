#include "decoder/image_decoder.h"

#include <algorithm>
#include <cstring>
#include <new>

#include "decoder/range_decoder.h"
#include "format/sideband_code.h"

namespace gim {
namespace {

constexpr float kLargestUnit = 0x1p22f;  // writers stay well below; keeps all later arithmetic finite

// Places the three bands of the level of side 2h+1 in one array.
LevelBands bands_in(int32_t* memory, uint32_t h) {
    LevelBands bands;
    bands.horizontal = {memory, h + 1, h};
    bands.vertical = {bands.horizontal.values + bands.horizontal.count(), h, h + 1};
    bands.diagonal = {bands.vertical.values + bands.vertical.count(), h, h};
    return bands;
}

size_t band_count(uint32_t side) {
    const size_t n = side, low = side / 2 + 1;
    return (n * n - low * low) * 3;
}

// The part of a level chunk that belongs to one image.
Status image_stream(const Header& header, std::span<const uint8_t> payload, uint32_t image, uint32_t level,
                    std::span<const uint8_t>* stream) {
    if (header.image_count() == 1) {
        *stream = payload;
        return Status::kOk;
    }
    ByteReader reader(payload);
    uint64_t offset = 0, size = 0, total = 0;
    for (uint32_t i = 0; i < header.image_count(); ++i) {
        if (level >= header.level_count_of(i)) continue;
        uint64_t one = 0;
        if (!reader.read_leb128(&one)) return Status::kMalformed;
        if (i == image) {
            offset = total;
            size = one;
        }
        total += one;
    }
    if (total != reader.left()) return Status::kMalformed;
    *stream = payload.subspan(reader.position() + static_cast<size_t>(offset), static_cast<size_t>(size));
    return Status::kOk;
}

// Decodes the streams from the coarsest level down to the requested one.
template <class Wavelet>
class PyramidDecoder {
  public:
    using Sample = typename Wavelet::Sample;

    PyramidDecoder(const Header& header, const ImageWorkspace& ws, uint32_t image, uint32_t level)
        : header_(header), ws_(ws), exponent_(header.side_exponents[image]), level_(level) {
        new (ws_.models) BandModels();
    }

    // One level's stream; the coarsest one begins with the 2x2 base and has several steps.
    Status decode_stream(std::span<const uint8_t> stream, uint32_t stream_level) {
        RangeDecoder coder(stream);
        BandCoder<RangeDecoder> band_coder(&coder, ws_.models, ws_.band_work);
        const uint32_t stream_exponent = exponent_ - stream_level;
        if (done_ == 0) decode_base(band_coder);
        while (ok_ && done_ < stream_exponent) decode_step(band_coder, ++done_);
        return ok_ && coder.intact() ? Status::kOk : Status::kMalformed;
    }

  private:
    // Images and bands alternate so that the last ones of the requested level fall on slot 0.
    uint32_t slot(uint32_t exponent) const { return (exponent_ - level_ - exponent) & 1; }
    Sample* image(uint32_t exponent) const { return static_cast<Sample*>(ws_.images[slot(exponent)]); }

    void decode_base(BandCoder<RangeDecoder>& coder) {
        const Band base = {ws_.bands[slot(0)], 2, 2};
        ok_ = coder.code_base(base);
        Sample* values = image(0);
        const float step = header_.coding == Coding::kLossy ? low_band_step(header_.quantizer, exponent_) : 0;
        const int32_t middle = 1 << (header_.bits - 1);
        for (size_t i = 0; i < base.count(); ++i) {
            if constexpr (Wavelet::kSteps == 2) {
                values[i] = base.values[i] + middle;
            } else {
                values[i] = static_cast<float>(base.values[i]) * step + static_cast<float>(middle);
            }
        }
    }

    void decode_step(BandCoder<RangeDecoder>& coder, uint32_t exponent) {
        const uint32_t h = 1u << (exponent - 1);
        const LevelBands bands = bands_in(ws_.bands[slot(exponent)], h);
        LevelBands parents;
        const bool has_parents = exponent > 1;
        if (has_parents) parents = bands_in(ws_.bands[slot(exponent - 1)], h / 2);
        ok_ = coder.code_level(bands, has_parents ? &parents : nullptr);
        if (!ok_) return;
        BandSteps steps;
        if (header_.coding == Coding::kLossy) {
            const uint32_t depth = exponent_ - exponent + 1;
            steps.edge = band_step(header_.quantizer, depth, Orientation::kHorizontal);
            steps.diagonal = band_step(header_.quantizer, depth, Orientation::kDiagonal);
        }
        synthesize<Wavelet>(2 * h + 1, image(exponent - 1), bands, steps, static_cast<Sample*>(ws_.synthesis),
                            image(exponent));
    }

    const Header& header_;
    const ImageWorkspace& ws_;
    uint32_t exponent_, level_;
    uint32_t done_ = 0;  // exponent of the finest side that is there
    bool ok_ = true;
};

// Integers or floats in place to bounded floats. By memcpy: the two types share the memory.
template <class Sample>
float* to_units(void* memory, size_t count) {
    auto* bytes = static_cast<std::byte*>(memory);
    constexpr size_t kBlock = 256;
    Sample from[kBlock];
    float to[kBlock];
    for (size_t i = 0; i < count; i += kBlock) {
        const size_t n = std::min(kBlock, count - i);
        std::memcpy(from, bytes + i * 4, n * 4);
        for (size_t k = 0; k < n; ++k)
            to[k] = std::min(std::max(static_cast<float>(from[k]), -kLargestUnit), kLargestUnit);
        std::memcpy(bytes + i * 4, to, n * 4);
    }
    return static_cast<float*>(memory);
}

template <class Wavelet>
Status decode_pyramid(const Header& header, std::span<const uint8_t> file, uint32_t image, uint32_t level,
                      const ImageWorkspace& ws, float** samples) {
    PyramidDecoder<Wavelet> decoder(header, ws, image, level);
    for (uint32_t l = header.level_count_of(image); l-- > level;) {
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload, stream;
        if (Status s = find_level_chunk(header, l, &chunk, &offset); s != Status::kOk) return s;
        if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
        if (Status s = image_stream(header, payload, image, l, &stream); s != Status::kOk) return s;
        if (Status s = decoder.decode_stream(stream, l); s != Status::kOk) return s;
    }
    const size_t side = size_t{(header.side(image) - 1) >> level} + 1;
    *samples = to_units<typename Wavelet::Sample>(ws.images[0], side * side * 3);
    return Status::kOk;
}

}  // namespace

ImageWorkspace lay_out(uint32_t side, Arena* arena) {
    const size_t samples = size_t{side} * side * 3;
    const uint32_t half = side / 2 + 1;
    const size_t half_samples = size_t{half} * half * 3;
    const size_t ring = ring_length(side);
    ImageWorkspace ws;
    ws.models = arena->take<BandModels>(1);
    ws.band_work.above = arena->take<int32_t>(BandWork::row_size(half));
    ws.band_work.current = arena->take<int32_t>(BandWork::row_size(half));
    ws.band_work.expected = arena->take<uint32_t>(BandWork::row_size(half));
    ws.band_work.full_above = arena->take<uint8_t>(BandWork::block_size(half));
    ws.bands[0] = arena->take<int32_t>(std::max<size_t>(band_count(side), 12));
    ws.bands[1] = arena->take<int32_t>(std::max<size_t>(band_count(half), 12));
    ws.images[0] = arena->take<float>(samples);
    ws.images[1] = arena->take<float>(half_samples);
    ws.synthesis = arena->take<float>(synthesis_work_size(side));
    ws.class_of = arena->take<uint32_t>(ring);
    ws.fuse.sums = arena->take<float>(ring * 3);
    ws.fuse.first = arena->take<uint32_t>(ring);
    ws.fuse.members = arena->take<uint32_t>(ring);
    ws.fuse.outer = arena->take<float>(ring * 3);
    ws.fuse.inner = arena->take<float>(ring * 3);
    ws.row_ids = arena->take<uint32_t>(size_t{side} * 2);
    // The bands are done with when normals are computed, but hold a little less.
    ws.normals = arena->take<float>(samples);
    return ws;
}

Status decode_level(const Header& header, std::span<const uint8_t> file, uint32_t image, uint32_t level,
                    const SeamTable& seams, const ImageWorkspace& ws, float** samples) {
    const Status status = header.coding == Coding::kLossless
                              ? decode_pyramid<Reversible53>(header, file, image, level, ws, samples)
                              : decode_pyramid<Irreversible97>(header, file, image, level, ws, samples);
    if (status != Status::kOk) return status;
    const uint32_t side = ((header.side(image) - 1) >> level) + 1;
    ring_classes(seams, side, {ws.class_of, ring_length(side)});
    fuse(side, ws.class_of, ring_class_count(seams, side), *samples, ws.fuse);
    return Status::kOk;
}

Status read_seams(const Header& header, std::span<const uint8_t> file, uint32_t image, SeamTable* seams) {
    ChunkWalk walk(header);
    Chunk chunk;
    uint64_t offset = 0;
    while (walk.next(&chunk, &offset)) {
        if (chunk.type == ChunkType::kSeams) break;
    }
    std::span<const uint8_t> payload;
    if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
    for (uint32_t i = 0;; ++i) {
        std::array<CutPath, kMaxCutPaths> paths;
        ParsedSideband parsed;
        if (Status s = parse_sideband(payload, paths, &parsed); s != Status::kOk) return s;
        payload = payload.subspan(parsed.size);
        if (i + 1 == header.image_count() && !payload.empty()) return Status::kMalformed;
        if (i < image) continue;
        if (Status s =
                build_seam_table(parsed.node_side, parsed.start, std::span(paths).first(parsed.path_count), seams);
            s != Status::kOk)
            return s;
        return level_is_closed(*seams, header.side(image)) ? Status::kOk : Status::kMalformed;
    }
}

Status find_level_chunk(const Header& header, uint32_t level, Chunk* chunk, uint64_t* offset) {
    ChunkWalk walk(header);
    uint32_t next = header.level_count;
    while (walk.next(chunk, offset)) {
        if (chunk->type == ChunkType::kLevel && --next == level) return Status::kOk;
    }
    return Status::kMalformed;
}

}  // namespace gim
