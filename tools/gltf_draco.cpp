#include "tools/gltf_draco.h"

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <algorithm>
#include <limits>

namespace gim::gltf {
namespace {

constexpr uint64_t kBytesPerTriangle = 128;       // faces, corner table, traversal, point map
constexpr uint64_t kBytesPerSeamedTriangle = 32;  // of the corner table of an attribute with seams
constexpr uint64_t kBytesPerValue = 8;            // of an attribute and a point: map and portable integers

// What a stream claims about its connectivity.
struct Claim {
    uint32_t triangles = 0;
    uint32_t points = 0;
    uint8_t seamed_attributes = 0;
};

// Each reads what the decoder is about to read, from its own copy of the reader.
bool read_claim(draco::MeshEdgebreakerDecoder*, draco::DecoderBuffer in, Claim& claim) {
    return draco::DecodeVarint(&claim.points, &in) && draco::DecodeVarint(&claim.triangles, &in) &&
           in.Decode(&claim.seamed_attributes);
}

bool read_claim(draco::MeshSequentialDecoder*, draco::DecoderBuffer in, Claim& claim) {
    return draco::DecodeVarint(&claim.triangles, &in) && draco::DecodeVarint(&claim.points, &in);
}

// A decoder of the library that stops where a stream claims more memory than there is. Draco itself takes whatever a
// few bytes claim. No exception passes through the library: the decoder keeps its message.
template <class Base>
class BoundedDecoder : public Base {
  public:
    explicit BoundedDecoder(MemoryBudget& memory) : memory_(memory) {}
    const std::string& refusal() const { return refusal_; }

  protected:
    bool DecodeConnectivity() override {
        Claim claim;
        if (!read_claim(this, *this->buffer(), claim)) return false;
        return fits(claim.triangles, kBytesPerTriangle + claim.seamed_attributes * kBytesPerSeamedTriangle) &&
               fits(claim.points, kBytesPerTriangle) && Base::DecodeConnectivity();
    }
    // Called when the attributes are known, before their values are read.
    bool DecodeAllAttributes() override {
        const draco::PointCloud& cloud = *this->point_cloud();
        for (int i = 0; i < cloud.num_attributes(); ++i) {
            const draco::PointAttribute& attribute = *cloud.attribute(i);
            const int size = std::max(draco::DataTypeLength(attribute.data_type()), 0);
            if (!fits(cloud.num_points(), attribute.num_components() * (kBytesPerValue + static_cast<uint64_t>(size))))
                return false;
        }
        return Base::DecodeAllAttributes();
    }

  private:
    bool fits(uint64_t items, uint64_t size) {
        const Result<void> taken = memory_.take(items, size, "its compressed triangles");
        if (!taken.ok()) refusal_ = taken.error().message;
        return taken.ok();
    }

    MemoryBudget& memory_;
    std::string refusal_;
};

template <class Base>
void decode(draco::DecoderBuffer& in, MemoryBudget& memory, draco::Mesh& mesh) {
    BoundedDecoder<Base> decoder(memory);
    const draco::Status status = decoder.Decode(draco::DecoderOptions(), &in, &mesh);
    if (!decoder.refusal().empty()) throw Failure(decoder.refusal());
    if (!status.ok()) throw Failure("Draco: its bytes are damaged");
}

double normalized_value(double value, draco::DataType type) {
    switch (type) {
        case draco::DT_INT8:
            return std::max(value / std::numeric_limits<int8_t>::max(), -1.0);
        case draco::DT_UINT8:
            return value / std::numeric_limits<uint8_t>::max();
        case draco::DT_INT16:
            return std::max(value / std::numeric_limits<int16_t>::max(), -1.0);
        case draco::DT_UINT16:
            return value / std::numeric_limits<uint16_t>::max();
        case draco::DT_INT32:
            return std::max(value / std::numeric_limits<int32_t>::max(), -1.0);
        case draco::DT_UINT32:
            return value / std::numeric_limits<uint32_t>::max();
        default:
            return value;
    }
}

}  // namespace

struct DracoMesh::Decoded {
    explicit Decoded(MemoryBudget& limit) : memory(limit) {}
    draco::Mesh mesh;
    MemoryBudget& memory;
};

DracoMesh::DracoMesh(std::span<const uint8_t> bytes, MemoryBudget& memory)
    : decoded_(std::make_unique<Decoded>(memory)) {
    draco::DecoderBuffer in;
    in.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DecoderBuffer peek = in;
    draco::DracoHeader header;
    if (!draco::PointCloudDecoder::DecodeHeader(&peek, &header).ok()) throw Failure("Draco: it has no header");
    const int version = header.version_major * 10 + header.version_minor;
    if (version != 22) {
        throw Failure("Draco: bitstream " + std::to_string(header.version_major) + "." +
                      std::to_string(header.version_minor) + "; glTF takes 2.2");
    }
    if (header.encoder_type != draco::TRIANGULAR_MESH) throw Failure("Draco: it holds points, no triangles");
    if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
        decode<draco::MeshEdgebreakerDecoder>(in, memory, decoded_->mesh);
    } else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
        decode<draco::MeshSequentialDecoder>(in, memory, decoded_->mesh);
    } else {
        throw Failure("Draco: its method is unknown");
    }
}

DracoMesh::~DracoMesh() = default;

std::vector<uint32_t> DracoMesh::corners() const {
    const draco::Mesh& mesh = decoded_->mesh;
    take(decoded_->memory, mesh.num_faces(), 3 * sizeof(uint32_t), "its triangles");
    std::vector<uint32_t> corners;
    corners.reserve(size_t{3} * mesh.num_faces());
    for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
        for (const draco::PointIndex& point : mesh.face(f)) corners.push_back(point.value());
    }
    return corners;
}

Column DracoMesh::column(uint64_t unique_id, bool normalized) const {
    const draco::Mesh& mesh = decoded_->mesh;
    const draco::PointAttribute* attribute =
        unique_id <= UINT32_MAX ? mesh.GetAttributeByUniqueId(static_cast<uint32_t>(unique_id)) : nullptr;
    if (!attribute) throw Failure("Draco: it has no attribute " + std::to_string(unique_id));
    Column column;
    column.count = mesh.num_points();
    column.width = attribute->num_components();
    take(decoded_->memory, column.count, column.width * sizeof(double), "its vertices");
    column.own.resize(column.count * column.width);
    for (draco::PointIndex point(0); point < mesh.num_points(); ++point) {
        const draco::AttributeValueIndex value = attribute->mapped_index(point);
        double* row = column.own.data() + size_t{point.value()} * column.width;
        if (value.value() >= attribute->size() || !attribute->ConvertValue<double>(value, row)) {
            throw Failure("Draco: a vertex has no value");
        }
        // ConvertValue has divided the integers of an attribute that Draco itself knows as normalized.
        const bool divided = attribute->normalized();
        for (size_t k = 0; k < column.width && (divided || normalized); ++k) {
            row[k] = divided ? std::max(row[k], -1.0) : normalized_value(row[k], attribute->data_type());
        }
    }
    return column;
}

}  // namespace gim::gltf
