#include "tools/glb_primitives.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace gim::gltf {
namespace {

// Numbers of the glTF specification.
constexpr int kFloat = 5126, kUnsignedShort = 5123, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;

template <class T>
Bytes bytes_of(const std::vector<T>& values) {
    Bytes bytes(values.size() * sizeof(T));
    if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

class AccessorWriter {
  public:
    AccessorWriter(GlbDocument& document, ArrayData data) : document_(document), data_(data) {}

    template <class T>
    size_t add(const std::vector<T>& values, size_t width, int component, int target) {
        Json accessor = {{"componentType", component},
                         {"count", values.size() / width},
                         {"type", width == 1 ? "SCALAR" : "VEC" + std::to_string(width)}};
        if (data_ != ArrayData::kNone) {
            const auto place =
                data_ == ArrayData::kFallback ? GlbDocument::Place::kFallback : GlbDocument::Place::kArrays;
            accessor["bufferView"] = document_.add_view(bytes_of(values), place, target);
        }
        return document_.add(List::kAccessors, std::move(accessor));
    }

    // POSITION must state its bounds.
    size_t add_positions(const std::vector<float>& values) {
        const size_t accessor = add(values, 3, kFloat, kArrayBuffer);
        add_bounds(document_.root[name_of(List::kAccessors)][accessor], values);
        return accessor;
    }

  private:
    static void add_bounds(Json& accessor, const std::vector<float>& values) {
        std::array<double, 3> low{}, high{};
        for (size_t i = 0; i < values.size(); ++i) {
            const auto value = static_cast<double>(values[i]);
            low[i % 3] = i < 3 ? value : std::min(low[i % 3], value);
            high[i % 3] = i < 3 ? value : std::max(high[i % 3], value);
        }
        accessor["min"] = low;
        accessor["max"] = high;
    }

    GlbDocument& document_;
    ArrayData data_;
};

size_t add_indices(AccessorWriter& writer, const PrimitiveArrays& arrays) {
    // The largest number of a type is not an index: it begins a new strip.
    if (arrays.vertices() > 65535) return writer.add(arrays.indices, 1, kUnsignedInt, kElementArrayBuffer);
    const std::vector<uint16_t> small(arrays.indices.begin(), arrays.indices.end());
    return writer.add(small, 1, kUnsignedShort, kElementArrayBuffer);
}

}  // namespace

std::optional<GimPrimitive> read_gim_primitive(const Json& primitive) {
    const Json& told = extension(primitive, kGimExtension);
    if (told.is_null()) return {};
    const auto fail = [](const std::string& what) { return Failure(std::string(kGimExtension) + ": " + what); };
    GimPrimitive read;
    const std::optional<uint64_t> view = whole_number(told, "bufferView"), label = whole_number(told, "label");
    if (!view) throw fail("no buffer view");
    read.view = *view;
    if (label && *label > 255) throw fail("a label above 255");
    if (label) read.label = static_cast<uint32_t>(*label);
    const std::vector<double> places = numbers(told, "places");
    if (places.size() % 3 != 0) throw fail("\"places\" is not a list of triples");
    for (size_t i = 0; i < places.size(); i += 3) read.places.push_back({places[i], places[i + 1], places[i + 2]});
    const Json& attributes = member(primitive, "attributes");
    if (!attributes.is_object()) throw fail("no attributes");
    for (const auto& [name, accessor] : attributes.items()) {
        if (name == "POSITION" || name == "NORMAL") continue;
        if (name == "TEXCOORD_0") read.texcoords = true;
        if (name == "TANGENT") read.tangents = true;
        if (name != "TEXCOORD_0" && name != "TANGENT") throw fail("the attribute " + name + ", which it does not have");
    }
    return read;
}

void erase_extension(Json& object, const std::string& name) {
    if (!member(object, "extensions").is_object()) return;
    object["extensions"].erase(name);
    if (object["extensions"].empty()) object.erase("extensions");
}

void set_arrays(GlbDocument& document, Json& primitive, const PrimitiveArrays& arrays, ArrayData data) {
    AccessorWriter writer(document, data);
    Json attributes = {{"POSITION", writer.add_positions(arrays.positions)}};
    attributes["NORMAL"] = writer.add(arrays.normals, 3, kFloat, kArrayBuffer);
    if (!arrays.texcoords.empty()) attributes["TEXCOORD_0"] = writer.add(arrays.texcoords, 2, kFloat, kArrayBuffer);
    if (!arrays.tangents.empty()) attributes["TANGENT"] = writer.add(arrays.tangents, 4, kFloat, kArrayBuffer);
    primitive["attributes"] = std::move(attributes);
    primitive["indices"] = add_indices(writer, arrays);
    primitive["mode"] = 4;
}

void set_gim_extension(Json& primitive, size_t view, std::optional<uint32_t> label,
                       const std::vector<AtlasPlace>& places) {
    Json told = {{"bufferView", view}};
    if (label) told["label"] = *label;
    for (const AtlasPlace& place : places) {
        for (const double value : {place.x, place.y, place.size}) told["places"].push_back(value);
    }
    primitive["extensions"][kGimExtension] = std::move(told);
}

}  // namespace gim::gltf
