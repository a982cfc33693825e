// Wavefront OBJ. Reads "v" and "f" lines. If colours are wanted, also "vt", the colours that some programs append to
// "v", and the map_Kd textures of materials. Skips everything else (normals, groups, plain material colours).
#include <algorithm>
#include <array>
#include <string>

#include "tools/mesh_read.h"
#include "tools/polygons.h"
#include "tools/text_scanner.h"

namespace gim {
namespace {

Error at_line(size_t line, const std::string& what) {
    return {Stage::kInput, "line " + std::to_string(line) + ": " + what};
}

struct Material {
    std::string name;
    uint32_t texture = Textures::kNoTexture;
};

// Reads the materials of an .mtl file that have a texture.
void read_materials(std::string_view file_name, Textures& textures, std::vector<Material>& materials) {
    const std::string text = textures.read_text(file_name);
    TextScanner in(text);
    std::string name;
    while (!in.at_end()) {
        const std::string_view keyword = in.word_on_line();
        if (keyword != "newmtl" && keyword != "map_Kd") {
            in.next_line();
            continue;
        }
        std::string_view value = in.rest_of_line();
        value.remove_prefix(std::min(value.find_first_not_of(" \t"), value.size()));
        if (keyword == "newmtl") {
            name = value;
            continue;
        }
        // Options come before the name. A name after options has no blank.
        if (value.starts_with('-')) value.remove_prefix(value.find_last_of(" \t") + 1);
        if (!value.empty()) materials.push_back({name, textures.load(value)});
    }
}

uint32_t texture_of(const std::vector<Material>& materials, std::string_view name) {
    for (const Material& material : materials) {
        if (material.name == name) return material.texture;
    }
    return Textures::kNoTexture;
}

// Returns the texture coordinate of a corner "vertex/texcoord/normal", 0 0 if it has none.
std::array<float, 2> texcoord_of(std::string_view word, const std::vector<std::array<float, 2>>& texcoords) {
    const size_t slash = word.find('/');
    if (slash == std::string_view::npos) return {};
    word.remove_prefix(slash + 1);
    const std::optional<int64_t> index = parse_integer(word.substr(0, word.find('/')));
    if (!index) return {};
    const int64_t i = *index > 0 ? *index - 1 : static_cast<int64_t>(texcoords.size()) + *index;
    return i >= 0 && static_cast<size_t>(i) < texcoords.size() ? texcoords[static_cast<size_t>(i)]
                                                               : std::array<float, 2>{};
}

}  // namespace

Result<TriangleMesh> read_obj(std::string_view text, ReadContext& context) {
    Textures* const textures = context.textures;
    PolygonSoup soup;
    std::vector<std::array<float, 2>> texcoords;
    std::vector<Material> materials;
    uint32_t texture = Textures::kNoTexture;
    bool all_colored = textures != nullptr;
    TextScanner in(text);
    std::vector<int64_t> face;
    while (!in.at_end()) {
        const size_t line = in.line();
        const std::string_view keyword = in.word_on_line();
        if (keyword == "v") {
            std::array<double, 3> position = {};
            for (double& coordinate : position) {
                const std::optional<double> value = parse_real(in.word_on_line());
                if (!value) return at_line(line, "a vertex needs three numbers (is the file cut short?)");
                coordinate = *value;
            }
            soup.positions.push_back(position);
            std::array<float, 3> color = {};
            for (size_t k = 0; all_colored && k < 3; ++k) {
                const std::optional<double> value = parse_real(in.word_on_line());
                all_colored = value.has_value();
                color[k] = static_cast<float>(value.value_or(0));
            }
            if (all_colored) soup.vertex_colors.push_back(color);
        } else if (textures && keyword == "vt") {
            const std::optional<double> u = parse_real(in.word_on_line()), v = parse_real(in.word_on_line());
            texcoords.push_back({static_cast<float>(u.value_or(0)), static_cast<float>(1 - v.value_or(0))});
        } else if (textures && keyword == "mtllib") {
            read_materials(in.word_on_line(), *textures, materials);
        } else if (textures && keyword == "usemtl") {
            texture = texture_of(materials, in.word_on_line());
        } else if (keyword == "f") {
            face.clear();
            for (std::string_view word = in.word_on_line(); !word.empty(); word = in.word_on_line()) {
                if (word == "\\") {  // the face continues on the next line
                    in.next_line();
                    continue;
                }
                const std::optional<int64_t> index = parse_integer(word.substr(0, word.find('/')));
                if (!index || *index == 0) {
                    return at_line(line, "'" + std::string(word.substr(0, 40)) + "' is not a vertex index of a face");
                }
                // 1 is the first vertex of the file, -1 the latest one.
                if (textures) soup.corner_texcoords.push_back(texcoord_of(word, texcoords));
                face.push_back(*index > 0 ? *index - 1 : static_cast<int64_t>(soup.positions.size()) + *index);
            }
            if (face.size() < 3) return at_line(line, "a face needs three vertices (is the file cut short?)");
            soup.add_face(face);
            if (textures) soup.face_texture.push_back(texture);
        }
        in.next_line();
    }
    if (soup.positions.empty() && soup.sizes.empty()) return Error{Stage::kInput, "it has no 'v' and no 'f' lines"};
    if (!all_colored) soup.vertex_colors.clear();
    if (!textures) return triangulate(std::move(soup));
    return triangulate(std::move(soup), std::move(textures->images));
}

}  // namespace gim
