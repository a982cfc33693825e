// meshoptimizer's vertex and index codecs, then zstd over both.
//
// File: "MZS1", u32 vertices, u32 indices, u32 bytes of the encoded vertices, float origin[3], float step; then a zstd
// frame of the encoded vertices and the encoded indices. A vertex is four u16: x, y, z and zero.
#include <meshoptimizer.h>
#include <zstd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "tools/rd/rival_codecs.h"

namespace gim::rd {

namespace {

constexpr int kZstdLevel = 19;

struct Header {
    char magic[4] = {'M', 'Z', 'S', '1'};
    uint32_t vertices = 0, indices = 0, vertex_bytes = 0;
    float origin[3] = {0, 0, 0}, step = 0;
};

using Quantized = std::array<uint16_t, 4>;

// Puts vertices in the order of their first use, and triangles in an order that suits the cache and the index codec.
RivalMesh reordered(const RivalMesh& mesh) {
    std::vector<uint32_t> indices(mesh.triangles.size() * 3);
    std::memcpy(indices.data(), mesh.triangles.data(), indices.size() * sizeof(uint32_t));
    meshopt_optimizeVertexCache(indices.data(), indices.data(), indices.size(), mesh.positions.size());
    RivalMesh result;
    result.positions.resize(mesh.positions.size());
    result.positions.resize(meshopt_optimizeVertexFetch(result.positions.data(), indices.data(), indices.size(),
                                                        mesh.positions.data(), mesh.positions.size(),
                                                        sizeof(result.positions[0])));
    result.triangles.resize(mesh.triangles.size());
    std::memcpy(result.triangles.data(), indices.data(), indices.size() * sizeof(uint32_t));
    return result;
}

std::vector<Quantized> quantize(const RivalMesh& mesh, int bits, Header& header) {
    std::array<float, 3> low = mesh.positions.front(), high = low;
    for (const auto& p : mesh.positions) {
        for (size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], p[k]), high[k] = std::max(high[k], p[k]);
    }
    const float extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    const auto largest = static_cast<float>((1 << bits) - 1);
    header.step = std::max(extent / largest, std::numeric_limits<float>::min());
    std::memcpy(header.origin, low.data(), sizeof(header.origin));
    std::vector<Quantized> vertices;
    for (const auto& p : mesh.positions) {
        Quantized q{};
        for (size_t k = 0; k < 3; ++k) {
            q[k] = static_cast<uint16_t>(std::clamp(std::round((p[k] - low[k]) / header.step), 0.0F, largest));
        }
        vertices.push_back(q);
    }
    return vertices;
}

class MeshoptDecoder : public RepeatedDecoder {
  public:
    MeshoptDecoder(const Bytes& bytes, const Header& header)
        : bytes_(bytes), header_(header), context_(ZSTD_createDCtx(), ZSTD_freeDCtx) {
        const auto packed = ZSTD_getFrameContentSize(frame(), bytes_.size() - sizeof(Header));
        valid_ = packed != ZSTD_CONTENTSIZE_ERROR && packed != ZSTD_CONTENTSIZE_UNKNOWN && packed < (1U << 30) &&
                 packed >= header.vertex_bytes;
        if (!valid_) return;
        packed_.resize(packed);
        quantized_.resize(header.vertices);
        mesh_.positions.resize(header.vertices);
        mesh_.triangles.resize(header.indices / 3);
    }

    bool run() override {
        if (!valid_) return false;
        const size_t size = ZSTD_decompressDCtx(context_.get(), packed_.data(), packed_.size(), frame(),
                                                bytes_.size() - sizeof(Header));
        if (ZSTD_isError(size) != 0U || size != packed_.size()) return false;
        const uint8_t* indices = packed_.data() + header_.vertex_bytes;
        if (meshopt_decodeVertexBuffer(quantized_.data(), header_.vertices, sizeof(Quantized), packed_.data(),
                                       header_.vertex_bytes) != 0 ||
            meshopt_decodeIndexBuffer(mesh_.triangles.data(), header_.indices, sizeof(uint32_t), indices,
                                      size - header_.vertex_bytes) != 0) {
            return false;
        }
        for (size_t v = 0; v < quantized_.size(); ++v) {
            for (size_t k = 0; k < 3; ++k) {
                mesh_.positions[v][k] = header_.origin[k] + header_.step * static_cast<float>(quantized_[v][k]);
            }
        }
        return true;
    }

