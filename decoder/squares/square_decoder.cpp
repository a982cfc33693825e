#include "decoder/squares/square_decoder.h"

#include <array>
#include <new>

#include "format/sideband_code.h"
#include "format/stream_table.h"

namespace gim {
namespace {

// Finds the part of a level chunk that belongs to one image.
Status image_stream(const Header& header, std::span<const uint8_t> payload, uint32_t image, uint32_t level,
                    std::span<const uint8_t>* stream) {
    const auto has_level = [&](uint32_t i) { return level < header.level_count_of(i); };
    return find_stream(payload, header.image_count(), image, has_level, stream);
}

Status decode_pyramid(const Header& header, std::span<const uint8_t> file, uint32_t image, uint32_t level,
                      const SeamTable& seams, const ImageWorkspace& ws, float** samples) {
    const PyramidShape shape = square_shape(header.side_exponents[image], level, detail_coding_of(header),
                                            1 << (header.bits - 1), header.tangential > 0 ? &seams : nullptr);
    const bool integers = header.coding == Coding::kLossless;
    PyramidDecoder decoder(integers, shape, ws.pyramid);
    new (ws.pyramid.models) BandModels(coefficient_kind_of(header));
    for (uint32_t l = header.level_count_of(image); l-- > level;) {
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload, stream;
        if (Status s = find_level_chunk(header, l, &chunk, &offset); s != Status::kOk) return s;
        if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
        if (Status s = image_stream(header, payload, image, l, &stream); s != Status::kOk) return s;
        if (Status s = decode_stream(decoder, ws.pyramid, stream, l); s != Status::kOk) return s;
    }
    const size_t side = size_t{(header.side(image) - 1) >> level} + 1;
    *samples = to_units(integers, ws.pyramid.images[0], side * side * 3);
    return Status::kOk;
}

}  // namespace

PlaneWorkspace lay_out_plane(uint32_t side, Arena* arena) {
    const size_t ring = ring_length(side);
    PlaneWorkspace ws;
    lay_out_coder(side, arena, &ws.pyramid);
    lay_out_samples(side, side, arena, &ws.pyramid);
    ws.class_of = arena->take<uint32_t>(ring);
    ws.pyramid.rim = ws.class_of;  // no longer needed when classes are made
    ws.fuse.sums = arena->take<float>(ring * 3);
    ws.fuse.first = arena->take<uint32_t>(ring);
    ws.fuse.members = arena->take<uint32_t>(ring);
    ws.fuse.outer = arena->take<float>(ring * 3);
    ws.fuse.inner = arena->take<float>(ring * 3);
    return ws;
}

ImageWorkspace lay_out(uint32_t side, Arena* arena) {
    ImageWorkspace ws{lay_out_plane(side, arena)};
    ws.triangulate = {arena->take<float>(size_t{side} * 6), arena->take<uint32_t>(side - 1)};
    ws.normals = arena->take<float>(size_t{side} * side * 3);
    return ws;
}

Status decode_level(const Header& header, std::span<const uint8_t> file, uint32_t image, uint32_t level,
                    const SeamTable& seams, const ImageWorkspace& ws, float** samples) {
    if (Status s = decode_pyramid(header, file, image, level, seams, ws, samples); s != Status::kOk) return s;
    const uint32_t side = ((header.side(image) - 1) >> level) + 1;
    ring_classes(seams, side, {ws.class_of, ring_length(side)});
    fuse(side, ws.class_of, ring_class_count(seams, side), *samples, ws.fuse);
    return Status::kOk;
}

Status read_seams(const Header& header, std::span<const uint8_t> file, uint32_t image, SeamTable* seams) {
    std::span<const uint8_t> payload;
    if (Status s = read_seam_payload(header, file, &payload); s != Status::kOk) return s;
    std::array<CutPath, kMaxCutPaths> paths;  // made once: a file may have many images
    for (uint32_t i = 0;; ++i) {
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

}  // namespace gim
