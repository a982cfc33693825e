#include "tools/output_files.h"

#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <utility>

#include "tools/descriptor.h"
#include "tools/partial_file.h"

namespace gim {
namespace {

namespace fs = std::filesystem;

Result<void> write_in_place(const std::string& name, std::span<const uint8_t> bytes) {
    if (const std::optional<int> open = descriptor_named(name, Direction::kWrite)) {
        return write_all(*open, bytes) ? Result<void>() : cannot_write(errno);
    }
    Descriptor file(::open(name.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.get() < 0 || !write_all(file.get(), bytes) || !file.close_now()) return cannot_write(errno);
    return {};
}

// Nobody's permission to write is a wish, so root heeds it too. Else opens the file, because access() is wrong about some
// network folders. Changes nothing.
Result<void> check_existing(const fs::path& target, mode_t mode) {
    if ((mode & 0222U) == 0) return cannot_write(EACCES);
    const Descriptor file(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.get() < 0) return cannot_write(errno);
    return {};
}

}  // namespace

bool is_written_in_place(const std::string& name) {
    if (descriptor_named(name, Direction::kWrite)) return true;
    struct stat info = {};
    return ::stat(name.c_str(), &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode);
}

Result<void> check_writable(const std::string& path) {
    if (is_written_in_place(path)) {
        // Not opened: that would wait for the reader of a pipe.
        const std::optional<int> open = descriptor_named(path, Direction::kWrite);
        const int failed = open ? ::fcntl(*open, F_GETFD) : ::access(path.c_str(), W_OK);
        return failed == -1 ? cannot_write(errno) : Result<void>();
    }
    const fs::path target = target_of(path);
    struct stat info = {};
    if (::lstat(target.c_str(), &info) == 0) {
        if (S_ISDIR(info.st_mode)) return cannot_write(EISDIR);
        if (S_ISLNK(info.st_mode)) return cannot_write(ELOOP);
        const Result<void> open = check_existing(target, info.st_mode);
        if (!open.ok()) return open.error();
    } else if (errno != ENOENT) {
        return cannot_write(errno);
    }
    const fs::path folder = folder_of(target);
    std::error_code error;
    if (!fs::is_directory(folder, error)) {
        return Error{Stage::kWrite, "cannot write: there is no folder '" + folder.string() + "'; make it first"};
    }
    // Makes a file and removes it, for the same reason.
    const auto probe = PartialFile::beside(target);
    if (!probe.ok()) return probe.error();
    return {};
}

Result<void> write_file(const std::string& path, std::span<const uint8_t> bytes) {
    OutputFiles files;
    const Result<void> staged = files.stage(path, {bytes.begin(), bytes.end()});
    if (!staged.ok()) return staged.error();
    if (const auto failure = files.commit()) return failure->error;
    return {};
}

OutputFiles::OutputFiles() = default;
OutputFiles::~OutputFiles() = default;

Result<void> OutputFiles::stage(const std::string& name, Bytes bytes) {
    if (is_written_in_place(name)) {
        streams_.push_back({name, std::move(bytes)});
        return {};
    }
    const Result<void> writable = check_writable(name);
    if (!writable.ok()) return writable.error();
    auto partial = PartialFile::beside(target_of(name));
    if (!partial.ok()) return partial.error();
    const Result<void> written = partial.value()->write(bytes);
    if (!written.ok()) return written.error();
    files_.push_back({name, std::move(partial.value())});
    return {};
}

std::optional<FileError> OutputFiles::commit() {
    for (const Stream& stream : streams_) {
        const Result<void> written = write_in_place(stream.name, stream.bytes);
        if (!written.ok()) return FileError{shown_name(stream.name, Direction::kWrite), written.error()};
    }
    for (const File& file : files_) {
        const Result<void> named = file.partial->take_name();
        if (!named.ok()) return FileError{file.name, named.error()};
    }
    streams_.clear();
    files_.clear();
    return {};
}

}  // namespace gim
