// Wavefront OBJ. Reads "v" and "f" lines. If colours are wanted, also "vt", the colours that some programs append to
// "v", and of materials the map_Kd textures and the Kd colours. If shading is wanted, also "vn" and, without normals, the
// smoothing groups "s". Skips everything else (other groups, lines).
#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "tools/mesh_read.h"
#include "tools/polygons.h"
#include "tools/read_mtl.h"
#include "tools/smoothing_groups.h"
#include "tools/text_scanner.h"

namespace gim {
namespace {

Error at_line(size_t line, const std::string& what) {
    return {Stage::kInput, "line " + std::to_string(line) + ": " + what};
}

// Collects the numbers after the coordinates of "v" lines: nothing, w, r g b, w r g b or r g b a. The same for all
// vertices, or there are no colours.
class VertexColors {
  public:
    void add(TextScanner& in) {
        std::array<float, 5> numbers = {};
        size_t count = 0;
        for (; count < numbers.size(); ++count) {
            const std::optional<double> value = parse_real(in.word_on_line());
            if (!value) break;
            numbers[count] = static_cast<float>(*value);
        }
        ++vertices_;
        if (count < 3) return;
        firsts_are_one_ = firsts_are_one_ && numbers[0] == 1;
        lasts_are_one_ = lasts_are_one_ && (numbers[3] == 1 || numbers[3] == 255);
        four_ = four_ || count == 4;
        five_ = five_ || count == 5;
        numbers_.push_back({numbers[0], numbers[1], numbers[2], numbers[3]});
    }

    std::vector<std::array<float, 3>> take(ReadContext& context) {
        std::vector<std::array<float, 3>> colors;
        if (numbers_.empty()) return colors;
        if (numbers_.size() != vertices_) {
            context.warn("only " + std::to_string(numbers_.size()) + " of " + std::to_string(vertices_) +
                         " vertices have a colour; vertex colours are left out");
            return colors;
        }
        // Of four numbers the first is w, unless only the last can be alpha.
        const bool begins_with_w = five_ || (four_ && (firsts_are_one_ || !lasts_are_one_));
        const size_t first = begins_with_w ? 1 : 0;
        colors.reserve(numbers_.size());
        for (const auto& n : numbers_) colors.push_back({n[first], n[first + 1], n[first + 2]});
        scale_colors(colors);
        return colors;
    }

  private:
    std::vector<std::array<float, 4>> numbers_;  // of vertices that have three or more
    size_t vertices_ = 0;
    bool firsts_are_one_ = true, lasts_are_one_ = true;
    bool four_ = false, five_ = false;
};

class Reader {
  public:
    Reader(std::string_view text, ReadContext& context)
        : in_(text, {.comments = true, .continuations = true}), context_(context), textures_(context.textures) {}

    Result<TriangleMesh> read() {
        while (!in_.at_end()) {
            const size_t line = in_.line();
            const std::string_view keyword = in_.word_on_line();
            Result<void> read;
            if (keyword == "v") {
                read = read_vertex(line);
            } else if (keyword == "f" || keyword == "fo") {
                read = read_face(line);
            } else if (keyword == "curv" || keyword == "surf") {
                has_free_forms_ = true;
            } else if (context_.shading && keyword == "vn") {
                read = read_normal();
            } else if (context_.shading && keyword == "s") {
                smoothing_group_ = smoothing_group_named(in_.word_on_line());
            } else if (textures_ && read_look(keyword)) {
                continue;  // on the next line already
            }
            if (!read.ok()) return read.error();
            in_.next_line();
        }
        if (soup_.positions.empty() && soup_.sizes.empty()) {
            return Error{Stage::kInput, "it has no 'v' and no 'f' lines"};
        }
        if (has_free_forms_) context_.warn("its free-form curves and surfaces are left out");
        if (context_.shading) resolve_shading();
        if (!textures_) return triangulate(std::move(soup_), context_);
        soup_.vertex_colors = colors_.take(context_);
        resolve_materials();
        return triangulate(std::move(soup_), context_);
    }

