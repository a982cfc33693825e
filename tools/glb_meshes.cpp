#include "tools/glb_meshes.h"

#include <string>

namespace gim::gltf {
namespace {

constexpr size_t kMostPrimitives = 256;  // a label is one byte
const char* const kDraco = "KHR_draco_mesh_compression";

void check_attributes(const Json& primitive) {
    for (const auto& [name, accessor] : member(primitive, "attributes").items()) {
        if (name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name == "COLOR_0") continue;
        if (name.starts_with("TEXCOORD_")) continue;
        throw Failure("gim cannot carry its attribute " + name);
    }
}

void check_primitive(const Json& primitive) {
    const uint64_t mode = whole_number(primitive, "mode").value_or(4);
    if (mode < 4) throw Failure(mode == 0 ? "it has points" : "it has lines");
    if (!member(primitive, "targets").is_null()) throw Failure("it has morph targets");
    if (member(member(primitive, "attributes"), "POSITION").is_null()) throw Failure("it has no positions");
    const Json& extensions = member(primitive, "extensions");
    if (extensions.is_object()) {
        for (const auto& [name, value] : extensions.items())
            if (name != kDraco) throw Failure("gim cannot carry its extension " + name);
    }
    check_attributes(primitive);
}

// What an accessor takes without compression.
uint64_t bytes_of(const Json& root, uint64_t accessor) {
    const Json& object = element(root, "accessors", accessor);
    const uint64_t component = whole_number(object, "componentType").value_or(5126);
    const uint64_t size = component < 5122 ? 1 : component < 5124 ? 2 : component == 5130 ? 8 : 4;
    const std::string type = text(object, "type");
    const uint64_t width = type.starts_with("VEC") ? static_cast<uint64_t>(type[3] - '0') : 1;
    return whole_number(object, "count").value_or(0) * size * width;
}

uint64_t plain_bytes(const Json& root, const Json& primitive) {
    uint64_t sum = 0;
    for (const Json& accessor : member(primitive, "attributes"))
        if (accessor.is_number()) sum += bytes_of(root, accessor.get<uint64_t>());
    if (const auto indices = whole_number(primitive, "indices")) sum += bytes_of(root, *indices);
    return sum;
}

// Appends a primitive to the mesh. Without normals its shading is flat.
void append(Primitive& primitive, uint8_t label, TriangleMesh& mesh) {
    const MorphedColumn positions = primitive.attribute("POSITION", 3);
    const auto base = static_cast<uint32_t>(mesh.positions.size());
    for (uint64_t row = 0; row < positions.base.count; ++row)
        mesh.positions.push_back({positions.at(row, 0), positions.at(row, 1), positions.at(row, 2)});
    const auto first_normal = static_cast<uint32_t>(mesh.shading.normals.size());
    const bool has_normals = primitive.has("NORMAL");
    if (has_normals) {
        const MorphedColumn normals = primitive.attribute("NORMAL", 3);
        for (uint64_t row = 0; row < normals.base.count; ++row)
            mesh.shading.normals.push_back({static_cast<float>(normals.at(row, 0)),
                                            static_cast<float>(normals.at(row, 1)),
                                            static_cast<float>(normals.at(row, 2))});
    }
    const std::vector<uint32_t> corners = primitive.corners();
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        std::array<uint32_t, 3> vertices{}, normals{};
        for (size_t k = 0; k < 3; ++k) {
            vertices[k] = base + corners[i + k];
            normals[k] = has_normals ? first_normal + corners[i + k] : Shading::kFlat;
        }
        mesh.triangles.push_back(vertices);
        mesh.shading.corners.push_back(normals);
        mesh.labels.push_back(label);
    }
}

}  // namespace

std::set<uint64_t> skinned_meshes(const Json& root) {
    std::set<uint64_t> meshes;
    const Json& nodes = member(root, "nodes");
    if (!nodes.is_array()) return meshes;
    for (const Json& node : nodes) {
        const std::optional<uint64_t> mesh = whole_number(node, "mesh");
        if (mesh && whole_number(node, "skin")) meshes.insert(*mesh);
    }
    return meshes;
}

void check_mesh(const Json& mesh) {
    const Json& primitives = member(mesh, "primitives");
    if (!primitives.is_array() || primitives.empty()) throw Failure("it has no primitives");
    if (primitives.size() > kMostPrimitives)
        throw Failure("it has more than " + std::to_string(kMostPrimitives) + " primitives");
    for (const Json& primitive : primitives) check_primitive(primitive);
}

MeshSurface read_surface_of(File& file, DracoMeshes& draco, const Json& mesh) {
    MeshSurface surface;
    const std::vector<double> no_weights;
    const Json& primitives = member(mesh, "primitives");
    for (size_t i = 0; i < primitives.size(); ++i) {
        Primitive primitive(file, draco, primitives[i], no_weights);
        surface.plain_bytes += plain_bytes(file.root(), primitives[i]);
        surface.first_vertex.push_back(static_cast<uint32_t>(surface.mesh.positions.size()));
        const uint64_t total = surface.mesh.positions.size() + primitive.vertices();
        if (total > UINT32_MAX) throw Failure("it has more than 2^32 vertices");
        take(file.memory(), primitive.vertices(), 48, "its vertices");
        append(primitive, static_cast<uint8_t>(i), surface.mesh);
    }
    take(file.memory(), surface.mesh.triangles.size(), 25, "its triangles");
    if (surface.mesh.triangles.empty()) throw Failure("it has no triangles");
    return surface;
}

}  // namespace gim::gltf
