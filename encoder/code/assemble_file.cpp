#include "encoder/code/assemble_file.h"

#include <zstd.h>

#include <algorithm>
#include <utility>

#include "format/checksum.h"

namespace gim {
namespace {

struct Payload {
    Chunk chunk;
    std::vector<uint8_t> bytes;
};

Payload make_payload(ChunkType type, bool optional, std::vector<uint8_t> bytes) {
    Payload p;
    p.chunk.type = type;
    p.chunk.optional = optional;
    p.chunk.size = p.chunk.raw_size = bytes.size();
    p.chunk.crc = crc16(bytes);
    p.bytes = std::move(bytes);
    return p;
}

// Compresses the text if that makes it smaller.
Payload make_text_payload(const std::string& text) {
    std::vector<uint8_t> raw(text.begin(), text.end());
    std::vector<uint8_t> packed(ZSTD_compressBound(raw.size()));
    const size_t size = ZSTD_compress(packed.data(), packed.size(), raw.data(), raw.size(), 19);
    if (ZSTD_isError(size) || size + 2 >= raw.size()) return make_payload(ChunkType::kText, true, std::move(raw));
    packed.resize(size);
    Payload p = make_payload(ChunkType::kText, true, std::move(packed));
    p.chunk.zstd = true;
    p.chunk.raw_size = raw.size();
    return p;
}

std::vector<uint8_t> join(const Header& header, const std::vector<Payload>& payloads) {
    std::vector<Chunk> chunks;
    for (const Payload& p : payloads) chunks.push_back(p.chunk);
    std::vector<uint8_t> file = serialize_header(header, chunks);
    for (const Payload& p : payloads) file.insert(file.end(), p.bytes.begin(), p.bytes.end());
    return file;
}

// Returns the file with its header changed by change(header). Returns it unchanged if that returns false.
template <class Change>
std::vector<uint8_t> with_header(std::span<const uint8_t> file, const Change& change) {
    std::vector<uint8_t> changed(file.begin(), file.end());
    Header header;
    if (parse_header(file, kNoLimits, &header) != Status::kOk || !change(header)) return changed;
    std::vector<Chunk> chunks;
    ChunkWalk walk(header);
    Chunk chunk;
    for (uint64_t offset = 0; walk.next(&chunk, &offset);) chunks.push_back(chunk);
    const std::vector<uint8_t> head = serialize_header(header, chunks);
    std::copy(head.begin(), head.end(), changed.begin());
    return changed;
}

}  // namespace

std::vector<uint8_t> assemble_file(const Header& header, std::span<const uint8_t> seams,
                                   std::span<const std::vector<uint8_t>> levels, std::span<const CodedPlane> planes,
                                   const std::string& text) {
    std::vector<Payload> payloads;
    payloads.push_back(make_payload(ChunkType::kSeams, false, {seams.begin(), seams.end()}));
    for (const auto& level : levels) payloads.push_back(make_payload(ChunkType::kLevel, false, level));
    for (const CodedPlane& plane : planes) payloads.push_back(make_payload(plane.type, true, plane.payload));
    if (!text.empty()) payloads.push_back(make_text_payload(text));

    return join(header, payloads);
}

std::vector<uint8_t> replace_planes(std::span<const uint8_t> file, std::span<const CodedPlane> planes) {
    Header header;
    if (parse_header(file, kNoLimits, &header) != Status::kOk) return {file.begin(), file.end()};
    std::vector<Payload> payloads;
    std::vector<bool> is_placed(planes.size(), false);
    ChunkWalk walk(header);
    Chunk chunk;
    for (uint64_t offset = 0; walk.next(&chunk, &offset);) {
        const auto plane =
            std::find_if(planes.begin(), planes.end(), [&](const CodedPlane& p) { return p.type == chunk.type; });
        if (plane != planes.end()) {
            payloads.push_back(make_payload(plane->type, true, plane->payload));
            is_placed[static_cast<size_t>(plane - planes.begin())] = true;
            continue;
        }
        const auto begin = file.begin() + static_cast<ptrdiff_t>(offset);
        payloads.push_back({chunk, {begin, begin + static_cast<ptrdiff_t>(chunk.size)}});
    }
    for (size_t i = 0; i < planes.size(); ++i) {
        if (!is_placed[i]) payloads.push_back(make_payload(planes[i].type, true, planes[i].payload));
    }
    return join(header, payloads);
}

std::vector<uint8_t> set_level_errors(std::span<const uint8_t> file, std::span<const LevelError> errors) {
    std::vector<uint8_t> coded;
    return with_header(file, [&](Header& header) {
        for (size_t k = errors.size(); k-- > 0;) {
            for (const double error : {errors[k].rms, errors[k].max})
                coded.push_back(error < 0 ? uint8_t{0} : error_code_of(error, header));
        }
        if (header.level_errors.size() != coded.size()) return false;
        header.level_errors = coded;
        return true;
    });
}

std::vector<uint8_t> set_boxes(std::span<const uint8_t> file, std::span<const Box> boxes) {
    std::vector<uint8_t> coded;
    return with_header(file, [&](Header& header) {
        if (header.boxes.size() != kBoxSize * boxes.size()) return false;
        for (const Box& box : boxes) {
            const BoxNumbers numbers = box_around(box, header);
            append_box(numbers, &coded);
            if (numbers.is_told()) continue;
            coded.assign(header.boxes.size(), 0);
            break;
        }
        header.boxes = coded;
        return true;
    });
}

std::vector<uint8_t> move_origin(std::span<const uint8_t> file, const std::array<double, 3>& by) {
    return with_header(file, [&](Header& header) {
        if (!header.wide_origin) return false;
        for (size_t k = 0; k < 3; ++k) (*header.wide_origin)[k] += by[k];
        return true;
    });
}

}  // namespace gim
