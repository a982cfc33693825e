// Reads and writes whole files. Writing is all or nothing: readers of the path see the old file or the complete new
// one.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gim/encoder.h"

namespace gim {

using Bytes = std::vector<uint8_t>;

// Reads the whole file. Errors give the system's reason.
Result<Bytes> read_file(const std::string& path);

// Checks, before minutes of work, that write_file can succeed: the folder exists and takes new files, and the path is
// not a folder. Leaves nothing behind.
Result<bool> check_writable(const std::string& path);

// Writes to a temporary name in the same folder and renames it. A failure leaves no partial file and no changed file.
// A path that is not a regular file (/dev/null, a pipe) is written in place. Follows symbolic links.
Result<bool> write_file(const std::string& path, std::span<const uint8_t> bytes);

// Returns the extension in lower case without the dot. Empty if there is none.
std::string extension_of(const std::string& path);

}  // namespace gim
