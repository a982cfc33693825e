#include "format/container.h"

#include <algorithm>
#include <cmath>

#include "format/bounds.h"
#include "format/checksum.h"
#include "format/quad_complex.h"
#include "format/seam.h"
#include "format/tile_atlas.h"

namespace gim {
namespace {

constexpr size_t kPreambleSize = kMagic.size() + 1;  // magic and version
constexpr size_t kCrcSize = 4;
constexpr uint8_t kLossyFlag = 0x04, kBoundsFlag = 0x08, kWideOriginFlag = 0x10, kCutFlag = 0x20, kReservedFlags = 0x80,
                  kLayoutMask = 0x43;
constexpr uint8_t kTileExponentMask = 0x0F, kSharpWaveletFlag = 0x10, kSharpEdgesFlag = 0x20, kReservedTileFlags = 0xC0;

bool parse_chunk(ByteReader* reader, Chunk* chunk) {
    uint64_t tag = 0;
    if (!reader->read_leb128(&tag) || tag > UINT32_MAX || !reader->read_leb128(&chunk->size)) return false;
    chunk->optional = tag & 1;
    chunk->zstd = tag & 2;
    chunk->type = static_cast<ChunkType>(tag >> 2);
    chunk->raw_size = chunk->size;
    if (chunk->zstd && !reader->read_leb128(&chunk->raw_size)) return false;
    return reader->read_u16(&chunk->crc);
}

template <class Real>
bool in_range(Real value, Real low, Real high) {
    return value >= low && value <= high;
}  // false for a NaN

// Checks the chunks: SEAM once, then kept_levels() times LEVL, then each kind of plane, and labels, at most once. META may
// stand anywhere, but once; unknown optional chunks may stand anywhere.
Status check_index(Header* header) {
    ByteReader reader(header->index);
    uint32_t seams = 0, levels = 0, texts = 0, planes_seen = 0;
    header->file_size = header->index_size;
    header->chunk_count = 0;
    while (reader.left() > 0) {
        Chunk chunk;
        if (!parse_chunk(&reader, &chunk)) return Status::kMalformed;
        header->file_size += chunk.size;  // below 2^24 times 2^42: no overflow
        ++header->chunk_count;
        switch (chunk.type) {
            case ChunkType::kSeams:
                if (chunk.optional || chunk.zstd || seams++ > 0 || levels > 0) return Status::kMalformed;
                break;
            case ChunkType::kLevel:
                if (chunk.optional || chunk.zstd || seams == 0) return Status::kMalformed;
                ++levels;
                break;
            case ChunkType::kText:
                if (!chunk.optional || texts++ > 0) return Status::kMalformed;
                break;
            case ChunkType::kNormals:
            case ChunkType::kColors:
            case ChunkType::kDisplacements:
            case ChunkType::kLabels: {
                const uint32_t kind = 1u << static_cast<uint32_t>(chunk.type);
                if (!chunk.optional || chunk.zstd || (planes_seen & kind) != 0 || levels != header->kept_levels())
                    return Status::kMalformed;
                if (header->layout == FileLayout::kRaster ||
                    (chunk.type == ChunkType::kLabels && header->layout == FileLayout::kCharts))
                    return Status::kMalformed;
                planes_seen |= kind;
                break;
            }
            default:
                if (!chunk.optional) return Status::kUnsupportedVersion;
        }
    }
    return seams == 1 && levels == header->kept_levels() ? Status::kOk : Status::kMalformed;
}

Status parse_sides(ByteReader* reader, const ContainerLimits& limits, std::span<const uint8_t> file, Header* header) {
    uint64_t images = 0;
    if (!reader->read_leb128(&images) || images == 0 || images > kMaxImages) return Status::kMalformed;
    if (images > limits.max_images) return Status::kLimitExceeded;

    // At least one image has all levels. All images together stay within the caller's limits.
    const size_t sides_at = reader->position();
    if (!reader->skip(images)) return Status::kMalformed;
    header->side_exponents = file.subspan(sides_at, images);
    uint8_t largest = 0;
    for (const uint8_t j : header->side_exponents) {
        if (j <= header->cut_levels || j > kMaxSideExponent) return Status::kMalformed;
        const uint64_t side = (uint64_t{1} << (j - header->cut_levels)) + 1;
        header->sample_count += side * side;  // at most 2^16 * 2^29
        largest = std::max(largest, j);
    }
    if (largest < header->level_count) return Status::kMalformed;
    if ((1u << (largest - header->cut_levels)) + 1 > limits.max_side || header->sample_count > limits.max_samples)
        return Status::kLimitExceeded;
    return Status::kOk;
}

Status parse_rectangle(ByteReader* reader, const ContainerLimits& limits, Header* header) {
    uint64_t width = 0, height = 0;
    if (!reader->read_leb128(&width) || !reader->read_leb128(&height)) return Status::kMalformed;
    if (width < 2 || height < 2 || width > kMaxAtlasSide || height > kMaxAtlasSide) return Status::kMalformed;
    header->width = static_cast<uint32_t>(width);
    header->height = static_cast<uint32_t>(height);
    header->sample_count = width * height;
    if (header->layout == FileLayout::kRaster && (header->level_count != 1 || header->sample_count > kMaxRasterSamples))
        return Status::kMalformed;
    if (std::max(width, height) > limits.max_side || header->sample_count > limits.max_samples)
        return Status::kLimitExceeded;
    return Status::kOk;
}

Status parse_tiles(ByteReader* reader, const ContainerLimits& limits, Header* header) {
    uint64_t tiles = 0, vertices = 0, rim = 0;
    uint8_t shape = 0;
    if (!reader->read_leb128(&tiles) || !reader->read_leb128(&vertices) || !reader->read_leb128(&rim) ||
        !reader->read_u8(&shape))
        return Status::kMalformed;
    if ((shape & kReservedTileFlags) != 0) return Status::kUnsupportedVersion;
    TileShape& t = header->tiles;
    t.exponent = shape & kTileExponentMask;
    t.is_sharp = shape & kSharpWaveletFlag;
    t.has_sharp_edges = shape & kSharpEdgesFlag;
    if (tiles == 0 || tiles > kMostTiles || vertices < 4 || vertices > 4 * tiles || rim > 2 * tiles ||
        t.exponent < header->level_count || t.exponent > kMostTileExponent ||
        (t.is_sharp && header->coding == Coding::kLossless))
        return Status::kMalformed;
    t.tiles = static_cast<uint32_t>(tiles);
    t.vertices = static_cast<uint32_t>(vertices);
    t.rim = static_cast<uint32_t>(rim);
    if (TileAtlas(t.tiles, t.intervals(0)).samples() > kMostTileSamples) return Status::kMalformed;  // at most 2^42
    const TileAtlas atlas(t.tiles, t.intervals(header->cut_levels));
    header->sample_count = atlas.samples();
    if (std::max(atlas.width(), atlas.height()) > limits.max_side || header->sample_count > limits.max_samples)
        return Status::kLimitExceeded;
    return Status::kOk;
}

Status parse_origin(ByteReader* reader, bool is_wide, Header* header) {
    if (is_wide) {
        for (double& o : header->wide_origin.emplace()) {
            if (!reader->read_f64(&o) || !in_range(o, -double{kMaxOrigin}, double{kMaxOrigin}))
                return Status::kMalformed;
        }
        return Status::kOk;
    }
    for (float& o : header->origin) {
        if (!reader->read_f32(&o) || !in_range(o, -kMaxOrigin, kMaxOrigin)) return Status::kMalformed;
    }
    return Status::kOk;
}

bool parse_bounds(ByteReader* reader, std::span<const uint8_t> file, Header* header) {
    const size_t errors = kErrorsOfLevel * header->kept_levels(), boxes = kBoxSize * header->image_count();
    const size_t at = reader->position();
    if (!reader->skip(errors + boxes)) return false;
    header->level_errors = file.subspan(at, errors);
    header->boxes = file.subspan(at + errors, boxes);
    BoxNumbers numbers;
    for (uint32_t image = 0; image < header->image_count(); ++image) {
        if (!read_box(header->box_bytes(image), &numbers)) return false;
    }
    return true;
}

}  // namespace

Status parse_header(std::span<const uint8_t> file, const ContainerLimits& limits, Header* header) {
    const size_t seen = std::min(file.size(), kMagic.size());
    if (!std::equal(kMagic.begin(), kMagic.begin() + static_cast<std::ptrdiff_t>(seen), file.begin()))
        return Status::kNotGim;
    if (file.size() < kPreambleSize) return Status::kNeedMoreInput;
    if (file[kMagic.size()] != kFormatVersion) return Status::kUnsupportedVersion;

    // The size of header and index comes first, so that their checksum is verified before anything else is believed.
    ByteReader preamble(file);
    uint64_t index_size = 0;
    preamble.skip(kPreambleSize);
    if (!preamble.read_leb128(&index_size)) {
        const size_t read = preamble.position() - kPreambleSize;
        const bool is_cut_off = preamble.left() == 0 && read < 6 && (read == 0 || file.back() >= 0x80);
        return is_cut_off ? Status::kNeedMoreInput : Status::kMalformed;
    }
    if (index_size < preamble.position() + kCrcSize || index_size > kMaxIndexSize) return Status::kMalformed;
    if (file.size() < index_size) return Status::kNeedMoreInput;
    const size_t body = static_cast<size_t>(index_size) - kCrcSize;
    ByteReader trailer(file.subspan(body, kCrcSize));
    uint32_t crc = 0;
    if (!trailer.read_u32(&crc) || crc32(file.first(body)) != crc) return Status::kChecksum;

    *header = {};
    header->index_size = static_cast<uint32_t>(index_size);
    ByteReader reader(file.first(body));
    reader.skip(preamble.position());
    uint8_t kind = 0, bits = 0, levels = 0;
    if (!reader.read_u8(&kind) || !reader.read_u8(&bits) || !reader.read_u8(&levels)) return Status::kMalformed;
    const auto layout = static_cast<FileLayout>(kind & kLayoutMask);
    if ((kind & kReservedFlags) != 0 || (layout != FileLayout::kRaster && layout > FileLayout::kTiles))
        return Status::kUnsupportedVersion;
    if (bits < kMinBits || bits > kMaxBits || levels == 0 || levels > kMaxLevels) return Status::kMalformed;
    header->layout = layout;
    header->coding = kind & kLossyFlag ? Coding::kLossy : Coding::kLossless;
    header->bits = bits;
    header->level_count = levels;
    if (kind & kCutFlag) {
        uint8_t cut = 0;
        if (!reader.read_u8(&cut) || cut == 0 || cut >= levels) return Status::kMalformed;
        header->cut_levels = cut;
    }
    const Status shape = header->is_rectangle()                 ? parse_rectangle(&reader, limits, header)
                         : header->layout == FileLayout::kTiles ? parse_tiles(&reader, limits, header)
                                                                : parse_sides(&reader, limits, file, header);
    if (shape != Status::kOk) return shape;

    if (Status s = parse_origin(&reader, kind & kWideOriginFlag, header); s != Status::kOk) return s;
    if (!reader.read_f32(&header->step) || !in_range(header->step, kMinStep, kMaxStep)) return Status::kMalformed;
    if (header->coding == Coding::kLossy &&
        (!reader.read_f32(&header->quantizer) || !in_range(header->quantizer, kMinQuantizer, kMaxQuantizer) ||
         !reader.read_u8(&header->tangential) || !reader.read_u8(&header->cell_area) ||
         (header->tangential == 0 && header->cell_area != 0) ||
         (header->tangential != 0 && header->layout == FileLayout::kRaster)))
        return Status::kMalformed;
    if ((kind & kBoundsFlag) && !parse_bounds(&reader, file, header)) return Status::kMalformed;
    header->index = file.subspan(reader.position(), body - reader.position());
    return check_index(header);
}

bool ChunkWalk::next(Chunk* chunk, uint64_t* offset) {
    if (reader_.left() == 0 || !parse_chunk(&reader_, chunk)) return false;
    *offset = offset_;
    offset_ += chunk->size;
    return true;
}

Status read_payload(std::span<const uint8_t> file, const Chunk& chunk, uint64_t offset,
                    std::span<const uint8_t>* payload) {
    if (offset > file.size() || chunk.size > file.size() - offset) return Status::kNeedMoreInput;
    *payload = file.subspan(static_cast<size_t>(offset), static_cast<size_t>(chunk.size));
    return crc16(*payload) == chunk.crc ? Status::kOk : Status::kChecksum;
}

std::vector<uint8_t> serialize_header(const Header& header, std::span<const Chunk> chunks) {
    std::vector<uint8_t> rest;  // everything after Index_Size
    rest.push_back(
        static_cast<uint8_t>(static_cast<uint32_t>(header.layout) | (header.coding == Coding::kLossy ? kLossyFlag : 0) |
                             (header.level_errors.empty() ? 0 : kBoundsFlag) |
                             (header.wide_origin ? kWideOriginFlag : 0) | (header.cut_levels > 0 ? kCutFlag : 0)));
    rest.push_back(static_cast<uint8_t>(header.bits));
    rest.push_back(static_cast<uint8_t>(header.level_count));
    if (header.cut_levels > 0) rest.push_back(static_cast<uint8_t>(header.cut_levels));
    if (header.is_rectangle()) {
        append_leb128(header.width, &rest);
        append_leb128(header.height, &rest);
    } else if (header.layout == FileLayout::kTiles) {
        const TileShape& t = header.tiles;
        for (const uint32_t count : {t.tiles, t.vertices, t.rim}) append_leb128(count, &rest);
        rest.push_back(static_cast<uint8_t>(t.exponent | (t.is_sharp ? kSharpWaveletFlag : 0) |
                                            (t.has_sharp_edges ? kSharpEdgesFlag : 0)));
    } else {
        append_leb128(header.image_count(), &rest);
        for (const uint8_t exponent : header.side_exponents) rest.push_back(exponent);
    }
    if (header.wide_origin) {
        for (const double o : *header.wide_origin) append_f64(o, &rest);
    } else {
        for (const float o : header.origin) append_f32(o, &rest);
    }
    append_f32(header.step, &rest);
    if (header.coding == Coding::kLossy) {
        append_f32(header.quantizer, &rest);
        rest.push_back(header.tangential);
        rest.push_back(header.cell_area);
    }
    rest.insert(rest.end(), header.level_errors.begin(), header.level_errors.end());
    rest.insert(rest.end(), header.boxes.begin(), header.boxes.end());
    for (const Chunk& chunk : chunks) {
        append_leb128(
            uint64_t{static_cast<uint32_t>(chunk.type)} << 2 | (chunk.zstd ? 2u : 0u) | (chunk.optional ? 1u : 0u),
            &rest);
        append_leb128(chunk.size, &rest);
        if (chunk.zstd) append_leb128(chunk.raw_size, &rest);
        append_u16(chunk.crc, &rest);
    }

    // Index_Size counts itself.
    std::vector<uint8_t> file(kMagic.begin(), kMagic.end());
    uint64_t index_size = kPreambleSize + 1 + rest.size() + kCrcSize;
    for (uint64_t limit = 0x80; index_size >= limit; limit <<= 7) ++index_size;
    file.reserve(index_size);
    file.push_back(kFormatVersion);
    append_leb128(index_size, &file);
    for (const uint8_t byte : rest) file.push_back(byte);
    append_u32(crc32(file), &file);
    return file;
}

bool find_chunk(const Header& header, ChunkType type, Chunk* chunk, uint64_t* offset) {
    ChunkWalk walk(header);
    while (walk.next(chunk, offset)) {
        if (chunk->type == type) return true;
    }
    return false;
}

Status read_seam_payload(const Header& header, std::span<const uint8_t> file, std::span<const uint8_t>* payload) {
    Chunk chunk;
    uint64_t offset = 0;
    if (!find_chunk(header, ChunkType::kSeams, &chunk, &offset)) return Status::kMalformed;
    return read_payload(file, chunk, offset, payload);
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
