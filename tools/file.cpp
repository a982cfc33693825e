#include "tools/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace gim {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) { return std::generic_category().message(error); }

Error cannot_write(const std::string& what) {
    return {Stage::kWrite, "cannot write: " + what + "; choose an existing folder that you may write to"};
}

// A file descriptor that closes itself.
class Descriptor {
  public:
    explicit Descriptor(int fd) : fd_(fd) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() { close_now(); }

    int get() const { return fd_; }
    // Closing may report a write that failed late (quota, network).
    bool close_now() {
        const int fd = fd_;
        fd_ = -1;
        return fd < 0 || ::close(fd) == 0;
    }

  private:
    int fd_;
};

bool write_all(int fd, std::span<const uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        bytes = bytes.subspan(static_cast<size_t>(n));
    }
    return true;
}

// Follows symbolic links to the file that receives the bytes.
fs::path target_of(const std::string& path) {
    std::error_code ignored;
    const fs::path resolved = fs::weakly_canonical(path, ignored);
    return ignored || resolved.empty() ? fs::path(path) : resolved;
}

fs::path folder_of(const fs::path& target) { return target.has_parent_path() ? target.parent_path() : fs::path("."); }

std::string temporary_beside(const fs::path& target) { return (folder_of(target) / ".gim-XXXXXX").string(); }

// Returns the mode of the file to replace, else the mode that the umask gives. mkstemp alone makes private files.
mode_t final_mode(const fs::path& target) {
    struct stat info = {};
    if (::stat(target.c_str(), &info) == 0) return info.st_mode & 07777U;
    const mode_t mask = ::umask(0);
    ::umask(mask);
    return 0666U & ~mask;
}

Result<void> write_in_place(const fs::path& target, std::span<const uint8_t> bytes) {
    Descriptor file(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (file.get() < 0 || !write_all(file.get(), bytes) || !file.close_now()) return cannot_write(reason(errno));
    return {};
}

}  // namespace

Result<Bytes> read_file(const std::string& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) return Error{Stage::kInput, "this is a folder; name a file"};
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) return Error{Stage::kInput, "the file cannot be opened: " + reason(errno)};

    // The size is only a hint, because pipes have none.
    Bytes bytes;
    struct stat info = {};
    if (::fstat(file.get(), &info) == 0 && S_ISREG(info.st_mode)) bytes.reserve(static_cast<size_t>(info.st_size) + 1);
    size_t used = 0;
    for (;;) {
        if (used == bytes.size()) bytes.resize(std::max(bytes.capacity(), used + (size_t{1} << 16)));
        const ssize_t n = ::read(file.get(), bytes.data() + used, bytes.size() - used);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return Error{Stage::kInput, "the file cannot be read: " + reason(errno)};
        if (n == 0) break;
        used += static_cast<size_t>(n);
    }
    bytes.resize(used);
    return bytes;
}

Result<void> check_writable(const std::string& path) {
    std::error_code error;
    const fs::path target = target_of(path);
    const fs::file_status status = fs::status(target, error);
    if (fs::is_directory(status)) return cannot_write("it is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) {
        return ::access(target.c_str(), W_OK) == 0 ? Result<void>() : cannot_write(reason(errno));
    }
    const fs::path folder = folder_of(target);
    if (!fs::is_directory(folder, error)) return cannot_write("there is no folder '" + folder.string() + "'");
    // Makes a file and removes it, because access() is wrong for root and on some network folders.
    std::string name = temporary_beside(target);
    const Descriptor file(::mkostemp(name.data(), O_CLOEXEC));
    if (file.get() < 0) return cannot_write(reason(errno));
    ::unlink(name.c_str());
    return {};
}

Result<void> write_file(const std::string& path, std::span<const uint8_t> bytes) {
    std::error_code error;
    const fs::path target = target_of(path);
    const fs::file_status status = fs::status(target, error);
    if (fs::is_directory(status)) return cannot_write("it is a folder");
    if (fs::exists(status) && !fs::is_regular_file(status)) return write_in_place(target, bytes);

    std::string name = temporary_beside(target);
    Descriptor file(::mkostemp(name.data(), O_CLOEXEC));
    if (file.get() < 0) return cannot_write(reason(errno));
    const bool written = write_all(file.get(), bytes) && ::fchmod(file.get(), final_mode(target)) == 0 &&
                         file.close_now() && std::rename(name.c_str(), target.c_str()) == 0;
    if (!written) {
        const int cause = errno;
        ::unlink(name.c_str());
        return cannot_write(reason(cause));
    }
    return {};
}

std::string extension_of(const std::string& path) {
    std::string extension = fs::path(path).extension().string();
    if (!extension.empty()) extension.erase(0, 1);
    for (char& c : extension) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    }
    return extension;
}

}  // namespace gim
