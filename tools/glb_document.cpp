#include "tools/glb_document.h"

#include <algorithm>
#include <utility>

#include "tools/glb_file.h"
#include "tools/gltf_uri.h"
#include "tools/picture_kind.h"

namespace gim::gltf {
namespace {

const char* const kMeshopt[] = {"EXT_meshopt_compression", "KHR_meshopt_compression"};

// Takes an extension off an object.
void take_off(Json& object, const std::string& name) {
    if (!object.contains("extensions") || !object["extensions"].is_object()) return;
    object["extensions"].erase(name);
    if (object["extensions"].empty()) object.erase("extensions");
}

}  // namespace

GlbDocument::GlbDocument(File& file) : root(file.root()), file_(file) {
    const Json& views = member(root, "bufferViews");
    for (uint64_t i = 0; views.is_array() && i < views.size(); ++i) {
        Data data;
        data.source = i;
        views_.push_back(std::move(data));
    }
    for (const List list : kAllLists) used_before_.push_back(used_entries(root, list));
    const Json& images = member(root, "images");
    for (const Json& image : images) {
        const std::optional<uint64_t> view = whole_number(image, "bufferView");
        if (view && *view < views_.size()) views_[*view].place = Place::kPicture;
    }
}

size_t GlbDocument::add(List list, Json entry) {
    Json& entries = root[name_of(list)];
    entries.push_back(std::move(entry));
    return entries.size() - 1;
}

size_t GlbDocument::add_view(Bytes bytes, Place place, int target) {
    Data data;
    data.own = std::move(bytes);
    data.is_own = true;
    data.place = place;
    views_.push_back(std::move(data));
    return add(List::kBufferViews, target != 0 ? Json{{"target", target}} : Json::object());
}

GlbDocument::Output GlbDocument::finish(const std::string& fallback_uri) {
    embed_pictures();
    if (may_renumber(root)) drop_what_is_unused();
    for (const char* name : kMeshopt) forget_extension(root, name);
    Output output;
    lay_out(output, fallback_uri);
    return output;
}

void GlbDocument::embed_pictures() {
    if (!member(root, "images").is_array()) return;
    for (size_t i = 0; i < root["images"].size(); ++i) {
        const std::string uri = text(root["images"][i], "uri");
        if (uri.empty()) continue;
        try {
            Bytes bytes = read_uri(uri, file_.context().folder, file_.memory().left());
            take(file_.memory(), bytes.size(), 1, "the bytes of its pictures");
            const std::string_view type = picture_kind(bytes).media_type;
            if (type.empty()) throw Failure("it is no picture that gim knows");
            const size_t view = add_view(std::move(bytes), Place::kPicture);
            Json& image = root["images"][i];
            image.erase("uri");
            image["bufferView"] = view;
            image["mimeType"] = type;
        } catch (const Failure& failure) {
            file_.context().warn("image " + std::to_string(i) + ", " + shown_uri(uri) + ": " + failure.what() +
                                 "; it stays a file of its own");
        }
    }
}

void GlbDocument::drop_what_is_unused() {
    for (const List list : kAllLists) {
        if (!member(root, name_of(list)).is_array()) continue;
        const std::vector<size_t> kept = drop_unused(root, list, used_before_[static_cast<size_t>(list)]);
        if (list != List::kBufferViews) continue;
        std::vector<Data> views;
        for (const size_t i : kept) views.push_back(std::move(views_[i]));
        views_ = std::move(views);
    }
}

std::span<const uint8_t> GlbDocument::bytes_of(const Data& data) {
    return data.is_own ? std::span<const uint8_t>(data.own) : file_.view(data.source);
}

void GlbDocument::lay_out(Output& output, const std::string& fallback_uri) {
    std::vector<size_t> order(views_.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return views_[a].place < views_[b].place; });
    Bytes binary;
    for (const size_t i : order) {
        const bool is_fallback = views_[i].place == Place::kFallback;
        Bytes& buffer = is_fallback ? output.fallback : binary;
        const std::span<const uint8_t> bytes = bytes_of(views_[i]);
        while (buffer.size() % 4 != 0) buffer.push_back(0);
        Json& view = root["bufferViews"][i];
        view["buffer"] = is_fallback ? 1 : 0;
        view["byteOffset"] = buffer.size();
        view["byteLength"] = bytes.size();
        for (const char* name : kMeshopt) take_off(view, name);
        buffer.insert(buffer.end(), bytes.begin(), bytes.end());
    }
    while (binary.size() % 4 != 0) binary.push_back(0);
    root.erase("buffers");
    if (!binary.empty() || !output.fallback.empty()) root["buffers"].push_back({{"byteLength", binary.size()}});
    if (!output.fallback.empty())
        root["buffers"].push_back({{"byteLength", output.fallback.size()}, {"uri", fallback_uri}});
    Result<Bytes> glb = glb_bytes(root.dump(-1, ' ', false, Json::error_handler_t::replace), std::move(binary));
    if (!glb.ok()) throw Failure(glb.error().message);
    output.glb = std::move(glb.value());
}

}  // namespace gim::gltf
