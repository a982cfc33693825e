// Tells whether a file changed.
#pragma once

#include <string>

#include "gim/encoder.h"

namespace gim {

// XXH3 of all bytes, 128 bits, in hexadecimal. Reads the file in pieces. It protects against chance, not against
// malice.
Result<std::string> hash_file(const std::string& path);

}  // namespace gim
