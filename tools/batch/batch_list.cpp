#include "tools/batch/batch_list.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>
#include <string_view>
#include <tuple>

#include "tools/descriptor.h"

namespace gim {
namespace {

namespace fs = std::filesystem;

// Of what a folder gives. An .exr may be anybody's texture, so it is only taken from a list.
constexpr std::array<std::string_view, 7> kExtensions = {"ply", "obj", "off", "stl", "gltf", "glb", "npz"};

bool is_hidden(const fs::path& path) { return path.filename().string().starts_with('.'); }

bool is_named_as_mesh(const fs::path& path) {
    return std::find(kExtensions.begin(), kExtensions.end(), extension_of(path.string())) != kExtensions.end();
}

Error cannot_list(const fs::path& folder, const std::error_code& failure) {
    return {Stage::kInput, "cannot list the folder " + folder.string() + ": " + failure.message()};
}

Result<std::vector<BatchItem>> list_folder(const fs::path& folder) {
    std::vector<BatchItem> items;
    std::error_code failure;
    fs::recursive_directory_iterator entry(folder, failure);
    fs::path path = folder;  // at a failure: the folder that cannot be entered
    for (; !failure && entry != fs::recursive_directory_iterator(); entry.increment(failure)) {
        path = entry->path();
        std::error_code unknown;
        const bool is_folder = entry->is_directory(unknown);
        if (is_hidden(path)) {
            if (is_folder) entry.disable_recursion_pending();
        } else if (!is_folder && is_named_as_mesh(path)) {
            items.push_back({path.string(), path.lexically_relative(folder).string()});
        }
    }
    if (failure) return cannot_list(path, failure);
    return items;
}

// Without a leading "/" and "..".
std::string name_of(const fs::path& path) {
    fs::path name;
    for (const fs::path& part : path.lexically_normal().relative_path()) {
        if (part != ".." && part != ".") name /= part;
    }
    return name.string();
}

std::vector<BatchItem> read_list(std::string_view text) {
    std::vector<BatchItem> items;
    while (!text.empty()) {
        const size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (line.ends_with('\r')) line.remove_suffix(1);
        if (line.empty() || line.starts_with('#')) continue;
        const fs::path path = fs::path(line).lexically_normal();
        items.push_back({path.string(), name_of(path)});
    }
    return items;
}

std::string numbered(const std::string& name, uint32_t number) {
    const fs::path path(name);
    return (path.parent_path() / (path.stem().string() + "~" + std::to_string(number) + path.extension().string()))
        .string();
}

void make_names_unique(std::vector<BatchItem>& items) {
    std::set<std::string> taken;
    for (const BatchItem& item : items) taken.insert(item.name);
    for (size_t i = 1, first = 0; i < items.size(); ++i) {
        if (items[i].name != items[first].name) {
            first = i;
            continue;
        }
        uint32_t number = 2;
        while (!taken.insert(numbered(items[first].name, number)).second) ++number;
        items[i].name = numbered(items[first].name, number);
    }
}

void sort_and_name(std::vector<BatchItem>& items) {
    const auto key = [](const BatchItem& item) { return std::tie(item.name, item.path); };
    const auto before = [&](const BatchItem& a, const BatchItem& b) { return key(a) < key(b); };
    std::sort(items.begin(), items.end(), before);
    const auto same = [](const BatchItem& a, const BatchItem& b) { return a.path == b.path; };
    items.erase(std::unique(items.begin(), items.end(), same), items.end());
    make_names_unique(items);
    std::sort(items.begin(), items.end(), before);
}

}  // namespace

Result<std::vector<BatchItem>> list_batch(const std::string& inputs) {
    std::error_code failure;
    std::vector<BatchItem> items;
    if (fs::is_directory(inputs, failure)) {
        Result<std::vector<BatchItem>> found = list_folder(inputs);
        if (!found.ok()) return found.error();
        items = std::move(found.value());
    } else if (is_named_as_mesh(inputs)) {
        return Error{Stage::kInput, "this is the name of a mesh, and no list; encode one mesh with gim encode"};
    } else {
        const Result<Bytes> list = read_named(inputs);
        if (!list.ok()) return list.error();
        items = read_list({reinterpret_cast<const char*>(list.value().data()), list.value().size()});
        if (std::any_of(items.begin(), items.end(), [](const BatchItem& item) { return item.name.empty(); }))
            return Error{Stage::kInput, "a line of the list names a folder; name files, or give the folder alone"};
    }
    sort_and_name(items);
    return items;
}

std::vector<BatchItem> shard_of(const std::vector<BatchItem>& items, uint32_t shard, uint32_t shards) {
    std::vector<BatchItem> mine;
    for (size_t i = shard - 1; i < items.size(); i += shards) mine.push_back(items[i]);
    return mine;
}

}  // namespace gim
