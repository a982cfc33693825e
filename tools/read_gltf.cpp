// glTF 2 and GLB. Reads every triangle primitive of every mesh instance of the scene, in world coordinates, as the
// file's own pose shows it: node transforms, instances, default morph weights and skins are applied, animations are
// not. If colours are wanted, also COLOR_0, base-colour texture with its transform, and base-colour factor. If
// shading is wanted, also NORMAL; a skin leaves it in its rest pose. Skips points, lines, and vertices that no triangle
// uses.
//
// The JSON is read with nlohmann::json, not with a glTF library. tinygltf 2.7, the one that Debian has, refuses valid
// files before a caller sees them (accessors without a buffer view, buffers that only a compression fills), reads every
// file that the JSON names whether it is needed or not, ends in std::bad_alloc at damaged URIs, and bounds no memory.
#include <algorithm>
#include <new>
#include <set>

#include "tools/gltf_extensions.h"
#include "tools/gltf_material.h"
#include "tools/gltf_skin.h"
#include "tools/gltf_uri.h"
#include "tools/mesh_read.h"
#include "tools/polygons.h"

namespace gim {
namespace gltf {
namespace {

// What the triangles of a primitive use, before it is placed.
struct Part {
    std::vector<uint32_t> rows;     // the vertices that triangles use, ascending
    std::vector<uint32_t> corners;  // indices into `rows`, three for each triangle
    std::vector<Eigen::Vector3d> positions;
    uint32_t texture = Textures::kNoTexture;
    std::vector<std::array<float, 2>> texcoords;  // per row; empty without texture
    std::vector<std::array<float, 3>> colors;     // per row; empty if colours are not wanted
    std::vector<Eigen::Vector3d> normals;         // per row; empty: shading is flat
};

Part part_of(Primitive& primitive) {
    Part part;
    part.corners = primitive.corners();
    part.rows = part.corners;
    std::sort(part.rows.begin(), part.rows.end());
    part.rows.erase(std::unique(part.rows.begin(), part.rows.end()), part.rows.end());
    for (uint32_t& corner : part.corners) {
        const auto row = std::lower_bound(part.rows.begin(), part.rows.end(), corner);
        corner = static_cast<uint32_t>(row - part.rows.begin());
    }
    return part;
}

class Reader {
  public:
    Reader(std::string_view text, ReadContext& context)
        : context_(context), file_(text, context), pictures_(file_), nodes_(file_.root()) {}

    Result<TriangleMesh> read() {
        for (std::string& warning : check_extensions(file_.root())) context_.warn(std::move(warning));
        soup_.colors_tint_textures = true;
        for_each_mesh(file_.root(), [&](const MeshInstance& instance) { add_mesh(instance); });
        if (soup_.corners.empty()) throw Failure("its scene has no triangles" + damaged_uri());
        if (!context_.textures) return triangulate(std::move(soup_), context_);
        // All white is the same as no colours.
        if (std::all_of(soup_.vertex_colors.begin(), soup_.vertex_colors.end(), [](const auto& c) {
                return c == std::array<float, 3>{1, 1, 1};
            })) {
            soup_.vertex_colors.clear();
        }
        return triangulate(std::move(soup_), context_);
    }

  private:
    // The same for every instance of a mesh, so it is said once.
    void warn_once(const std::string& text) {
        if (told_.insert(text).second) context_.warn(text);
    }

    // A file without triangles may be a damaged one.
    std::string damaged_uri() const {
        for (const std::string list : {"buffers", "images"}) {
            for (const Json& object : member(file_.root(), list)) {
                const std::string uri = text(object, "uri");
                if (!uri.starts_with("data:") && !percent_decoded(uri)) {
                    return "; in \"" + list + "\" the URI " + shown_uri(uri) +
                           " is damaged: a % is not followed by two hexadecimal digits";
                }
            }
        }
        return "";
    }

    void add_mesh(const MeshInstance& instance) {
        std::vector<double> weights = numbers(instance.node, "weights");
        if (weights.empty()) weights = numbers(instance.mesh, "weights");
        const Json& primitives = member(instance.mesh, "primitives");
        if (!primitives.is_array()) return;
        for (const Json& object : primitives) {
            if (++primitives_ > kMaxPrimitives) throw Failure("its instances have too many primitives");
            Primitive primitive(file_, draco_, object, weights);
            if (primitive.is_surface()) add_primitive(instance, primitive);
        }
    }

    void add_primitive(const MeshInstance& instance, Primitive& primitive) {
        const MorphedColumn positions = primitive.attribute("POSITION", 3);
        Part part = part_of(primitive);
        if (part.corners.empty()) return;
        if (context_.textures) add_colors(primitive, part);
        if (context_.shading && primitive.has("NORMAL")) add_normals(primitive, part);
        if (pose(instance, primitive, positions, part)) return;
        for (const uint32_t row : part.rows) {
            part.positions.emplace_back(positions.at(row, 0), positions.at(row, 1), positions.at(row, 2));
        }
        for (const Eigen::Affine3d& place : instances_of(file_, instance.node)) {
            const Eigen::Affine3d transform = instance.transform * place;
            add_part(part, transform, transform.linear().determinant() < 0);
        }
    }

    // Adds the part as its skin moves it. False if it has none that can be applied.
    bool pose(const MeshInstance& instance, Primitive& primitive, const MorphedColumn& positions, Part& part) {
        const std::optional<uint64_t> skin = whole_number(instance.node, "skin");
        if (!skin) return false;
        try {
            SkinnedVertices skinned = apply_skin(file_, nodes_, *skin, primitive, positions, part.rows);
            part.positions = std::move(skinned.positions);
            add_part(part, Eigen::Affine3d::Identity(), skinned.mirrored);
        } catch (const Failure& failure) {
            warn_once("skin " + std::to_string(*skin) + " of the glTF file cannot be applied: " + failure.what() +
                      "; its mesh keeps its rest pose");
            return false;
        }
        if (extension(instance.node, "EXT_mesh_gpu_instancing").is_object()) {
            warn_once("the instances (EXT_mesh_gpu_instancing) of a mesh with a skin are left out");
        }
        return true;
    }

