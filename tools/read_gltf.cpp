// glTF 2: every triangle primitive of every mesh instance of the scene, in world coordinates (node transforms applied).
// Points and lines are skipped; skins and morph targets stay in their rest pose. Compressed files (Draco, meshopt) and
// sparse accessors are refused with a message.
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <array>
#include <exception>
#include <string>

#include "tools/little_endian.h"
#include "tools/mesh_read.h"
#include "tools/polygons.h"

namespace gim {
namespace {

constexpr int kMaxNodeDepth = 256;            // deeper trees are cycles or nonsense
constexpr uint64_t kMaxCorners = 3ULL << 30;  // instances of instances multiply quickly

struct Failure : std::exception {
    explicit Failure(std::string what) : message(std::move(what)) {}
    const char* what() const noexcept override { return message.c_str(); }
    std::string message;
};

const char* at(const tinygltf::Model& model, const tinygltf::Accessor& accessor, size_t& stride) {
    if (accessor.sparse.isSparse) throw Failure("it uses sparse accessors; convert it to plain ones");
    if (accessor.bufferView < 0 || static_cast<size_t>(accessor.bufferView) >= model.bufferViews.size()) {
        throw Failure("an accessor has no buffer view");
    }
    const tinygltf::BufferView& view = model.bufferViews[static_cast<size_t>(accessor.bufferView)];
    if (view.buffer < 0 || static_cast<size_t>(view.buffer) >= model.buffers.size()) {
        throw Failure("a buffer view has no buffer");
    }
    const std::vector<unsigned char>& data = model.buffers[static_cast<size_t>(view.buffer)].data;
    const int step = accessor.ByteStride(view);
    const int width = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)) *
                      tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
    if (step <= 0 || width <= 0) throw Failure("an accessor has an unknown type");
    stride = static_cast<size_t>(step);
    const uint64_t room = data.size();
    const bool inside = view.byteOffset <= room && accessor.byteOffset <= room - view.byteOffset &&
                        (accessor.count == 0 || (accessor.count - 1 <= room / stride &&
                                                 (accessor.count - 1) * stride + static_cast<uint64_t>(width) <=
                                                     room - view.byteOffset - accessor.byteOffset));
    if (!inside) throw Failure("an accessor reaches beyond its buffer (is the file cut short?)");
    return reinterpret_cast<const char*>(data.data()) + view.byteOffset + accessor.byteOffset;
}

const tinygltf::Accessor& accessor_of(const tinygltf::Model& model, int index) {
    if (index < 0 || static_cast<size_t>(index) >= model.accessors.size()) throw Failure("an accessor is missing");
    return model.accessors[static_cast<size_t>(index)];
}

double component(const char* bytes, int type, bool normalized) {
    switch (type) {
        case TINYGLTF_COMPONENT_TYPE_BYTE:
            return normalized ? std::max(load<int8_t>(bytes) / 127.0, -1.0) : load<int8_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
            return load<uint8_t>(bytes) / (normalized ? 255.0 : 1.0);
        case TINYGLTF_COMPONENT_TYPE_SHORT:
            return normalized ? std::max(load<int16_t>(bytes) / 32767.0, -1.0) : load<int16_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
            return load<uint16_t>(bytes) / (normalized ? 65535.0 : 1.0);
        case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
            return load<uint32_t>(bytes);
        case TINYGLTF_COMPONENT_TYPE_FLOAT:
            return static_cast<double>(load<float>(bytes));
        case TINYGLTF_COMPONENT_TYPE_DOUBLE:
            return load<double>(bytes);
        default:
            throw Failure("an accessor has an unknown component type");
    }
}

Eigen::Affine3d transform_of(const tinygltf::Node& node) {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (node.matrix.size() == 16) {
        transform.matrix() = Eigen::Map<const Eigen::Matrix4d>(node.matrix.data());
        return transform;
    }
    if (node.translation.size() == 3) transform.translate(Eigen::Map<const Eigen::Vector3d>(node.translation.data()));
    if (node.rotation.size() == 4) {
        const std::vector<double>& q = node.rotation;
        transform.rotate(Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized());
    }
    if (node.scale.size() == 3) transform.scale(Eigen::Map<const Eigen::Vector3d>(node.scale.data()));
    return transform;
}

// Calls emit(a, b, c) for the triangles of a primitive whose corners are 0 .. count-1.
template <class Emit>
void for_each_triangle(int mode, size_t count, const Emit& emit) {
    if (mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
        for (size_t i = 2; i < count; ++i) i % 2 == 0 ? emit(i - 2, i - 1, i) : emit(i - 1, i - 2, i);
    } else if (mode == TINYGLTF_MODE_TRIANGLE_FAN) {
        for (size_t i = 2; i < count; ++i) emit(0, i - 1, i);
    } else {
        for (size_t i = 2; i < count; i += 3) emit(i - 2, i - 1, i);
    }
}

