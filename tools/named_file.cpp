#include "tools/named_file.h"

#include <sys/stat.h>
#include <unistd.h>

#include <charconv>
#include <string_view>
#include <system_error>

namespace gim {
namespace {

namespace fs = std::filesystem;

constexpr int kMostLinks = 40;  // longer chains are cycles

// The file that a name leads to, as the system knows it. A file that does not exist is known by its folder and name.
struct Place {
    std::optional<int> descriptor;
    bool is_known = false;
    bool exists = false;
    mode_t mode = 0;
    dev_t device = 0;
    ino_t inode = 0;
    std::string new_name;
};

Place place_of(const NamedFile& file) {
    Place place;
    place.descriptor = descriptor_named(file.name, file.direction);
    struct stat info = {};
    if (place.descriptor) {
        place.exists = ::fstat(*place.descriptor, &info) == 0;
    } else {
        place.exists = ::stat(file.name.c_str(), &info) == 0;
    }
    place.is_known = place.exists;
    if (!place.exists && !place.descriptor) {
        const fs::path target = target_of(file.name);
        place.is_known = ::stat(folder_of(target).c_str(), &info) == 0;
        place.new_name = target.filename().string();
    }
    place.mode = info.st_mode;
    place.device = info.st_dev;
    place.inode = info.st_ino;
    return place;
}

bool are_one(const Place& a, const Place& b) {
    if (a.descriptor && a.descriptor == b.descriptor) return true;
    return a.is_known && b.is_known && a.exists == b.exists && a.device == b.device && a.inode == b.inode &&
           a.new_name == b.new_name;
}

bool is_device(const Place& place) { return place.exists && (S_ISCHR(place.mode) || S_ISBLK(place.mode)); }

std::optional<std::string> clash_of(const NamedFile& a, const NamedFile& b) {
    const Place first = place_of(a), second = place_of(b);
    if (!are_one(first, second)) return {};
    const std::string both = a.role + " and " + b.role;
    const bool same_stream = first.descriptor && first.descriptor == second.descriptor;
    if (a.direction == Direction::kRead && b.direction == Direction::kRead) {
        const bool reads_again = !same_stream && first.exists && (S_ISREG(first.mode) || S_ISDIR(first.mode));
        if (reads_again || !first.exists) return {};
        return both + " are one stream, and a stream is read only once; name a file";
    }
    if (is_device(first) && !same_stream) return {};
    return both + " are two names of one file; nothing was done; choose another name for one of them";
}

}  // namespace

std::optional<int> descriptor_named(const std::string& name, Direction direction) {
    if (name == "-") return direction == Direction::kRead ? STDIN_FILENO : STDOUT_FILENO;
    if (name == "/dev/stdin") return STDIN_FILENO;
    if (name == "/dev/stdout") return STDOUT_FILENO;
    if (name == "/dev/stderr") return STDERR_FILENO;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!name.starts_with(folder)) continue;
        int number = -1;
        const char* const end = name.data() + name.size();
        const auto [stop, error] = std::from_chars(name.data() + folder.size(), end, number);
        if (error == std::errc() && stop == end && number >= 0) return number;
    }
    return {};
}

std::string shown_name(const std::string& name, Direction direction) {
    if (name != "-") return name;
    return direction == Direction::kRead ? "standard input" : "standard output";
}

bool is_standard_output(const std::string& name) {
    const Place place = place_of({"", name, Direction::kWrite});
    const Place results = place_of({"", "-", Direction::kWrite});
    return are_one(place, results) && (place.descriptor == results.descriptor || !is_device(place));
}

fs::path target_of(const std::string& name) {
    fs::path path = name;
    std::error_code no_link;
    for (int i = 0; i < kMostLinks; ++i) {
        const fs::path link = fs::read_symlink(path, no_link);
        if (no_link) break;
        path = path.parent_path() / link;
    }
    return path;
}

fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

std::optional<FileError> find_clash(std::span<const NamedFile> files) {
    for (size_t b = 0; b < files.size(); ++b) {
        for (size_t a = 0; a < b; ++a) {
            if (files[a].name.empty() || files[b].name.empty()) continue;
            const std::optional<std::string> clash = clash_of(files[a], files[b]);
            if (!clash) continue;
            const Stage stage = files[b].direction == Direction::kRead ? Stage::kInput : Stage::kWrite;
            return FileError{shown_name(files[b].name, files[b].direction), {stage, *clash}};
        }
    }
    return {};
}

}  // namespace gim
