// libFuzzer target: header, index and payloads, chunk by chunk.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "format/container.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    gim::Header header;
    if (gim::parse_header({data, size}, {}, &header) != gim::Status::kOk) return 0;
    gim::ChunkWalk walk(header);
    gim::Chunk chunk;
    uint64_t offset = 0;
    uint32_t count = 0;
    while (walk.next(&chunk, &offset)) {
        if (++count > header.chunk_count || offset > header.file_size) std::abort();
        std::span<const uint8_t> payload;
        if (gim::read_payload({data, size}, chunk, offset, &payload) != gim::Status::kOk) continue;
        if (payload.size() != chunk.size) std::abort();
    }
    return 0;
}
