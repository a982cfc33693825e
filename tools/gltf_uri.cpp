#include "tools/gltf_uri.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "tools/gltf_json.h"

namespace gim::gltf {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostShown = 60;

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// Takes the digits of base64url too. -1: no digit.
int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

// Blanks and line ends between the digits are skipped; padding may be missing.
Bytes base64_decoded(std::string_view digits) {
    Bytes bytes;
    bytes.reserve(digits.size() / 4 * 3 + 3);
    uint32_t word = 0;
    int bits = 0;
    bool ended = false;
    for (const char c : digits) {
        if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
        if (c == '=') {
            ended = true;
            continue;
        }
        const int digit = base64_digit(c);
        if (digit < 0 || ended) throw Failure("its base64 text is damaged");
        word = word << 6 | static_cast<uint32_t>(digit);
        bits += 6;
        if (bits >= 8) {
            bits -= 8;
            bytes.push_back(static_cast<uint8_t>(word >> bits & 255));
        }
    }
    return bytes;
}

bool starts_with_word(std::string_view text, std::string_view lower) {
    return text.size() >= lower.size() && std::equal(lower.begin(), lower.end(), text.begin(), [](char a, char b) {
               return a == (b >= 'A' && b <= 'Z' ? static_cast<char>(b - 'A' + 'a') : b);
           });
}

Bytes read_data_uri(std::string_view uri, uint64_t most) {
    const size_t comma = uri.find(',');
    if (comma == std::string_view::npos) throw Failure("it is a data: URI without a comma before its data");
    const std::string_view data = uri.substr(comma + 1);
    if (data.size() > most) throw Failure("its data is larger than the memory limit");
    if (uri.substr(0, comma).ends_with(";base64")) return base64_decoded(data);
    const std::optional<std::string> plain = percent_decoded(data);
    if (!plain) throw Failure("a % in its data is not followed by two hexadecimal digits");
    return {plain->begin(), plain->end()};
}

bool is_absolute(const std::string& name) {
    const bool has_drive = name.size() >= 2 && name[1] == ':';
    return name.starts_with('/') || name.starts_with('\\') || has_drive;
}

// A device or a pipe may never end, so only files are read.
bool is_file(const fs::path& path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

}  // namespace

std::string shown_uri(std::string_view uri) {
    return "\"" + std::string(uri.substr(0, kMostShown)) + (uri.size() > kMostShown ? "..." : "") + "\"";
}

std::optional<std::string> percent_decoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i];
            continue;
        }
        const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
        const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
        if (high < 0 || low < 0) return std::nullopt;
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

Bytes read_uri(std::string_view uri, const std::string& folder, uint64_t most) {
    if (uri.empty()) throw Failure("the URI is empty");
    if (starts_with_word(uri, "data:")) return read_data_uri(uri, most);
    if (uri.find("://") != std::string_view::npos) {
        throw Failure("it is an address; only files beside the glTF file are read: download it and change the URI");
    }
    // Some programs do not encode their names, so a name is also tried as it stands.
    std::vector<std::string> names = {std::string(uri)};
    const std::optional<std::string> decoded = percent_decoded(uri);
    if (decoded && *decoded != uri) names.insert(names.begin(), *decoded);
    for (std::string name : names) {
        if (name.find('\0') != std::string::npos) throw Failure("the name holds a zero byte");
        if (is_absolute(name)) throw Failure("the name is absolute; only names relative to the glTF file are read");
        if (!is_file(fs::path(folder) / name)) std::replace(name.begin(), name.end(), '\\', '/');
        const fs::path path = fs::path(folder) / name;
        if (!is_file(path)) continue;
        std::error_code error;
        const uint64_t size = fs::file_size(path, error);
        if (!error && size > most) throw Failure("the file is larger than the memory limit");
        Result<Bytes> file = read_file(path.string());
        if (!file.ok()) throw Failure(file.error().message);
        return std::move(file.value());
    }
    throw Failure(decoded ? "there is no such file" : "a % is not followed by two hexadecimal digits");
}

}  // namespace gim::gltf
