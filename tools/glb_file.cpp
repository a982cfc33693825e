#include "tools/glb_file.h"

#include "tools/little_endian.h"

namespace gim {
namespace {

constexpr uint32_t kMagic = 0x46546C67;
constexpr uint32_t kJsonChunk = 0x4E4F534A;
constexpr uint32_t kBinaryChunk = 0x004E4942;

void pad(Bytes& bytes, uint8_t with) {
    while (bytes.size() % 4 != 0) bytes.push_back(with);
}

void append_chunk(Bytes& out, uint32_t type, const Bytes& bytes) {
    append(out, static_cast<uint32_t>(bytes.size()));
    append(out, type);
    out.insert(out.end(), bytes.begin(), bytes.end());
}

}  // namespace

Result<Bytes> glb_bytes(const std::string& json, Bytes binary) {
    Bytes header(json.begin(), json.end());
    pad(header, ' ');
    pad(binary, 0);
    const uint64_t size = uint64_t{12} + 8 + header.size() + (binary.empty() ? 0 : 8 + binary.size());
    if (size > UINT32_MAX)
        return Error{Stage::kWrite, "GLB files may have at most 4 GB; choose PLY or a coarser --level"};
    Bytes out;
    out.reserve(size);
    append(out, kMagic);
    append(out, uint32_t{2});
    append(out, static_cast<uint32_t>(size));
    append_chunk(out, kJsonChunk, header);
    if (!binary.empty()) append_chunk(out, kBinaryChunk, binary);
    return out;
}

void replace_zero_normals(std::vector<float>& normals) {
    for (size_t i = 0; i + 2 < normals.size(); i += 3) {
        if (normals[i] == 0 && normals[i + 1] == 0 && normals[i + 2] == 0) normals[i + 2] = 1;
    }
}

}  // namespace gim
