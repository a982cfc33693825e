// Primitives whose geometry is a .gim: the extension EXT_gim_geometry in the JSON of a glTF file.
#pragma once

#include <optional>

#include "tools/glb_document.h"
#include "tools/glb_geometry.h"

namespace gim::gltf {

inline constexpr const char* kGimExtension = "EXT_gim_geometry";

// What the extension of a primitive says.
struct GimPrimitive {
    uint64_t view = 0;
    std::optional<uint32_t> label;
    std::vector<AtlasPlace> places;
    bool texcoords = false, tangents = false;  // whether the primitive has such attributes

    WantedArrays wanted() const { return {label, texcoords, tangents}; }
};

// Nothing if the primitive has no such extension. Throws a Failure if it is damaged.
std::optional<GimPrimitive> read_gim_primitive(const Json& primitive);

// Gives a primitive the accessors of the arrays: without data, with data in buffer views, or with data in the buffer for
// readers that do not know the extension. It keeps its material, its name and its extras.
enum class ArrayData { kNone, kPlain, kFallback };
void set_arrays(GlbDocument& document, Json& primitive, const PrimitiveArrays& arrays, ArrayData data);

// Sets the extension of a primitive. places: told if there are several images.
void set_gim_extension(Json& primitive, size_t view, std::optional<uint32_t> label,
                       const std::vector<AtlasPlace>& places);

// Takes an extension off an object.
void erase_extension(Json& object, const std::string& name);

}  // namespace gim::gltf
