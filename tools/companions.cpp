#include "tools/companions.h"

#include <filesystem>
#include <string_view>

#include "tools/decoded.h"
#include "tools/named_file.h"

namespace gim {
namespace {

namespace fs = std::filesystem;

bool ends_a_name(char c) { return std::string_view(" \t\r\n\"'/\\,;").find(c) != std::string_view::npos; }

// True if the name stands in the text with no other part of a name around it.
bool names(std::string_view text, std::string_view name) {
    for (size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
        const size_t end = at + name.size();
        if ((at == 0 || ends_a_name(text[at - 1])) && (end == text.size() || ends_a_name(text[end]))) return true;
    }
    return false;
}

// As glTF writes the name of a file.
std::string percent_encoded(std::string_view name) {
    std::string text;
    for (const char c : name) text += c == ' ' ? std::string("%20") : std::string(1, c);
    return text;
}

std::string_view as_text(const Bytes& bytes) { return {reinterpret_cast<const char*>(bytes.data()), bytes.size()}; }

bool names_or_encodes(const Bytes& bytes, const std::string& name) {
    return names(as_text(bytes), name) || names(as_text(bytes), percent_encoded(name));
}

// Material files beside the mesh that the mesh names. They name the textures.
bool materials_name(const Bytes& mesh, const fs::path& folder, const std::string& name) {
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (extension_of(entry->path()) != "mtl" || !names(as_text(mesh), entry->path().filename().string())) continue;
        const Result<Bytes> material = read_file(entry->path());
        if (material.ok() && names_or_encodes(material.value(), name)) return true;
    }
    return false;
}

}  // namespace

bool is_companion(const std::string& mesh, const std::string& other) {
    std::error_code ignored;
    if (!fs::is_regular_file(other, ignored) || !fs::is_regular_file(mesh, ignored)) return false;
    const std::string name = fs::path(other).filename().string();
    if (descriptor_named(mesh, Direction::kRead) || name.find('.') == std::string::npos) return false;
    const Result<Bytes> old = read_file(other);
    if (old.ok() && is_gim(old.value())) return false;
    const Result<Bytes> bytes = read_file(mesh);
    if (!bytes.ok() || is_gim(bytes.value())) return false;
    return names_or_encodes(bytes.value(), name) || materials_name(bytes.value(), folder_of(mesh), name);
}

}  // namespace gim
