#include "tools/encode_glb.h"

#include <algorithm>
#include <new>
#include <utility>

#include "tools/glb_meshes.h"
#include "tools/glb_primitives.h"
#include "tools/glb_textures.h"
#include "tools/gltf_extensions.h"

namespace gim {
namespace gltf {
namespace {

class GlbEncoder {
  public:
    GlbEncoder(std::string_view text, ReadContext& context, const GlbEncodeOptions& options)
        : context_(context),
          options_(options),
          file_(text, context),
          document_(file_),
          baker_(file_, draco_, document_, options.mesh.threads) {}

    Result<EncodedGlb> run() {
        (void)check_extensions(file_.root());  // fails where a required one is not known; all others are kept
        if (!may_renumber(file_.root()))
            context_.warn("it uses an extension that gim does not know; so all of the old data stays in the file");
        const Json& meshes = member(file_.root(), "meshes");
        const size_t count = meshes.is_array() ? meshes.size() : 0;
        const std::set<uint64_t> skinned = skinned_meshes(file_.root());
        EncodedGlb out;
        for (size_t i = 0; i < count; ++i) {
            GlbMeshReport report;
            report.name = text(meshes[i], "name", "mesh " + std::to_string(i));
            try {
                if (skinned.contains(i)) throw Failure("a skin moves it");
                check_mesh(meshes[i]);
                baker_.check(meshes[i]);
                const Progress progress = options_.begin_mesh ? options_.begin_mesh(i, count, report.name) : Progress();
                if (!encode_mesh(i, progress, report)) return cancelled_;
            } catch (const Failure& failure) {
                context_.warn("mesh " + std::to_string(i) + " (" + report.name + ") stays as it is: " + failure.what());
            }
            out.meshes.push_back(std::move(report));
        }
        if (is_anything_carried(out)) declare_extension(document_.root, kGimExtension, options_.fallback_uri.empty());
        forget_unused_extensions();
        GlbDocument::Output output = document_.finish(options_.fallback_uri);
        out.glb = std::move(output.glb);
        out.fallback = std::move(output.fallback);
        return out;
    }

  private:
    static bool is_anything_carried(const EncodedGlb& out) {
        return std::any_of(out.meshes.begin(), out.meshes.end(), [](const auto& mesh) { return mesh.is_carried; });
    }

    // Throws a Failure if the mesh must stay as it is. Returns false if the caller wants to stop.
    bool encode_mesh(size_t index, const Progress& progress, GlbMeshReport& report) {
        const Json& mesh = file_.root()["meshes"][index];
        const MeshSurface surface = read_surface_of(file_, draco_, mesh);
        Result<Encoded> encoded = encode(surface.mesh, options_.mesh, progress);
        if (!encoded.ok() && encoded.error().is_cancelled) {
            cancelled_ = encoded.error();
            return false;
        }
        if (!encoded.ok())
            throw Failure(std::string(stage_name(encoded.error().stage)) + ": " + encoded.error().message);
        for (const std::string& warning : encoded.value().report.warnings)
            context_.warn("mesh " + std::to_string(index) + " (" + report.name + "): " + warning);
        report.plain_bytes = surface.plain_bytes;
        report.gim_bytes = encoded.value().bytes.size();
        report.psnr = encoded.value().report.error.psnr;
        if (report.gim_bytes >= report.plain_bytes) {
            throw Failure("a .gim of it takes " + std::to_string(report.gim_bytes) + " bytes, its arrays only " +
                          std::to_string(report.plain_bytes) + "; ask for less quality, or fewer samples");
        }
        replace(index, surface, std::move(encoded.value().bytes));
        report.report = std::move(encoded.value().report);
        report.is_carried = true;
        return true;
    }

    // Puts the .gim in place of the arrays of the mesh's primitives, and new textures in place of the old ones.
    void replace(size_t index, const MeshSurface& surface, Bytes gim) {
        const Json& mesh = file_.root()["meshes"][index];
        const size_t count = mesh["primitives"].size();
        Result<GimGeometry> decoded = decode_geometry(gim, 0);
        if (!decoded.ok()) throw Failure(decoded.error().message);
        GimGeometry& geometry = decoded.value();
        std::vector<WantedArrays> wanted(count);
        bool is_textured = false;
        for (size_t p = 0; p < count; ++p) {
            wanted[p] = baker_.wanted(mesh["primitives"][p]);
            if (count > 1) wanted[p].label = static_cast<uint32_t>(p);
            is_textured = is_textured || wanted[p].texcoords;
        }
        const std::vector<AtlasPlace> places = is_textured ? places_of(geometry.images) : std::vector<AtlasPlace>{};
        if (!places.empty()) geometry.places = places;
        std::vector<PrimitiveArrays> arrays;
        for (size_t p = 0; p < count; ++p) {
            arrays.push_back(arrays_of(geometry, wanted[p]));
            if (arrays.back().indices.empty())
                throw Failure("its primitive " + std::to_string(p) + " is smaller than a cell; take more samples");
        }
        const std::vector<std::optional<size_t>> materials = baker_.bake(mesh, surface, geometry);
        const size_t view = document_.add_view(std::move(gim), GlbDocument::Place::kGeometry);
        const ArrayData data = options_.fallback_uri.empty() ? ArrayData::kNone : ArrayData::kFallback;
        for (size_t p = 0; p < count; ++p) {
            Json primitive = mesh["primitives"][p];
            if (materials[p]) primitive["material"] = *materials[p];
            erase_extension(primitive, "KHR_draco_mesh_compression");
            set_arrays(document_, primitive, arrays[p], data);
            set_gim_extension(primitive, view, wanted[p].label,
                              wanted[p].texcoords ? places : std::vector<AtlasPlace>{});
            document_.root["meshes"][index]["primitives"][p] = std::move(primitive);
        }
    }

