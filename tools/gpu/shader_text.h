// The shaders of decoder/shaders/ inside the program. cmake/EmbedText.cmake writes the source.
#pragma once

#include <string_view>

namespace gim {

// Returns the text of a file by its name; empty if there is none.
std::string_view shader_text(std::string_view name);

}  // namespace gim
