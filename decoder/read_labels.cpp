// Labels of cells of the C interface.  spec/gim-format.md, "Labels".
#include <algorithm>

#include "decoder/layout/level_reader.h"
#include "decoder/pyramid/range_decoder.h"
#include "decoder/with_image.h"
#include "format/label_code.h"
#include "format/stream_table.h"
#include "gim/decoder.h"

namespace gim {
namespace {

// Reads the chunk of labels, and the level that they are asked for.
struct OpenLabels {
    Chunk chunk;
    uint64_t offset = 0;
    LabelSquares squares{};
    uint32_t cells = 0;  // of the level

    Status open(const LevelReader& reader, const LevelRequest& request) {
        if (!find_chunk(request.header, ChunkType::kLabels, &chunk, &offset)) return Status::kNoSuchPlane;
        gim_level_info level;
        if (Status s = reader.level_info(request, &level); s != Status::kOk) return s;
        cells = level.triangle_count / 2;
        squares = label_squares(request.header, request.image);
        // A file that was cut may be small while its labels are many.
        return squares.cells() > request.limits.max_samples ? Status::kLimitExceeded : Status::kOk;
    }
};

// The label of a coarse cell is that of the finest cell behind its middle.
void decode(std::span<const uint8_t> stream, const LabelSquares& squares, uint32_t level, uint8_t* row,
            uint8_t* labels) {
    RangeDecoder decoder(stream);
    const uint32_t step = 1u << level, middle = step / 2;
    const auto nothing = [](uint32_t, uint32_t) -> const uint8_t* { return nullptr; };
    code_labels(decoder, squares, row, nothing, [&](uint32_t, uint32_t r) {
        if (r % step != middle) return;
        for (uint32_t c = middle; c < squares.side; c += step) *labels++ = row[c];
    });
}

}  // namespace
}  // namespace gim

using namespace gim;

gim_status gim_read_labels_info(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                                gim_labels_info* labels_info) {
    if (!labels_info) return GIM_BAD_ARGUMENT;
    return with_level(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        OpenLabels labels;
        if (Status s = labels.open(reader, request); s != Status::kOk) return s;
        *labels_info = {labels.cells, labels.squares.side, labels.offset + labels.chunk.size};
        return Status::kOk;
    });
}

gim_status gim_decode_labels(const gim_info* info, const void* bytes, size_t size, uint32_t image, uint32_t level,
                             uint8_t* values, void* scratch, size_t scratch_size) {
    if (!values) return GIM_BAD_ARGUMENT;
    return with_level(info, bytes, size, image, level, [&](const LevelReader& reader, const LevelRequest& request) {
        OpenLabels labels;
        std::span<const uint8_t> payload, stream;
        if (Status s = labels.open(reader, request); s != Status::kOk) return s;
        if (!scratch) return Status::kBadArgument;
        if (scratch_size < labels.squares.side) return Status::kScratchTooSmall;
        if (Status s = read_payload(request.file, labels.chunk, labels.offset, &payload); s != Status::kOk) return s;
        if (Status s = find_stream(payload, request.header.image_count(), request.image, &stream); s != Status::kOk)
            return s;
        decode(stream, labels.squares, request.level, static_cast<uint8_t*>(scratch), values);
        return Status::kOk;
    });
}
