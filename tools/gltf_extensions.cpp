#include "tools/gltf_extensions.h"

#include <algorithm>
#include <array>

namespace gim::gltf {
namespace {

constexpr std::array<std::string_view, 10> kRead = {
    "KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression",
    "KHR_mesh_quantization",      "KHR_texture_transform",   "EXT_mesh_gpu_instancing",
    "KHR_node_visibility",        "KHR_materials_unlit",     "KHR_materials_pbrSpecularGlossiness",
    "KHR_accessor_float64",
};

// Image formats: a texture that needs one gets a warning when it is loaded, since the shape does not need it.
constexpr std::array<std::string_view, 4> kImages = {"EXT_texture_webp", "KHR_texture_basisu", "EXT_texture_avif",
                                                     "MSFT_texture_dds"};

// They change neither the surface nor its base colour: lights, cameras, sound, metadata, physics, behaviour.
constexpr std::array<std::string_view, 27> kHarmlessBeginnings = {
    "KHR_materials_",
    "EXT_materials_",
    "ADOBE_materials_",
    "MSFT_lod",
    "MSFT_packing_",
    "MSFT_audio_",
    "KHR_lights_",
    "EXT_lights_",
    "KHR_xmp",
    "KHR_animation_pointer",
    "KHR_audio",
    "KHR_physics_",
    "KHR_collision_shapes",
    "KHR_implicit_shapes",
    "KHR_interactivity",
    "KHR_node_selectability",
    "KHR_node_hoverability",
    "KHR_techniques_webgl",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "EXT_feature_metadata",
    "EXT_instance_features",
    "CESIUM_primitive_outline",
    "FB_",
    "VRM",
    "AGI_",
};

bool may_change_the_surface(std::string_view name) {
    const auto is_name = [&](std::string_view known) { return known == name; };
    const auto begins = [&](std::string_view beginning) { return name.starts_with(beginning); };
    return std::none_of(kRead.begin(), kRead.end(), is_name) && std::none_of(kImages.begin(), kImages.end(), is_name) &&
           std::none_of(kHarmlessBeginnings.begin(), kHarmlessBeginnings.end(), begins);
}

std::vector<std::string> strange_names(const Json& root, const std::string& list) {
    std::vector<std::string> names;
    const Json& all = member(root, list);
    if (!all.is_array()) return names;
    for (const Json& name : all) {
        if (name.is_string() && may_change_the_surface(name.get_ref<const std::string&>())) {
            names.push_back(name.get<std::string>());
        }
    }
    return names;
}

}  // namespace

std::vector<std::string> check_extensions(const Json& root) {
    const std::vector<std::string> required = strange_names(root, "extensionsRequired");
    if (std::find(required.begin(), required.end(), "EXT_gim_geometry") != required.end())
        throw Failure("its meshes are .gim (EXT_gim_geometry); make plain glTF of it first: gim decode IN.glb OUT.glb");
    if (!required.empty()) {
        std::string list = required.front();
        for (size_t i = 1; i < required.size(); ++i) list += ", " + required[i];
        throw Failure("it requires " + list + ", which gim does not know; export it without");
    }
    std::vector<std::string> warnings;
    for (const std::string& name : strange_names(root, "extensionsUsed")) {
        warnings.push_back("glTF: it uses " + name + ", which gim does not know; what it changes is left out");
    }
    return warnings;
}

}  // namespace gim::gltf