    std::array<uint64_t, 2> counts() const override { return {mesh_.positions.size(), mesh_.triangles.size()}; }
    RivalMesh mesh() const override { return mesh_; }

  private:
    const uint8_t* frame() const { return bytes_.data() + sizeof(Header); }

    const Bytes& bytes_;
    Header header_;
    std::unique_ptr<ZSTD_DCtx, size_t (*)(ZSTD_DCtx*)> context_;
    bool valid_ = false;
    std::vector<uint8_t> packed_;
    std::vector<Quantized> quantized_;
    RivalMesh mesh_;
};

}  // namespace

Result<Bytes> encode_meshopt(const RivalMesh& mesh, int bits) {
    const RivalMesh ordered = reordered(mesh);
    if (ordered.triangles.empty()) return Error{Stage::kCode, "meshoptimizer: no triangles"};
    Header header;
    const std::vector<Quantized> vertices = quantize(ordered, bits, header);
    const size_t indices = ordered.triangles.size() * 3;
    Bytes packed(meshopt_encodeVertexBufferBound(vertices.size(), sizeof(Quantized)));
    packed.resize(
        meshopt_encodeVertexBuffer(packed.data(), packed.size(), vertices.data(), vertices.size(), sizeof(Quantized)));
    header.vertices = static_cast<uint32_t>(vertices.size());
    header.indices = static_cast<uint32_t>(indices);
    header.vertex_bytes = static_cast<uint32_t>(packed.size());
    packed.resize(header.vertex_bytes + meshopt_encodeIndexBufferBound(indices, vertices.size()));
    meshopt_encodeIndexVersion(1);
    packed.resize(header.vertex_bytes + meshopt_encodeIndexBuffer(packed.data() + header.vertex_bytes,
                                                                  packed.size() - header.vertex_bytes,
                                                                  ordered.triangles.front().data(), indices));

    Bytes file(sizeof(Header) + ZSTD_compressBound(packed.size()));
    const size_t size = ZSTD_compress(file.data() + sizeof(Header), file.size() - sizeof(Header), packed.data(),
                                      packed.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0U) return Error{Stage::kCode, std::string("zstd: ") + ZSTD_getErrorName(size)};
    std::memcpy(file.data(), &header, sizeof(Header));
    file.resize(sizeof(Header) + size);
    return file;
}

std::unique_ptr<RepeatedDecoder> make_meshopt_decoder(const Bytes& bytes) {
    Header header;
    if (bytes.size() <= sizeof(Header) || std::memcmp(bytes.data(), header.magic, sizeof(header.magic)) != 0)
        return nullptr;
    std::memcpy(&header, bytes.data(), sizeof(Header));
    if (header.vertices > (1U << 27) || header.indices > (1U << 29)) return nullptr;
    return std::make_unique<MeshoptDecoder>(bytes, header);
}

RivalMesh simplify_quadric(const RivalMesh& mesh, double ratio) {
    const size_t count = mesh.triangles.size() * 3;
    const auto target = static_cast<size_t>(ratio * static_cast<double>(mesh.triangles.size())) * 3;
    std::vector<uint32_t> indices(count);
    // The target error is a part of the mesh's extent. 1 never stops the collapses.
    indices.resize(meshopt_simplify(indices.data(), mesh.triangles.front().data(), count, mesh.positions.front().data(),
                                    mesh.positions.size(), sizeof(mesh.positions[0]), target, 1.0F, 0, nullptr));
    RivalMesh result;
    result.positions.resize(mesh.positions.size());
    result.positions.resize(meshopt_optimizeVertexFetch(result.positions.data(), indices.data(), indices.size(),
                                                        mesh.positions.data(), mesh.positions.size(),
                                                        sizeof(mesh.positions[0])));
    result.triangles.resize(indices.size() / 3);
    std::memcpy(result.triangles.data(), indices.data(), indices.size() * sizeof(uint32_t));
    return result;
}

}  // namespace gim::rd
