// What a file name on the command line stands for: a file, or a stream that is open already.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "gim/encoder.h"

namespace gim {

enum class Direction { kRead, kWrite };

// Returns the open descriptor that the name stands for: "-", /dev/stdin, /dev/stdout, /dev/fd/N, /proc/self/fd/N. Such
// a stream goes on where it stands. Opened by its name, a redirected one would begin again.
std::optional<int> descriptor_named(const std::string& name, Direction direction);

// The name for people: "standard input" and "standard output" for "-".
std::string shown_name(const std::string& name, Direction direction);

// True if bytes written to this name go where the results go.
bool is_standard_output(const std::string& name);

// Follows symbolic links from the name to the file that receives the bytes, also if there is no such file yet. Folders
// on the way stay as they are.
std::filesystem::path target_of(const std::string& name);

// The folder that holds the path.
std::filesystem::path folder_of(const std::filesystem::path& path);

// A file that a command reads or writes.
struct NamedFile {
    std::string role;  // as the help calls it: "OUT", "--json"
    std::string name;  // empty: the command does not use it
    Direction direction = Direction::kRead;
};

struct FileError {
    std::string name;
    Error error;
};

// Tells two names of one file apart from two files: by what the system says, so also through links and "./". Returns
// the first pair that would lose bytes: one file that is read and written, or written twice, or a stream that is read
// twice. Devices as /dev/null keep nothing, so they may be named twice.
std::optional<FileError> find_clash(std::span<const NamedFile> files);

}  // namespace gim