void add_primitive(const tinygltf::Model& model, const tinygltf::Primitive& primitive, const Eigen::Affine3d& transform,
                   PolygonSoup& soup) {
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) return;
    for (const char* extension : {"KHR_draco_mesh_compression", "EXT_meshopt_compression"}) {
        if (primitive.extensions.count(extension) != 0) {
            throw Failure(std::string("it is compressed (") + extension + "); decompress it first");
        }
    }
    const auto found = primitive.attributes.find("POSITION");
    if (found == primitive.attributes.end()) return;
    const tinygltf::Accessor& points = accessor_of(model, found->second);
    if (points.type != TINYGLTF_TYPE_VEC3) throw Failure("POSITION is no vector of three");

    const auto base = static_cast<int64_t>(soup.positions.size());
    size_t stride = 0;
    const char* bytes = at(model, points, stride);
    const int size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(points.componentType));
    for (size_t i = 0; i < points.count; ++i, bytes += stride) {
        Eigen::Vector3d p;
        for (int k = 0; k < 3; ++k) p[k] = component(bytes + k * size, points.componentType, points.normalized);
        p = transform * p;
        soup.positions.push_back({p.x(), p.y(), p.z()});
    }

    std::vector<int64_t> corners;
    if (primitive.indices >= 0) {
        const tinygltf::Accessor& indices = accessor_of(model, primitive.indices);
        if (indices.type != TINYGLTF_TYPE_SCALAR) throw Failure("indices are no scalars");
        const char* index = at(model, indices, stride);
        corners.reserve(indices.count);
        for (size_t i = 0; i < indices.count; ++i, index += stride) {
            const auto corner = static_cast<int64_t>(component(index, indices.componentType, false));
            // Checked here: seen over all primitives together it might be another one's vertex.
            if (corner < 0 || static_cast<uint64_t>(corner) >= points.count) {
                throw Failure("an index is " + std::to_string(corner) + ", but its primitive has only " +
                              std::to_string(points.count) + " vertices");
            }
            corners.push_back(corner);
        }
    } else {
        for (size_t i = 0; i < points.count; ++i) corners.push_back(static_cast<int64_t>(i));
    }
    if (soup.corners.size() + 3 * corners.size() > kMaxCorners) throw Failure("its instances have too many triangles");
    const bool mirrored = transform.linear().determinant() < 0;
    for_each_triangle(mode, corners.size(), [&](size_t a, size_t b, size_t c) {
        if (mirrored) std::swap(b, c);
        soup.add_face(std::array<int64_t, 3>{base + corners[a], base + corners[b], base + corners[c]});
    });
}

void add_node(const tinygltf::Model& model, int index, const Eigen::Affine3d& parent, int depth, PolygonSoup& soup) {
    if (index < 0 || static_cast<size_t>(index) >= model.nodes.size()) throw Failure("a node is missing");
    if (depth > kMaxNodeDepth) throw Failure("its nodes are nested too deeply (a cycle?)");
    const tinygltf::Node& node = model.nodes[static_cast<size_t>(index)];
    const Eigen::Affine3d transform = parent * transform_of(node);
    if (node.mesh >= 0) {
        if (static_cast<size_t>(node.mesh) >= model.meshes.size()) throw Failure("a mesh is missing");
        for (const tinygltf::Primitive& primitive : model.meshes[static_cast<size_t>(node.mesh)].primitives) {
            add_primitive(model, primitive, transform, soup);
        }
    }
    for (const int child : node.children) add_node(model, child, transform, depth + 1, soup);
}

std::vector<int> root_nodes(const tinygltf::Model& model) {
    if (!model.scenes.empty()) {
        const auto scene = static_cast<size_t>(std::max(model.defaultScene, 0));
        if (scene >= model.scenes.size()) throw Failure("its scene is missing");
        return model.scenes[scene].nodes;
    }
    std::vector<char> is_child(model.nodes.size(), 0);
    for (const tinygltf::Node& node : model.nodes) {
        for (const int child : node.children) {
            if (child >= 0 && static_cast<size_t>(child) < is_child.size()) is_child[static_cast<size_t>(child)] = 1;
        }
    }
    std::vector<int> roots;
    for (size_t i = 0; i < is_child.size(); ++i) {
        if (is_child[i] == 0) roots.push_back(static_cast<int>(i));
    }
    return roots;
}

// Pictures are not needed: accept them unseen.
bool skip_image(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*) {
    return true;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

Result<TriangleMesh> read_gltf(std::string_view text, const std::string& folder) {
    if (text.size() > UINT32_MAX) return Error{Stage::kInput, "glTF files end at 4 GB"};
    try {
        tinygltf::TinyGLTF loader;
        loader.SetImageLoader(skip_image, nullptr);
        tinygltf::Model model;
        std::string error;
        std::string warning;
        const auto size = static_cast<unsigned int>(text.size());
        const bool loaded =
            text.starts_with("glTF")
                ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                              reinterpret_cast<const unsigned char*>(text.data()), size, folder)
                : loader.LoadASCIIFromString(&model, &error, &warning, text.data(), size, folder);
        if (!loaded) return Error{Stage::kInput, "glTF: " + first_line(error)};

        PolygonSoup soup;
        for (const int root : root_nodes(model)) add_node(model, root, Eigen::Affine3d::Identity(), 0, soup);
        if (soup.positions.empty()) return Error{Stage::kInput, "its scene shows no triangles"};
        return triangulate(std::move(soup));
    } catch (const std::exception& failure) {
        return Error{Stage::kInput, std::string("glTF: ") + failure.what()};
    }
}

}  // namespace gim
