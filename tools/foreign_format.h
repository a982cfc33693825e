// Names of files that gim does not read, so that messages can say what a file is and what to do.
#pragma once

#include <string>
#include <string_view>

namespace gim {

// Without the three bytes of a UTF-8 byte order mark, if the text begins with one.
std::string_view without_byte_order_mark(std::string_view text);

// True if the text is UTF-16 or UTF-32, with a byte order mark or by its zero bytes.
bool is_wide_text(std::string_view text);

// "it is a 3MF file; export it as PLY, OBJ, STL or GLB". Empty if the content is not known.
std::string describe_foreign_format(std::string_view text);

}  // namespace gim
