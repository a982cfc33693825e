// Material files of OBJ.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "tools/polygons.h"
#include "tools/textures.h"

namespace gim {

struct Material {
    std::string name;
    uint32_t texture = Textures::kNoTexture;  // map_Kd
    std::array<float, 3> color = kNoColor;    // Kd, 0..1
};

// Adds the materials of an .mtl text. Loads their textures.
void read_materials(std::string_view text, Textures& textures, std::vector<Material>& materials);

// Reads the files that the rest of an "mtllib" line names. Names may hold blanks: takes the longest that exist.
void read_material_files(std::string_view names, Textures& textures, std::vector<Material>& materials);

// The first material of this name; null if there is none. A comment after the name does not count.
const Material* find_material(const std::vector<Material>& materials, std::string_view name);

// Without blanks and quotes around it.
std::string_view trimmed_name(std::string_view name);
// Without a comment at its end: " #" and what follows.
std::string_view without_comment(std::string_view name);

}  // namespace gim
