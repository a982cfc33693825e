#include "tools/gltf_file.h"

#include <algorithm>

#include "tools/gltf_meshopt.h"
#include "tools/gltf_uri.h"
#include "tools/little_endian.h"

namespace gim::gltf {
namespace {

constexpr size_t kGlbHeader = 12;
constexpr size_t kChunkHeader = 8;
constexpr uint32_t kJsonChunk = 0x4E4F534A;
constexpr uint32_t kBinaryChunk = 0x004E4942;
constexpr uint64_t kBytesPerJsonValue = 64;  // a little more than what nlohmann::json takes for one, keys included
constexpr size_t kMostMessage = 200;

const std::string kOldVersion = "glTF 1.0; only 2.0 is read: convert it";

struct Chunks {
    std::string_view json;
    bool has_binary = false;
    std::span<const uint8_t> binary;
};

// Skips unknown chunks. Chunks of some programs have lengths that are no multiple of 4; the next begins where they end.
Chunks split_glb(std::string_view text) {
    if (text.size() < kGlbHeader) throw Failure("the header of the GLB is cut short");
    const uint32_t version = load_u32(text.data() + 4);
    if (version == 1) throw Failure(kOldVersion);
    if (version != 2) throw Failure("binary glTF of version " + std::to_string(version) + "; only 2 is read");
    const uint32_t length = load_u32(text.data() + 8);
    if (length > text.size()) {
        throw Failure("the GLB says that it has " + std::to_string(length) + " bytes, but the file has only " +
                      std::to_string(text.size()) + " (is it cut short?)");
    }
    Chunks chunks;
    for (size_t at = kGlbHeader; at + kChunkHeader <= length;) {
        const uint32_t size = load_u32(text.data() + at);
        const uint32_t type = load_u32(text.data() + at + 4);
        at += kChunkHeader;
        if (size > length - at) throw Failure("a chunk of the GLB reaches beyond the file (is it cut short?)");
        const std::string_view content = text.substr(at, size);
        if (type == kJsonChunk && chunks.json.empty()) chunks.json = content;
        if (type == kBinaryChunk && !chunks.has_binary) {
            chunks.has_binary = true;
            chunks.binary = {reinterpret_cast<const uint8_t*>(content.data()), content.size()};
        }
        at += size;
    }
    if (chunks.json.empty()) throw Failure("the GLB has no JSON chunk");
    return chunks;
}

Json parse(std::string_view text, MemoryBudget& memory) {
    while (!text.empty() && text.back() == '\0') text.remove_suffix(1);  // some programs pad with zeros
    const auto starts_value = [](char c) { return c == ',' || c == '[' || c == '{' || c == ':'; };
    const auto values = static_cast<uint64_t>(std::count_if(text.begin(), text.end(), starts_value));
    take(memory, values, kBytesPerJsonValue, "its " + std::to_string(values) + " JSON values");
    take(memory, text.size(), 1, "the texts in its JSON");
    try {
        return Json::parse(text);
    } catch (const Json::exception& error) {
        std::string what = error.what();
        what.erase(0, what.starts_with('[') ? what.find(']') + 2 : 0);
        throw Failure("its JSON is damaged: " + what.substr(0, kMostMessage));
    }
}

void check_version(const Json& root) {
    if (!root.is_object()) throw Failure("its JSON is no object");
    const Json& asset = member(root, "asset");
    const Json& written = member(asset, "version");
    std::string version = written.is_number() ? written.dump() : text(asset, "version");
    // Lists by name are glTF 1.0, whatever the file says.
    const bool named_lists = member(root, "meshes").is_object() || member(root, "accessors").is_object();
    if (version == "1" || version.starts_with("1.") || named_lists) throw Failure(kOldVersion);
    const std::string least = text(asset, "minVersion");
    if (!least.empty() && least != "2.0") version = least;
    const bool is_2 = version == "2" || version.starts_with("2.");
    if (!version.empty() && (!is_2 || (!least.empty() && least != "2.0"))) {
        throw Failure("glTF " + version.substr(0, 20) + "; only 2.0 is read");
    }
}

const Json& meshopt_extension(const Json& object) {
    const Json& released = extension(object, "EXT_meshopt_compression");
    return released.is_null() ? extension(object, "KHR_meshopt_compression") : released;
}

}  // namespace

void take(MemoryBudget& memory, uint64_t count, uint64_t each, std::string_view what) {
    const Result<void> fits = memory.take(count, each, what);
    if (!fits.ok()) throw Failure(fits.error().message);
}

File::File(std::string_view text, ReadContext& context) : context_(context) {
    Chunks chunks;
    chunks.json = text;
    if (text.starts_with("glTF")) chunks = split_glb(text);
    has_binary_chunk_ = chunks.has_binary;
    binary_chunk_ = chunks.binary;
    root_ = parse(chunks.json, context_.memory);
    check_version(root_);
}

bool File::has_data(uint64_t buffer) const {
    const bool has_uri = member(element(root_, "buffers", buffer), "uri").is_string();
    return has_uri || (buffer == 0 && has_binary_chunk_);
}

std::span<const uint8_t> File::buffer(uint64_t index) {
    const Json& uri = member(element(root_, "buffers", index), "uri");
    const std::string name = "buffer " + std::to_string(index);
    if (!uri.is_string()) {
        if (index == 0 && has_binary_chunk_) return binary_chunk_;
        throw Failure(name + " has no data: neither a URI nor a binary chunk");
    }
    const auto known = buffers_.find(index);
    if (known != buffers_.end()) return known->second;
    const std::string& place = uri.get_ref<const std::string&>();
    try {
        Bytes bytes = read_uri(place, context_.folder, context_.memory.left());
        take(context_.memory, bytes.size(), 1, "the bytes of its buffers");
        return buffers_.emplace(index, std::move(bytes)).first->second;
    } catch (const Failure& failure) {
        throw Failure(name + ", " + shown_uri(place) + ": " + failure.what());
    }
}

// `place` is a buffer view, or the compressed place that a view's extension names.
std::span<const uint8_t> File::part_of_buffer(const Json& place) {
    const std::optional<uint64_t> index = whole_number(place, "buffer");
    if (!index) throw Failure("a buffer view has no buffer");
    const std::span<const uint8_t> bytes = buffer(*index);
    const uint64_t offset = std::min<uint64_t>(whole_number(place, "byteOffset").value_or(0), bytes.size());
    const uint64_t size = std::min<uint64_t>(whole_number(place, "byteLength").value_or(0), bytes.size() - offset);
    return bytes.subspan(offset, size);
}

std::span<const uint8_t> File::view(uint64_t index) {
    const Json& place = element(root_, "bufferViews", index);
    const Json& packed = meshopt_extension(place);
    if (!packed.is_object()) return part_of_buffer(place);
    const auto known = decoded_views_.find(index);
    if (known != decoded_views_.end()) return known->second;
    try {
        Bytes bytes = decode_meshopt(packed, part_of_buffer(packed), context_.memory);
        return decoded_views_.emplace(index, std::move(bytes)).first->second;
    } catch (const Failure& failure) {
        // Such a file may hold the same bytes uncompressed, for readers that cannot decompress it.
        const std::optional<uint64_t> plain = whole_number(place, "buffer");
        if (plain && has_data(*plain)) return part_of_buffer(place);
        throw Failure("buffer view " + std::to_string(index) + " (meshopt): " + failure.what());
    }
}

}  // namespace gim::gltf
