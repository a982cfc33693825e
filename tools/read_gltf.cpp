// glTF 2. Reads every triangle primitive of every mesh instance of the scene, in world coordinates (node transforms
// applied). If colours are wanted, also COLOR_0, base-colour texture (without texture transforms) and base-colour
// factor. Skips points and lines. Skins and morph targets stay in their rest pose. Refuses compressed files (Draco,
// meshopt) and sparse accessors with a message.
#include <tiny_gltf.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
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

float to_srgb(double x) {
    x = x >= 0 ? std::min(x, 1.0) : 0;
    return static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
}

// Returns the values of an attribute, `width` numbers for each vertex. Empty if the primitive does not have it.
std::vector<double> attribute(const tinygltf::Model& model, const tinygltf::Primitive& primitive,
                              const std::string& name, size_t vertices, size_t width) {
    std::vector<double> values;
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return values;
    const tinygltf::Accessor& accessor = accessor_of(model, found->second);
    const int numbers = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
    if (accessor.count != vertices || numbers < static_cast<int>(width))
        throw Failure(name + " does not match POSITION in count or type");
    size_t stride = 0;
    const char* bytes = at(model, accessor, stride);
    const size_t size =
        static_cast<size_t>(tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(accessor.componentType)));
    values.reserve(vertices * width);
    for (size_t i = 0; i < vertices; ++i, bytes += stride) {
        for (size_t k = 0; k < width; ++k) {
            values.push_back(component(bytes + k * size, accessor.componentType, accessor.normalized));
        }
    }
    return values;
}

// Keeps image files as tinygltf hands them over. Decodes one when it is first needed.
class Pictures {
  public:
    explicit Pictures(Textures* textures) : textures_(textures) {}

    // Returns nullptr if colours are not wanted.
    Textures* textures() const { return textures_; }
    void keep(int image, const unsigned char* bytes, int size) {
        if (!textures_ || image < 0 || image > 65535) return;
        if (files_.size() <= static_cast<size_t>(image)) files_.resize(static_cast<size_t>(image) + 1);
        files_[static_cast<size_t>(image)].assign(bytes, bytes + size);
    }
    // Returns the texture of this glTF index. kNoTexture if it is missing, with a warning if its image is.
    uint32_t load(const tinygltf::Model& model, int texture) {
        if (texture < 0 || static_cast<size_t>(texture) >= model.textures.size()) return Textures::kNoTexture;
        const int image = model.textures[static_cast<size_t>(texture)].source;
        for (const auto& [known, index] : loaded_) {
            if (known == image) return index;
        }
        const bool is_there = image >= 0 && static_cast<size_t>(image) < files_.size();
        const std::string name = std::to_string(image) + " of the glTF file";
        const uint32_t index = textures_->add(
            is_there ? std::span<const uint8_t>(files_[static_cast<size_t>(image)]) : std::span<const uint8_t>(), name);
        loaded_.emplace_back(image, index);
        return index;
    }

  private:
    Textures* textures_;
    std::vector<std::vector<uint8_t>> files_;
    std::vector<std::pair<int, uint32_t>> loaded_;
};

// Texture and texture coordinates of a primitive. Its vertex colours go straight into the soup.
struct PrimitiveColors {
    uint32_t texture = Textures::kNoTexture;
    std::vector<std::array<float, 2>> texcoords;  // per vertex; empty without texture
};

