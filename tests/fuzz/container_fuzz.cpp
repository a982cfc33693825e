// libFuzzer: header, index, sidebands. The checksum of header and index is made right first, so that what is behind it is
// reached.
#include <algorithm>
#include <array>
#include <vector>

#include "format/checksum.h"
#include "format/container.h"
#include "format/seam.h"
#include "format/sideband_code.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    using namespace gim;
    std::vector<uint8_t> bytes(data, data + size);
    ByteReader reader(bytes);
    uint64_t index_size = 0;
    if (reader.skip(8) && reader.read_leb128(&index_size) && index_size >= 13 && index_size <= bytes.size()) {
        const auto body = static_cast<size_t>(index_size) - 4;
        const uint32_t crc = crc32(std::span(bytes).first(body));
        for (size_t i = 0; i < 4; ++i) bytes[body + i] = static_cast<uint8_t>(crc >> (8 * i));
    }
    Header header;
    if (parse_header(bytes, {}, &header) == Status::kOk) {
        ChunkWalk walk(header);
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload;
        while (walk.next(&chunk, &offset)) (void)(read_payload(bytes, chunk, offset, &payload) == Status::kOk);
    }

    std::array<CutPath, kMaxCutPaths> paths;
    ParsedSideband parsed;
    if (parse_sideband({data, size}, paths, &parsed) == Status::kOk) {
        SeamTable table;
        if (build_seam_table(parsed.node_side, parsed.start, std::span(paths).first(parsed.path_count), &table) ==
            Status::kOk) {
            for (uint32_t side = 3; side <= 1025; side = 2 * side - 1) {
                if (!level_is_closed(table, side)) continue;
                std::vector<uint32_t> class_of(ring_length(side));
                ring_classes(table, side, class_of);
                if (*std::max_element(class_of.begin(), class_of.end()) + 1 != ring_class_count(table, side))
                    __builtin_trap();
            }
        }
    }
    return 0;
}