    // Draco stays declared as long as a primitive has it.
    void forget_unused_extensions() {
        constexpr const char* kDraco = "KHR_draco_mesh_compression";
        bool is_used = false;
        for (const Json& mesh : member(document_.root, "meshes"))
            for (const Json& primitive : member(mesh, "primitives"))
                is_used = is_used || !extension(primitive, kDraco).is_null();
        if (!is_used) forget_extension(document_.root, kDraco);
    }

    ReadContext& context_;
    const GlbEncodeOptions& options_;
    File file_;
    DracoMeshes draco_;
    GlbDocument document_;
    TextureBaker baker_;
    Error cancelled_;
};

// The primitives of a mesh with their arrays.
class GlbDecoder {
  public:
    GlbDecoder(std::string_view text, ReadContext& context, uint32_t level)
        : level_(level), file_(text, context), document_(file_) {}

    Bytes run() {
        Json& meshes = document_.root["meshes"];
        for (size_t i = 0; meshes.is_array() && i < meshes.size(); ++i) {
            try {
                decode_mesh(meshes[i]);
            } catch (const Failure& failure) {
                throw Failure("mesh " + std::to_string(i) + ": " + failure.what());
            }
        }
        if (meshes.is_null()) document_.root.erase("meshes");
        forget_extension(document_.root, kGimExtension);
        return document_.finish("").glb;
    }

  private:
    // Coarse levels may have no cell of a small primitive. Then the mesh goes without it.
    void decode_mesh(Json& mesh) {
        if (!member(mesh, "primitives").is_array()) return;
        Json primitives = Json::array();
        for (Json& primitive : mesh["primitives"]) {
            const std::optional<GimPrimitive> told = read_gim_primitive(primitive);
            if (told) {
                const PrimitiveArrays arrays = arrays_of(geometry(*told), told->wanted());
                if (arrays.indices.empty()) continue;
                erase_extension(primitive, kGimExtension);
                set_arrays(document_, primitive, arrays, ArrayData::kPlain);
            }
            primitives.push_back(primitive);
        }
        if (primitives.empty()) throw Failure("none of its primitives has triangles");
        mesh["primitives"] = std::move(primitives);
    }

    // The primitives of a mesh share one; they follow each other.
    const GimGeometry& geometry(const GimPrimitive& told) {
        if (last_view_ != told.view) {
            const std::span<const uint8_t> bytes = file_.view(told.view);
            Result<GimGeometry> decoded = decode_geometry({bytes.begin(), bytes.end()}, level_, told.places);
            if (!decoded.ok()) throw Failure(decoded.error().message);
            last_ = std::move(decoded.value());
            last_view_ = told.view;
        }
        return last_;
    }

    const uint32_t level_;
    File file_;
    GlbDocument document_;
    std::optional<uint64_t> last_view_;
    GimGeometry last_;
};

}  // namespace
}  // namespace gltf

namespace {

// Turns what a reader throws into an Error.
template <class F>
auto guarded_read(const F& f) -> decltype(f()) {
    try {
        return f();
    } catch (const std::bad_alloc&) {
        return Error{Stage::kInput, "there is not enough memory for it"};
    } catch (const std::exception& failure) {
        return Error{Stage::kInput, failure.what()};
    }
}

}  // namespace

Result<EncodedGlb> encode_glb(std::string_view text, ReadContext& context, const GlbEncodeOptions& options) {
    return guarded_read([&]() -> Result<EncodedGlb> { return gltf::GlbEncoder(text, context, options).run(); });
}

Result<Bytes> decode_glb(std::string_view text, ReadContext& context, uint32_t level) {
    return guarded_read([&]() -> Result<Bytes> { return gltf::GlbDecoder(text, context, level).run(); });
}

bool has_gim_geometry(std::string_view text) {
    return text.find(std::string("\"") + gltf::kGimExtension + "\"") != std::string_view::npos;
}

}  // namespace gim
