#include "tools/gltf_references.h"

#include <algorithm>
#include <array>

namespace gim::gltf {
namespace {

using Use = std::function<void(Json&)>;

// Extensions whose references for_each_reference() knows, or that have none.
constexpr std::array<std::string_view, 17> kKnown = {
    "EXT_gim_geometry",      "EXT_mesh_gpu_instancing", "EXT_meshopt_compression",    "EXT_texture_avif",
    "EXT_texture_webp",      "KHR_accessor_float64",    "KHR_draco_mesh_compression", "KHR_lights_punctual",
    "KHR_mesh_quantization", "KHR_meshopt_compression", "KHR_node_hoverability",      "KHR_node_selectability",
    "KHR_node_visibility",   "KHR_texture_basisu",      "KHR_texture_transform",      "KHR_xmp_json_ld",
    "MSFT_texture_dds",
};

// Calls f for the elements of a member that is a list.
template <class F>
void each(Json& object, const char* key, const F& f) {
    if (!object.is_object()) return;
    const auto found = object.find(key);
    if (found == object.end() || !found->is_array()) return;
    for (Json& one : *found) f(one);
}

// Calls use for a member that is a number.
void number(Json& object, const char* key, const Use& use) {
    if (!object.is_object()) return;
    const auto found = object.find(key);
    if (found != object.end() && found->is_number()) use(*found);
}

// Calls use for all members that are numbers.
void numbers_of(Json& object, const char* key, const Use& use) {
    if (!object.is_object()) return;
    const auto found = object.find(key);
    if (found == object.end() || !found->is_object()) return;
    for (Json& value : *found)
        if (value.is_number()) use(value);
}

template <class F>
void each_primitive(Json& root, const F& f) {
    each(root, "meshes", [&](Json& mesh) { each(mesh, "primitives", f); });
}

// Calls f for each extension of an object.
template <class F>
void each_extension(Json& object, const F& f) {
    if (!object.is_object()) return;
    const auto found = object.find("extensions");
    if (found == object.end() || !found->is_object()) return;
    for (const auto& [name, value] : found->items()) f(name, value);
}

// Texture infos are members named ...Texture, wherever they are in a material.
void textures_in(Json& value, const Use& use) {
    if (value.is_array()) {
        for (Json& one : value) textures_in(one, use);
    }
    if (!value.is_object()) return;
    for (const auto& [name, child] : value.items()) {
        if (name == "extras") continue;
        if (name.ends_with("Texture")) number(child, "index", use);
        textures_in(child, use);
    }
}

void materials(Json& root, const Use& use) {
    each_primitive(root, [&](Json& primitive) {
        number(primitive, "material", use);
        each_extension(primitive, [&](const std::string&, Json& extension) {
            each(extension, "mappings", [&](Json& mapping) { number(mapping, "material", use); });
        });
    });
}

void images(Json& root, const Use& use) {
    each(root, "textures", [&](Json& texture) {
        number(texture, "source", use);
        each_extension(texture, [&](const std::string&, Json& extension) { number(extension, "source", use); });
    });
}

void accessors(Json& root, const Use& use) {
    each_primitive(root, [&](Json& primitive) {
        numbers_of(primitive, "attributes", use);
        number(primitive, "indices", use);
        each(primitive, "targets", [&](Json& target) {
            for (Json& value : target)
                if (value.is_number()) use(value);
        });
    });
    each(root, "skins", [&](Json& skin) { number(skin, "inverseBindMatrices", use); });
    each(root, "animations", [&](Json& animation) {
        each(animation, "samplers", [&](Json& sampler) {
            number(sampler, "input", use);
            number(sampler, "output", use);
        });
    });
    each(root, "nodes", [&](Json& node) {
        each_extension(node, [&](const std::string& name, Json& extension) {
            if (name == "EXT_mesh_gpu_instancing") numbers_of(extension, "attributes", use);
        });
    });
}

void views(Json& root, const Use& use) {
    each(root, "accessors", [&](Json& accessor) {
        number(accessor, "bufferView", use);
        const auto sparse = accessor.find("sparse");
        if (sparse == accessor.end() || !sparse->is_object()) return;
        for (const char* part : {"indices", "values"})
            if (sparse->contains(part)) number((*sparse)[part], "bufferView", use);
    });
    each(root, "images", [&](Json& image) { number(image, "bufferView", use); });
    each_primitive(root, [&](Json& primitive) {
        each_extension(primitive, [&](const std::string&, Json& extension) { number(extension, "bufferView", use); });
    });
}

size_t as_index(const Json& value) {
    const double number = value.get<double>();
    return number >= 0 && number < 1e15 ? static_cast<size_t>(number) : SIZE_MAX;
}

}  // namespace

const char* name_of(List list) {
    constexpr const char* kNames[] = {"materials", "textures", "images", "accessors", "bufferViews"};
    return kNames[static_cast<size_t>(list)];
}

void for_each_reference(Json& root, List list, const Use& use) {
    switch (list) {
        case List::kMaterials:
            return materials(root, use);
        case List::kTextures:
            return each(root, "materials", [&](Json& material) { textures_in(material, use); });
        case List::kImages:
            return images(root, use);
        case List::kAccessors:
            return accessors(root, use);
        case List::kBufferViews:
            return views(root, use);
    }
}

std::vector<bool> used_entries(Json& root, List list) {
    const Json& entries = member(root, name_of(list));
    std::vector<bool> used(entries.is_array() ? entries.size() : 0, false);
    for_each_reference(root, list, [&](Json& reference) {
        const size_t index = as_index(reference);
        if (index < used.size()) used[index] = true;
    });
    return used;
}

bool may_renumber(const Json& root) {
    const Json& names = member(root, "extensionsUsed");
    if (!names.is_array()) return true;
    return std::all_of(names.begin(), names.end(), [](const Json& name) {
        if (!name.is_string()) return false;
        const auto& text = name.get_ref<const std::string&>();
        return text.starts_with("KHR_materials_") || std::find(kKnown.begin(), kKnown.end(), text) != kKnown.end();
    });
}

std::vector<size_t> drop_unused(Json& root, List list, const std::vector<bool>& used_before) {
    const std::vector<bool> used = used_entries(root, list);
    std::vector<size_t> kept, place(used.size(), 0);
    Json entries = Json::array();
    for (size_t i = 0; i < used.size(); ++i) {
        const bool was_used = i >= used_before.size() || used_before[i];
        if (was_used && !used[i]) continue;
        place[i] = kept.size();
        kept.push_back(i);
        entries.push_back(std::move(root[name_of(list)][i]));
    }
    for_each_reference(root, list, [&](Json& reference) {
        const size_t index = as_index(reference);
        if (index < place.size()) reference = place[index];
    });
    if (entries.empty()) {
        root.erase(name_of(list));
    } else {
        root[name_of(list)] = std::move(entries);
    }
    return kept;
}

void forget_extension(Json& root, const std::string& name) {
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
        if (!member(root, list).is_array()) continue;
        Json rest = Json::array();
        for (const Json& other : root[list])
            if (other != name) rest.push_back(other);
        root[list] = rest;
        if (rest.empty()) root.erase(list);
    }
}

void declare_extension(Json& root, const std::string& name, bool required) {
    forget_extension(root, name);
    root["extensionsUsed"].push_back(name);
    if (required) root["extensionsRequired"].push_back(name);
}

}  // namespace gim::gltf
