#include "encoder/code/assemble_file.h"

#include <zstd.h>

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

// Compressed where that is smaller.
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

}  // namespace

void set_quantizer(std::span<const std::span<const Vec3>> positions, uint32_t bits, Header* header) {
    Vec3 low = Vec3::Constant(INFINITY), high = Vec3::Constant(-INFINITY);
    for (const auto& part : positions) {
        for (const Vec3& p : part) {
            low = low.cwiseMin(p);
            high = high.cwiseMax(p);
        }
    }
    // A surface that is a single point still needs a positive step.
    const double extent = (high - low).maxCoeff();
    const double smallest = std::max(double{kMinStep}, low.cwiseAbs().maxCoeff() * 0x1p-60);
    header->bits = bits;
    header->step = static_cast<float>(std::max(extent / (std::exp2(bits) - 1), smallest));
    for (int k = 0; k < 3; ++k) header->origin[static_cast<size_t>(k)] = static_cast<float>(low[k]);
}

void CellArea::add(std::span<const Vec3> positions, std::span<const uint8_t> defined, uint32_t columns, uint32_t rows) {
    for (size_t row = 0; row + 1 < rows; ++row) {
        for (size_t column = 0; column + 1 < columns; ++column) {
            const size_t a = row * columns + column, b = a + 1, c = a + columns, d = c + 1;
            if (!defined.empty() && !(defined[a] && defined[b] && defined[c] && defined[d])) continue;
            sum_ += 0.5 * (positions[d] - positions[a]).cross(positions[c] - positions[b]).norm();
            ++cells_;
        }
    }
}

void CellArea::set_details(Header* header) const {
    header->tangential = static_cast<uint8_t>(8 * kTangentialRatio);
    const double area = cells_ > 0 ? sum_ / static_cast<double>(cells_) / (double{header->step} * header->step) : 0;
    uint8_t code = 1;
    while (code < 255 && double{cell_area_of(static_cast<uint8_t>(code + 1))} <= area) ++code;
    header->cell_area = code;
}

float quantizer_in_range(double quantizer) {
    return std::clamp(static_cast<float>(quantizer), kMinQuantizer, kMaxQuantizer);
}

std::vector<uint8_t> assemble_file(const Header& header, std::span<const uint8_t> seams,
                                   std::span<const std::vector<uint8_t>> levels, std::span<const CodedPlane> planes,
                                   const std::string& text) {
    std::vector<Payload> payloads;
    payloads.push_back(make_payload(ChunkType::kSeams, false, {seams.begin(), seams.end()}));
    for (const auto& level : levels) payloads.push_back(make_payload(ChunkType::kLevel, false, level));
    for (const CodedPlane& plane : planes) payloads.push_back(make_payload(plane.type, true, plane.payload));
    if (!text.empty()) payloads.push_back(make_text_payload(text));

    std::vector<Chunk> chunks;
    for (const Payload& p : payloads) chunks.push_back(p.chunk);
    std::vector<uint8_t> file = serialize_header(header, chunks);
    for (const Payload& p : payloads) file.insert(file.end(), p.bytes.begin(), p.bytes.end());
    return file;
}

}  // namespace gim