  private:
    Result<void> read_vertex(size_t line) {
        std::array<double, 3> position = {};
        for (double& coordinate : position) {
            const std::string_view word = in_.word_on_line();
            const std::optional<double> value = parse_real(word);
            if (!value) {
                const std::string wrong =
                    word.empty() ? " (is the file cut short?)" : ", not " + describe_wrong_number(word);
                return at_line(line, "a vertex needs three numbers" + wrong);
            }
            coordinate = *value;
        }
        if (Result<void> fits = take(1, 0); !fits.ok()) return fits;
        soup_.positions.push_back(position);
        if (textures_) colors_.add(in_);
        return {};
    }

    Result<void> read_face(size_t line) {
        face_.clear();
        for (std::string_view word = in_.word_on_line(); !word.empty(); word = in_.word_on_line()) {
            const std::optional<int64_t> index = parse_integer(word.substr(0, word.find('/')));
            if (!index || *index == 0) {
                return at_line(line, "'" + std::string(word.substr(0, 40)) + "' is not a vertex index of a face");
            }
            if (textures_) soup_.corner_texcoords.push_back(texcoord_of(word));
            if (context_.shading) soup_.corner_normals.push_back(normal_of(word));
            // 1 is the first vertex of the file, -1 the latest one.
            face_.push_back(*index > 0 ? *index - 1 : static_cast<int64_t>(soup_.positions.size()) + *index);
        }
        if (face_.size() < 3 && in_.is_all_read())
            return at_line(line, "the file ends inside a face (is it cut short?)");
        if (Result<void> fits = take(0, face_.size()); !fits.ok()) return fits;
        soup_.add_face(face_);
        if (context_.shading) smoothing_groups_.push_back(smoothing_group_);
        if (textures_) face_material_.push_back(material_);
        return {};
    }

    Result<void> take(uint64_t vertices, uint64_t corners) {
        const uint64_t bytes = vertices * vertex_memory(context_) + corners * corner_memory(context_);
        if (context_.memory.try_take(bytes)) return {};
        return context_.memory.over_limit("its vertices and faces take memory");
    }

    Result<void> read_normal() {
        std::array<float, 3> normal = {};  // what is no number counts as 0
        for (float& n : normal) n = static_cast<float>(parse_real(in_.word_on_line()).value_or(0));
        if (!context_.memory.try_take(sizeof(normal))) return context_.memory.over_limit("its normals take memory");
        soup_.normals.push_back(normal);
        return {};
    }

    // Returns the normal of a corner "vertex/texcoord/normal", kFlat if it has none. It may stand further down.
    uint32_t normal_of(std::string_view word) {
        const size_t first = word.find('/');
        const size_t second = first == std::string_view::npos ? first : word.find('/', first + 1);
        if (second == std::string_view::npos || second + 1 == word.size()) return Shading::kFlat;
        has_normals_ = true;
        const std::optional<int64_t> index = parse_integer(word.substr(second + 1));
        const auto count = static_cast<int64_t>(soup_.normals.size());
        const int64_t i = !index || *index == 0 ? -1 : *index > 0 ? *index - 1 : count + *index;
        return i >= 0 && i < kNoNormal ? static_cast<uint32_t>(i) : kNoNormal;
    }

    // Normals win over smoothing groups.
    void resolve_shading() {
        const auto& of_corner = soup_.corner_normals;
        const auto is_missing = [&](uint32_t n) { return n != Shading::kFlat && n >= soup_.normals.size(); };
        const auto missing = std::count_if(of_corner.begin(), of_corner.end(), is_missing);
        if (missing > 0) {
            context_.warn("corners of faces use normals that do not exist, " + std::to_string(missing) +
                          " in all; hard edges are found by the shape alone");
        }
        if (has_normals_ && missing == 0) return;
        soup_.normals.clear();
        soup_.corner_normals.clear();
        if (!has_normals_) add_group_normals(smoothing_groups_, soup_);
    }

