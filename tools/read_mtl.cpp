#include "tools/read_mtl.h"

#include <algorithm>

#include "tools/text_scanner.h"

namespace gim {
namespace {

constexpr std::string_view kBlanks = " \t";

// An option of a map and how many values may follow it.
struct MapOption {
    std::string_view name;
    int most_values;
    bool moves_texture;  // its values change where the texture lies
};

constexpr std::array<MapOption, 13> kMapOptions = {{{"-blendu", 1, false},
                                                    {"-blendv", 1, false},
                                                    {"-boost", 1, false},
                                                    {"-bm", 1, false},
                                                    {"-cc", 1, false},
                                                    {"-clamp", 1, false},
                                                    {"-imfchan", 1, false},
                                                    {"-mm", 2, false},
                                                    {"-o", 3, true},
                                                    {"-s", 3, true},
                                                    {"-t", 3, true},
                                                    {"-texres", 1, false},
                                                    {"-type", 1, false}}};

std::string_view first_word(std::string_view text) { return text.substr(0, text.find_first_of(kBlanks)); }

void remove_word(std::string_view& text) {
    text.remove_prefix(first_word(text).size());
    text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
}

// Removes the options before a map's file name. `moved`: true if one of them is not neutral.
void remove_options(std::string_view& value, bool& moved) {
    while (value.starts_with('-')) {
        const std::string_view word = first_word(value);
        const auto* const option = std::find_if(kMapOptions.begin(), kMapOptions.end(),
                                                [&](const MapOption& o) { return equals_ignoring_case(word, o.name); });
        if (option == kMapOptions.end()) return;
        remove_word(value);
        const double neutral = option->name == "-s" ? 1 : 0;
        for (int i = 0; i < option->most_values; ++i) {
            // The second and third number may be missing.
            const std::optional<double> number = parse_real(first_word(value));
            if (option->most_values > 1 && !number) break;
            moved = moved || (option->moves_texture && number && *number != neutral);
            remove_word(value);
        }
    }
}

uint32_t load_map(std::string_view value, std::string_view material, Textures& textures) {
    bool moved = false;
    remove_options(value, moved);
    std::string_view name = trimmed_name(value);
    if (name.empty()) return Textures::kNoTexture;
    if (!textures.exists(name) && textures.exists(without_comment(name))) name = without_comment(name);
    if (!textures.exists(name)) {  // perhaps a path on another machine
        const std::string_view beside = name.substr(name.find_last_of("/\\") + 1);
        if (textures.exists(beside)) name = beside;
    }
    if (moved) {
        textures.warnings.push_back("material " + std::string(material) +
                                    ": the offset and scale of its texture are left out");
    }
    return textures.load(name);
}

std::array<float, 3> read_color(TextScanner& in) {
    std::vector<std::array<float, 3>> color(1);
    for (float& channel : color[0]) {
        const std::optional<double> value = parse_real(in.word_on_line());
        if (!value) return kNoColor;  // "Kd spectral file.rfl"
        channel = static_cast<float>(*value);
    }
    scale_colors(color);
    return color[0];
}

}  // namespace

std::string_view trimmed_name(std::string_view name) {
    name.remove_prefix(std::min(name.find_first_not_of(kBlanks), name.size()));
    name.remove_suffix(name.size() - std::min(name.find_last_not_of(kBlanks) + 1, name.size()));
    if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
    return name;
}

std::string_view without_comment(std::string_view name) {
    const size_t comment = std::min(name.find(" #"), name.find("\t#"));
    return comment == std::string_view::npos ? name : trimmed_name(name.substr(0, comment));
}

void read_materials(std::string_view text, Textures& textures, std::vector<Material>& materials) {
    TextScanner in(text, {.comments = true, .continuations = true});
    const size_t first = materials.size();
    while (!in.at_end()) {
        const std::string_view keyword = in.word_on_line();
        if (equals_ignoring_case(keyword, "newmtl")) {
            materials.push_back({std::string(trimmed_name(in.rest_of_line()))});
            continue;
        }
        const bool is_in_material = materials.size() > first;
        if (is_in_material && equals_ignoring_case(keyword, "map_kd")) {
            const std::string value = in.rest_of_line();
            materials.back().texture = load_map(value, materials.back().name, textures);
            continue;
        }
        if (is_in_material && equals_ignoring_case(keyword, "kd")) materials.back().color = read_color(in);
        in.next_line();
    }
}

void read_material_files(std::string_view names, Textures& textures, std::vector<Material>& materials) {
    if (!textures.exists(trimmed_name(names))) names = without_comment(names);
    constexpr int kMostFiles = 64;  // a line with more is nonsense
    constexpr size_t kLongestName = 255;
    for (int files = 0; files < kMostFiles; ++files) {
        names.remove_prefix(std::min(names.find_first_not_of(kBlanks), names.size()));
        if (names.empty()) return;
        // The longest name that exists, else the first word.
        size_t size = std::min(names.size(), kLongestName);
        while (size > 0 && !textures.exists(trimmed_name(names.substr(0, size)))) {
            const size_t blank = names.substr(0, size).find_last_of(kBlanks);
            size = blank == std::string_view::npos ? 0 : blank;
        }
        if (size == 0) size = first_word(names).size();
        const std::string text = textures.read_text(trimmed_name(names.substr(0, size)));
        read_materials(text, textures, materials);
        names.remove_prefix(size);
    }
}

const Material* find_material(const std::vector<Material>& materials, std::string_view name) {
    for (const std::string_view wanted : {name, without_comment(name)}) {
        for (const Material& material : materials) {
            if (material.name == wanted || without_comment(material.name) == wanted) return &material;
        }
    }
    return nullptr;
}

}  // namespace gim
