// Takes a file apart into its chunks, and puts those that are kept together again.
#include "gim/cut.h"

#include <algorithm>
#include <string>

#include "encoder/base/guarded.h"
#include "encoder/code/assemble_file.h"
#include "encoder/code/decode_surface.h"

namespace gim {
namespace {

Error wrong(const std::string& message) { return {Stage::kInput, message}; }

bool is_dropped(ChunkType type, uint32_t level, const CutOptions& options) {
    switch (type) {
        case ChunkType::kNormals:
            return options.drop_normals;
        case ChunkType::kColors:
            return options.drop_colors;
        case ChunkType::kDisplacements:
            return options.drop_displacements || level > 0;
        case ChunkType::kLabels:
            return options.drop_labels;
        case ChunkType::kText:
            return options.drop_text;
        default:
            return false;
    }
}

// Returns the coarsest level that all images have.
Result<uint32_t> last_common_level(std::span<const uint8_t> file, uint32_t image_count) {
    Decoder decoder;
    gim_status status = open_own_file(file, &decoder);
    uint32_t last = GIM_MAX_LEVELS;
    for (uint32_t image = 0; status == GIM_OK && image < image_count; ++image) {
        DecoderLevel level;
        status = decoder.read_level(image, 0, &level);
        last = std::min(last, level.coarsest_level);
    }
    if (status != GIM_OK) return wrong(gim_status_text(status));
    return last;
}

// The file from `level` on. Chunks that are not kept need not be there.
class Cut {
  public:
    Cut(std::span<const uint8_t> file, const Header& header, uint32_t level, const CutOptions& options)
        : file_(file), header_(header) {
        header_.cut_levels += level;
        if (!header.level_errors.empty())
            header_.level_errors = header.level_errors.first(kErrorsOfLevel * header_.kept_levels());
        Chunk chunk;
        uint32_t levels = 0;
        ChunkWalk walk(header);
        for (uint64_t offset = 0; walk.next(&chunk, &offset);) {
            if (chunk.type == ChunkType::kLevel && ++levels > header_.kept_levels()) continue;
            if (is_dropped(chunk.type, level, options)) continue;
            chunks_.push_back(chunk);
            offsets_.push_back(offset);
        }
    }

    uint64_t size() const {
        uint64_t sum = serialize_header(header_, chunks_).size();
        for (const Chunk& chunk : chunks_) sum += chunk.size;
        return sum;
    }

    Result<std::vector<uint8_t>> bytes() const {
        std::vector<uint8_t> out = serialize_header(header_, chunks_);
        for (size_t i = 0; i < chunks_.size(); ++i) {
            std::span<const uint8_t> payload;
            const Status status = read_payload(file_, chunks_[i], offsets_[i], &payload);
            if (status != Status::kOk) return wrong(gim_status_text(static_cast<gim_status>(status)));
            out.insert(out.end(), payload.begin(), payload.end());
        }
        return out;
    }

  private:
    std::span<const uint8_t> file_;
    Header header_;
    std::vector<Chunk> chunks_;
    std::vector<uint64_t> offsets_;
};

Result<CutFile> cut_parsed(std::span<const uint8_t> file, const Header& header, const CutOptions& options) {
    GIM_TRY(last, last_common_level(file, header.image_count()));
    if (options.level > last)
        return wrong("level " + std::to_string(options.level) +
                     " is not there in all images; the coarsest common one is " + std::to_string(last));
    uint32_t level = options.level;
    while (options.most_bytes && level < last && Cut(file, header, level, options).size() > *options.most_bytes)
        ++level;
    const Cut chosen(file, header, level, options);
    if (options.most_bytes && chosen.size() > *options.most_bytes)
        return wrong("the coarsest level, " + std::to_string(level) + ", needs " + std::to_string(chosen.size()) +
                     " bytes; allow so many, or drop planes and text");
    GIM_TRY(bytes, chosen.bytes());
    return CutFile{std::move(bytes), level};
}

}  // namespace

Result<CutFile> cut(std::span<const uint8_t> file, const CutOptions& options) {
    return guarded(1, [&]() -> Result<CutFile> {
        Header header;
        const Status status = parse_header(file, kNoLimits, &header);
        if (status != Status::kOk) return wrong(gim_status_text(static_cast<gim_status>(status)));
        return cut_parsed(file, header, options);
    });
}

}  // namespace gim