    // Reads a line that tells the look and goes on to the next one. False if it is none.
    bool read_look(std::string_view keyword) {
        if (keyword == "vt") {
            const std::optional<double> u = parse_real(in_.word_on_line()), v = parse_real(in_.word_on_line());
            texcoords_.push_back({static_cast<float>(u.value_or(0)), static_cast<float>(1 - v.value_or(0))});
            in_.next_line();
        } else if (keyword == "mtllib") {
            const std::string names = in_.rest_of_line();
            if (known_files_.insert(names).second) material_files_.push_back(names);
        } else if (keyword == "usemtl") {
            use_material(in_.rest_of_line());
        } else {
            return false;
        }
        return true;
    }

    void use_material(const std::string& rest) {
        const std::string name(trimmed_name(rest));
        const auto next = static_cast<uint32_t>(material_names_.size());
        const auto [known, is_new] = material_index_.emplace(name, next);
        if (is_new) material_names_.push_back(name);
        material_ = known->second;
    }

    // Returns the texture coordinate of a corner "vertex/texcoord/normal", 0 0 if it has none.
    std::array<float, 2> texcoord_of(std::string_view word) const {
        const size_t slash = word.find('/');
        if (slash == std::string_view::npos) return {};
        word.remove_prefix(slash + 1);
        const std::optional<int64_t> index = parse_integer(word.substr(0, word.find('/')));
        if (!index) return {};
        const int64_t i = *index > 0 ? *index - 1 : static_cast<int64_t>(texcoords_.size()) + *index;
        return i >= 0 && static_cast<size_t>(i) < texcoords_.size() ? texcoords_[static_cast<size_t>(i)]
                                                                    : std::array<float, 2>{};
    }

    // Gives the faces the texture or the colour of their material.
    void resolve_materials() {
        std::vector<Material> materials;
        for (const std::string& names : material_files_) read_material_files(names, *textures_, materials);
        const Material none;
        std::vector<const Material*> by_name;
        for (const std::string& name : material_names_) {
            const Material* const found = find_material(materials, name);
            if (!found && !materials.empty()) {
                context_.warn("material " + name.substr(0, 80) + " is in none of its material files");
            }
            by_name.push_back(found ? found : &none);
        }
        bool has_color = false;
        for (const uint32_t material : face_material_) {
            const Material& look = material == kNoMaterial ? none : *by_name[material];
            soup_.face_texture.push_back(look.texture);
            soup_.face_colors.push_back(look.color == kNoColor ? std::array<float, 3>{1, 1, 1} : look.color);
            has_color = has_color || (look.texture == Textures::kNoTexture && look.color != kNoColor);
        }
        if (!has_color) soup_.face_colors.clear();
    }

    static constexpr uint32_t kNoMaterial = UINT32_MAX;
    static constexpr uint32_t kNoNormal = Shading::kFlat - 1;  // an index that is none

    TextScanner in_;
    ReadContext& context_;
    Textures* textures_;
    PolygonSoup soup_;
    VertexColors colors_;
    std::vector<std::array<float, 2>> texcoords_;
    std::vector<std::string> material_files_;  // rests of "mtllib" lines
    std::unordered_set<std::string> known_files_;
    std::unordered_map<std::string, uint32_t> material_index_;  // of material_names_
    std::vector<std::string> material_names_;                   // as "usemtl" gives them
    std::vector<uint32_t> face_material_;                       // index of a name
    uint32_t material_ = kNoMaterial;
    std::vector<uint32_t> smoothing_groups_;  // per face
    uint32_t smoothing_group_ = 0;
    bool has_normals_ = false;
    std::vector<int64_t> face_;
    bool has_free_forms_ = false;
};

}  // namespace

Result<TriangleMesh> read_obj(std::string_view text, ReadContext& context) { return Reader(text, context).read(); }

}  // namespace gim
