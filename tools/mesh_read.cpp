#include "tools/mesh_read.h"

#include <algorithm>
#include <cstring>

#include "tools/foreign_format.h"
#include "tools/text_scanner.h"

namespace gim {
namespace {

constexpr size_t kSniffed = size_t{1} << 16;

bool has_obj_line(std::string_view text) {
    TextScanner in(text.substr(0, kSniffed), {.comments = true, .continuations = true});
    while (!in.at_end()) {
        const std::string_view keyword = in.word_on_line();
        if (keyword == "v" && parse_real(in.word_on_line()) && parse_real(in.word_on_line()) &&
            parse_real(in.word_on_line())) {
            return true;
        }
        in.next_line();
    }
    return false;
}

MeshFormat by_content(std::string_view text) {
    if (equals_ignoring_case(TextScanner(text.substr(0, kSniffed)).word_on_line(), "ply")) return MeshFormat::kPly;
    if (text.starts_with("glTF")) return MeshFormat::kGltf;
    if (is_whole_binary_stl(text)) return MeshFormat::kStl;
    if (is_wide_text(text) || !describe_foreign_format(text).empty()) return MeshFormat::kUnknown;
    const std::string_view word = TextScanner(text.substr(0, kSniffed), {.comments = true}).word();
    if (is_off_keyword(word)) return MeshFormat::kOff;
    if (is_ascii_stl(text)) return MeshFormat::kStl;
    if (word.starts_with('{') && text.substr(0, kSniffed).find("\"asset\"") != std::string_view::npos) {
        return MeshFormat::kGltf;
    }
    if (has_obj_line(text)) return MeshFormat::kObj;
    return MeshFormat::kUnknown;
}

MeshFormat by_extension(std::string_view extension) {
    if (extension == "ply") return MeshFormat::kPly;
    if (extension == "obj") return MeshFormat::kObj;
    if (extension == "off") return MeshFormat::kOff;
    if (extension == "stl") return MeshFormat::kStl;
    if (extension == "glb" || extension == "gltf") return MeshFormat::kGltf;
    return MeshFormat::kUnknown;
}

// Without the byte order mark of a text. The free header of a binary STL may begin with those bytes, too.
std::string_view as_text(std::span<const uint8_t> bytes) {
    const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    return is_whole_binary_stl(all) ? all : without_byte_order_mark(all);
}

Result<TriangleMesh> read_as(std::string_view text, MeshFormat format, ReadContext& context) {
    switch (format) {
        case MeshFormat::kPly:
            return read_ply(text, context);
        case MeshFormat::kObj:
            return read_obj(text, context);
        case MeshFormat::kOff:
            return read_off(text, context);
        case MeshFormat::kStl:
            return read_stl(text, context);
        case MeshFormat::kGltf:
            return read_gltf(text, context);
        case MeshFormat::kUnknown:
            break;
    }
    const std::string foreign = describe_foreign_format(text);
    if (!foreign.empty()) return Error{Stage::kInput, foreign};
    return Error{Stage::kInput, "neither its content nor its name is that of PLY, OBJ, OFF, STL, glTF or GLB"};
}

}  // namespace

MeshFormat detect_format(std::span<const uint8_t> bytes, std::string_view extension) {
    const std::string_view text = as_text(bytes);
    const MeshFormat content = by_content(text);
    if (content != MeshFormat::kUnknown || !describe_foreign_format(text).empty()) return content;
    return by_extension(extension);
}

std::string_view format_name(MeshFormat format) {
    switch (format) {
        case MeshFormat::kPly:
            return "PLY";
        case MeshFormat::kObj:
            return "OBJ";
        case MeshFormat::kOff:
            return "OFF";
        case MeshFormat::kStl:
            return "STL";
        case MeshFormat::kGltf:
            return "glTF";
        case MeshFormat::kUnknown:
            break;
    }
    return "unknown";
}

bool repeats_vertices(MeshFormat format) { return format == MeshFormat::kStl || format == MeshFormat::kGltf; }

Result<TriangleMesh> read_mesh(std::span<const uint8_t> bytes, MeshFormat format, ReadContext& context) {
    const std::string beginning = "not a mesh that gim can read: ";
    if (bytes.empty()) return Error{Stage::kInput, beginning + "the file is empty"};
    const std::string_view text = as_text(bytes);
    if (is_wide_text(text) && !is_whole_binary_stl(text))
        return Error{Stage::kInput, beginning + "it is UTF-16 text; save it as UTF-8 or ASCII"};
    Result<TriangleMesh> mesh = read_as(text, format, context);
    if (context.textures) {
        std::vector<std::string>& late = context.textures->warnings;
        context.warnings.insert(context.warnings.end(), late.begin(), late.end());
        late.clear();
    }
    if (!mesh.ok()) {
        const std::string as = format == MeshFormat::kUnknown ? "" : "(as " + std::string(format_name(format)) + ") ";
        return Error{mesh.error().stage, beginning + as + mesh.error().message};
    }
    return mesh;
}

TriangleMesh weld_equal_positions(const TriangleMesh& mesh) {
    // Sorts by position as bits, so that not-a-number has a place too. The first of equal vertices leads.
    std::vector<uint32_t> order(mesh.positions.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    const auto bits = [&](uint32_t v) {
        std::array<uint64_t, 3> key = {};
        for (size_t k = 0; k < 3; ++k) {
            const double value = mesh.positions[v][k] + 0.0;  // -0 and 0 are one place
            std::memcpy(&key[k], &value, sizeof(value));
        }
        return key;
    };
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const auto ka = bits(a);
        const auto kb = bits(b);
        return ka != kb ? ka < kb : a < b;
    });
    std::vector<uint32_t> leader(order.size());
    for (size_t i = 0; i < order.size(); ++i) {
        const bool same = i > 0 && bits(order[i]) == bits(order[i - 1]);
        leader[order[i]] = same ? leader[order[i - 1]] : order[i];
    }

    TriangleMesh welded;
    std::vector<uint32_t> renamed(order.size());
    for (uint32_t v = 0; v < leader.size(); ++v) {
        if (leader[v] == v) {
            renamed[v] = static_cast<uint32_t>(welded.positions.size());
            welded.positions.push_back(mesh.positions[v]);
        } else {
            renamed[v] = renamed[leader[v]];
        }
    }
    welded.triangles.reserve(mesh.triangles.size());
    welded.shading.normals = mesh.shading.normals;
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const auto& t = mesh.triangles[f];
        const std::array<uint32_t, 3> corners = {renamed[leader[t[0]]], renamed[leader[t[1]]], renamed[leader[t[2]]]};
        if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) continue;
        welded.triangles.push_back(corners);
        if (!mesh.shading.empty()) welded.shading.corners.push_back(mesh.shading.corners[f]);
    }
    return welded;
}

}  // namespace gim
