#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <string>

#include "tools/rd/rival_codecs.h"

namespace gim::rd {

namespace {

class DracoDecoder : public RepeatedDecoder {
  public:
    explicit DracoDecoder(const Bytes& bytes) : bytes_(bytes) {}

    // Stops at Draco's own mesh. Copying it into the caller's arrays is not counted.
    bool run() override {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char*>(bytes_.data()), bytes_.size());
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok()) return false;
        mesh_ = std::move(decoded).value();
        return mesh_->GetNamedAttribute(draco::GeometryAttribute::POSITION) != nullptr;
    }

    std::array<uint64_t, 2> counts() const override { return {mesh_->num_points(), mesh_->num_faces()}; }

    RivalMesh mesh() const override {
        const draco::PointAttribute& positions = *mesh_->GetNamedAttribute(draco::GeometryAttribute::POSITION);
        RivalMesh result;
        result.positions.resize(mesh_->num_points());
        for (uint32_t i = 0; i < mesh_->num_points(); ++i) {
            positions.GetMappedValue(draco::PointIndex(i), result.positions[i].data());
        }
        for (uint32_t f = 0; f < mesh_->num_faces(); ++f) {
            const draco::Mesh::Face& face = mesh_->face(draco::FaceIndex(f));
            result.triangles.push_back({face[0].value(), face[1].value(), face[2].value()});
        }
        return result;
    }

  private:
    const Bytes& bytes_;
    std::unique_ptr<draco::Mesh> mesh_;
};

void fill(draco::Mesh& result, const RivalMesh& mesh) {
    const auto count = static_cast<uint32_t>(mesh.positions.size());
    result.set_num_points(count);
    draco::GeometryAttribute shape;
    shape.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 3 * sizeof(float), 0);
    draco::PointAttribute& positions = *result.attribute(result.AddAttribute(shape, true, count));
    for (uint32_t v = 0; v < count; ++v) {
        positions.SetAttributeValue(draco::AttributeValueIndex(v), mesh.positions[v].data());
    }
    result.SetNumFaces(mesh.triangles.size());
    for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        const auto& t = mesh.triangles[f];
        result.SetFace(draco::FaceIndex(f),
                       {draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])});
    }
}

}  // namespace

Result<Bytes> encode_draco(const RivalMesh& mesh, int bits) {
    draco::Mesh input;
    fill(input, mesh);
    draco::Encoder encoder;
    encoder.SetSpeedOptions(0, 0);  // what draco_encoder calls -cl 10
    encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    draco::EncoderBuffer buffer;
    const draco::Status status = encoder.EncodeMeshToBuffer(input, &buffer);
    if (!status.ok()) return Error{Stage::kCode, "Draco: " + status.error_msg_string()};
    return Bytes(buffer.data(), buffer.data() + buffer.size());
}

std::unique_ptr<RepeatedDecoder> make_draco_decoder(const Bytes& bytes) {
    if (bytes.size() < 5 || std::string(bytes.begin(), bytes.begin() + 5) != "DRACO") return nullptr;
    return std::make_unique<DracoDecoder>(bytes);
}

}  // namespace gim::rd