    // Colours that do not fit are left out with a warning, since the shape does not need them.
    void add_colors(Primitive& primitive, Part& part) {
        part.colors.assign(part.rows.size(), {1, 1, 1});
        try {
            const BaseColor base = base_color(file_.root(), primitive.object());
            add_texture(primitive, base, part);
            MorphedColumn own;
            const bool has_own = primitive.has("COLOR_0");
            if (has_own) own = primitive.attribute("COLOR_0", 3);
            for (size_t i = 0; i < part.rows.size(); ++i) {
                for (size_t k = 0; k < 3; ++k) {
                    part.colors[i][k] = to_srgb(base.factor[k] * (has_own ? own.at(part.rows[i], k) : 1));
                }
            }
        } catch (const Failure& failure) {
            warn_once(std::string("colours of the glTF file: ") + failure.what() + "; they are left out");
        }
    }

    // Normals that do not fit are left out with a warning, since the shape does not need them.
    void add_normals(Primitive& primitive, Part& part) {
        try {
            const MorphedColumn normals = primitive.attribute("NORMAL", 3);
            for (const uint32_t row : part.rows)
                part.normals.emplace_back(normals.at(row, 0), normals.at(row, 1), normals.at(row, 2));
        } catch (const Failure& failure) {
            warn_once(std::string("normals of the glTF file: ") + failure.what() + "; they are left out");
        }
    }

    void add_texture(Primitive& primitive, const BaseColor& base, Part& part) {
        const std::string set = "TEXCOORD_" + std::to_string(base.texcoord_set);
        if (!base.texture || !primitive.has(set)) return;
        const MorphedColumn uv = primitive.attribute(set, 2);
        part.texture = pictures_.load(*base.texture);
        if (part.texture == Textures::kNoTexture) return;
        for (const uint32_t row : part.rows) {
            const double u = uv.at(row, 0);
            const double v = uv.at(row, 1);
            part.texcoords.push_back({static_cast<float>(base.to_u[0] * u + base.to_u[1] * v + base.to_u[2]),
                                      static_cast<float>(base.to_v[0] * u + base.to_v[1] * v + base.to_v[2])});
        }
    }

    void add_part(const Part& part, const Eigen::Affine3d& transform, bool mirrored) {
        if (soup_.corners.size() + part.corners.size() > kMaxCorners) {
            throw Failure("its instances have too many triangles");
        }
        const Result<void> fits = take_memory(part.rows.size(), part.corners.size(), context_);
        if (!fits.ok()) throw Failure(fits.error().message);
        const auto base = static_cast<int64_t>(soup_.positions.size());
        for (const Eigen::Vector3d& position : part.positions) {
            const Eigen::Vector3d p = transform * position;
            soup_.positions.push_back({p.x(), p.y(), p.z()});
        }
        // The cofactors turn normals as the transform turns surfaces, but for the sign of a mirror.
        const Eigen::Matrix3d& m = transform.linear();
        Eigen::Matrix3d cofactors;
        for (int k = 0; k < 3; ++k) cofactors.col(k) = m.col((k + 1) % 3).cross(m.col((k + 2) % 3));
        const auto first_normal = static_cast<uint32_t>(soup_.normals.size());
        for (const Eigen::Vector3d& normal : part.normals) {
            const Eigen::Vector3d n = (cofactors * normal).stableNormalized() * (mirrored ? -1 : 1);
            soup_.normals.push_back({static_cast<float>(n.x()), static_cast<float>(n.y()), static_cast<float>(n.z())});
        }
        soup_.vertex_colors.insert(soup_.vertex_colors.end(), part.colors.begin(), part.colors.end());
        for (size_t i = 0; i < part.corners.size(); i += 3) {
            std::array<uint32_t, 3> face = {part.corners[i], part.corners[i + 1], part.corners[i + 2]};
            if (mirrored) std::swap(face[1], face[2]);
            soup_.add_face(std::array<int64_t, 3>{base + face[0], base + face[1], base + face[2]});
            for (size_t k = 0; k < 3 && context_.shading; ++k)
                soup_.corner_normals.push_back(part.normals.empty() ? Shading::kFlat : first_normal + face[k]);
            if (!context_.textures) continue;
            soup_.face_texture.push_back(part.texture);
            for (const uint32_t corner : face) {
                soup_.corner_texcoords.push_back(part.texcoords.empty() ? std::array<float, 2>{}
                                                                        : part.texcoords[corner]);
            }
        }
    }

    static constexpr uint64_t kMaxCorners = 3ULL << 30;     // instances of instances multiply quickly
    static constexpr uint64_t kMaxPrimitives = 1ULL << 20;  // so do their empty primitives

    ReadContext& context_;
    File file_;
    Pictures pictures_;
    NodeTransforms nodes_;
    DracoMeshes draco_;
    PolygonSoup soup_;
    std::set<std::string> told_;
    uint64_t primitives_ = 0;
};

}  // namespace
}  // namespace gltf

Result<TriangleMesh> read_gltf(std::string_view text, ReadContext& context) {
    try {
        return gltf::Reader(text, context).read();
    } catch (const std::bad_alloc&) {
        return Error{Stage::kInput, "there is not enough memory for it"};
    } catch (const std::exception& failure) {
        return Error{Stage::kInput, failure.what()};
    }
}

}  // namespace gim
