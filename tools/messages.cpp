// What the commands print.
#include <cerrno>
#include <cstdio>

#include "tools/commands.h"
#include "tools/companions.h"
#include "tools/descriptor.h"
#include "tools/file.h"

namespace gim {

int report_error(const std::string& file, const Error& error) {
    const std::string stage(stage_name(error.stage));
    std::fprintf(stderr, "gim: %s: %s: %s\n", file.c_str(), stage.c_str(), error.message.c_str());
    return 1;
}

void print_warnings(const std::string& file, const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
        std::fprintf(stderr, "gim: %s: warning: %s\n", file.c_str(), warning.c_str());
}

Result<TriangleMesh> read_surface_aloud(const std::string& path, uint32_t level, const ReadOptions& options) {
    std::vector<std::string> warnings;
    Result<TriangleMesh> surface = read_surface(path, level, options, &warnings);
    print_warnings(shown_name(path, Direction::kRead), warnings);
    return surface;
}

int report_error(const FileError& failure) { return report_error(failure.name, failure.error); }

std::string with_thousands(uint64_t number) {
    std::string digits = std::to_string(number);
    for (size_t i = digits.size(); i > 3; i -= 3) digits.insert(i - 3, 1, ',');
    return digits;
}

void print_line(const std::string& text) { std::printf("%s\n", text.c_str()); }

std::optional<FileError> results_failure() {
    errno = 0;
    const bool flushed = std::fflush(stdout) == 0;
    const int cause = errno;
    if (flushed && std::ferror(stdout) == 0) return {};
    const std::string why = cause != 0 ? reason(cause) : "the stream does not take them";
    return FileError{"standard output", {Stage::kWrite, "cannot write the results: " + why}};
}

std::optional<FileError> check_files(std::span<const NamedFile> files) {
    if (auto clash = find_clash(files)) return clash;
    for (const NamedFile& output : files) {
        if (output.name.empty() || output.direction == Direction::kRead) continue;
        const Result<void> writable = check_writable(output.name);
        if (!writable.ok()) return FileError{shown_name(output.name, output.direction), writable.error()};
        for (const NamedFile& input : files) {
            if (input.name.empty() || input.direction == Direction::kWrite) continue;
            if (!is_companion(input.name, output.name)) continue;
            return FileError{output.name,
                             {Stage::kWrite, "this file belongs to " + input.role +
                                                 ", which names it as its material, "
                                                 "texture or buffer; choose another name"}};
        }
    }
    return {};
}

}  // namespace gim
