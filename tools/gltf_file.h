// A glTF file as its parts: the JSON, the buffers and the buffer views, which it reads and decompresses when they are
// first asked for.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/file.h"
#include "tools/gltf_json.h"
#include "tools/read_context.h"

namespace gim::gltf {

// Counts count * each bytes. Fails if they go over the limit; `what` is a noun in the plural.
void take(MemoryBudget& memory, uint64_t count, uint64_t each, std::string_view what);

class File {
  public:
    // `text`: the bytes of a .gltf or .glb. Both must outlive the object.
    File(std::string_view text, ReadContext& context);
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    const Json& root() const { return root_; }
    ReadContext& context() { return context_; }
    MemoryBudget& memory() { return context_.memory; }

    // The bytes of a buffer view, as far as its buffer has them. Valid as long as the file.
    std::span<const uint8_t> view(uint64_t index);

  private:
    bool has_data(uint64_t buffer) const;
    std::span<const uint8_t> buffer(uint64_t index);
    std::span<const uint8_t> part_of_buffer(const Json& place);

    Json root_;
    bool has_binary_chunk_ = false;
    std::span<const uint8_t> binary_chunk_;
    ReadContext& context_;
    std::map<uint64_t, Bytes> buffers_;        // read from URIs
    std::map<uint64_t, Bytes> decoded_views_;  // decompressed
};

}  // namespace gim::gltf
