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

// The same for a name on the command line: "-" is standard input (named_file.h).
Result<Bytes> read_named(const std::string& name);

// Tells early, before minutes of work, whether write_file can succeed: the folder exists and takes new files, and the
// path is neither a folder nor write-protected. Leaves nothing behind.
Result<void> check_writable(const std::string& path);

// Writes to a temporary name in the same folder and renames, so that a failure leaves neither a partial nor a changed
// file. A path that is no regular file (/dev/null, a pipe) is written in place, and "-" is standard output. Symbolic
// links are followed.
Result<void> write_file(const std::string& path, std::span<const uint8_t> bytes);

// Returns the extension in lower case without the dot. Empty if there is none.
std::string extension_of(const std::string& path);

}  // namespace gim