PrimitiveColors add_colors(const tinygltf::Model& model, const tinygltf::Primitive& primitive, size_t vertices,
                           Pictures& pictures, PolygonSoup& soup) {
    PrimitiveColors colors;
    std::array<double, 3> factor = {1, 1, 1};
    if (primitive.material >= 0 && static_cast<size_t>(primitive.material) < model.materials.size()) {
        const auto& look = model.materials[static_cast<size_t>(primitive.material)].pbrMetallicRoughness;
        if (look.baseColorFactor.size() >= 3) std::copy_n(look.baseColorFactor.begin(), 3, factor.begin());
        const std::vector<double> uv =
            look.baseColorTexture.index < 0
                ? std::vector<double>()
                : attribute(model, primitive, "TEXCOORD_" + std::to_string(look.baseColorTexture.texCoord), vertices,
                            2);
        if (!uv.empty()) colors.texture = pictures.load(model, look.baseColorTexture.index);
        for (size_t i = 0; i + 1 < uv.size() && colors.texture != Textures::kNoTexture; i += 2)
            colors.texcoords.push_back({static_cast<float>(uv[i]), static_cast<float>(uv[i + 1])});
    }
    const std::vector<double> own = attribute(model, primitive, "COLOR_0", vertices, 3);
    for (size_t v = 0; v < vertices; ++v) {
        std::array<float, 3> color;
        for (size_t k = 0; k < 3; ++k) color[k] = to_srgb(factor[k] * (own.empty() ? 1 : own[3 * v + k]));
        soup.vertex_colors.push_back(color);
    }
    return colors;
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
                   Pictures& pictures, PolygonSoup& soup) {
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
    if (points.type != TINYGLTF_TYPE_VEC3) throw Failure("POSITION is not a vector of three numbers");

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

    PrimitiveColors colors;
    if (pictures.textures()) colors = add_colors(model, primitive, points.count, pictures, soup);
    std::vector<int64_t> corners;
    if (primitive.indices >= 0) {
        const tinygltf::Accessor& indices = accessor_of(model, primitive.indices);
        if (indices.type != TINYGLTF_TYPE_SCALAR) throw Failure("the indices are not scalars");
        const char* index = at(model, indices, stride);
        corners.reserve(indices.count);
        for (size_t i = 0; i < indices.count; ++i, index += stride) {
            const auto corner = static_cast<int64_t>(component(index, indices.componentType, false));
            // Checked here, because in the soup a wrong index may be a vertex of another primitive.
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
        if (!pictures.textures()) return;
        soup.face_texture.push_back(colors.texture);
        for (const size_t i : {a, b, c}) {
            soup.corner_texcoords.push_back(
                colors.texcoords.empty() ? std::array<float, 2>{} : colors.texcoords[static_cast<size_t>(corners[i])]);
        }
    });
}

void add_node(const tinygltf::Model& model, int index, const Eigen::Affine3d& parent, int depth, Pictures& pictures,
              PolygonSoup& soup) {
    if (index < 0 || static_cast<size_t>(index) >= model.nodes.size()) throw Failure("a node is missing");
    if (depth > kMaxNodeDepth) throw Failure("its nodes are nested too deeply (a cycle?)");
    const tinygltf::Node& node = model.nodes[static_cast<size_t>(index)];
    const Eigen::Affine3d transform = parent * transform_of(node);
    if (node.mesh >= 0) {
        if (static_cast<size_t>(node.mesh) >= model.meshes.size()) throw Failure("a mesh is missing");
        for (const tinygltf::Primitive& primitive : model.meshes[static_cast<size_t>(node.mesh)].primitives) {
            add_primitive(model, primitive, transform, pictures, soup);
        }
    }
    for (const int child : node.children) add_node(model, child, transform, depth + 1, pictures, soup);
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

// Keeps the bytes of an image without decoding them.
bool keep_image(tinygltf::Image*, const int index, std::string*, std::string*, int, int, const unsigned char* bytes,
                int size, void* pictures) {
    static_cast<Pictures*>(pictures)->keep(index, bytes, size);
    return true;
}

std::string first_line(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

Result<TriangleMesh> read_gltf(std::string_view text, ReadContext& context) {
    Textures* const textures = context.textures;
    if (text.size() > UINT32_MAX) return Error{Stage::kInput, "glTF files may have at most 4 GB; convert it to PLY"};
    try {
        tinygltf::TinyGLTF loader;
        Pictures pictures(textures);
        loader.SetImageLoader(keep_image, &pictures);
        tinygltf::Model model;
        std::string error;
        std::string warning;
        const auto size = static_cast<unsigned int>(text.size());
        const bool loaded =
            text.starts_with("glTF")
                ? loader.LoadBinaryFromMemory(&model, &error, &warning,
                                              reinterpret_cast<const unsigned char*>(text.data()), size, context.folder)
                : loader.LoadASCIIFromString(&model, &error, &warning, text.data(), size, context.folder);
        if (!loaded) return Error{Stage::kInput, "glTF: " + first_line(error)};

        PolygonSoup soup;
        soup.colors_tint_textures = true;
        for (const int root : root_nodes(model)) {
            add_node(model, root, Eigen::Affine3d::Identity(), 0, pictures, soup);
        }
        if (soup.positions.empty()) return Error{Stage::kInput, "its scene has no triangles"};
        if (!textures) return triangulate(std::move(soup));
        // All white is the same as no colours.
        if (std::all_of(soup.vertex_colors.begin(), soup.vertex_colors.end(), [](const auto& c) {
                return c == std::array<float, 3>{1, 1, 1};
            })) {
            soup.vertex_colors.clear();
        }
        return triangulate(std::move(soup), std::move(textures->images));
    } catch (const std::exception& failure) {
        return Error{Stage::kInput, std::string("glTF: ") + failure.what()};
    }
}

}  // namespace gim
