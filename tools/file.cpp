#include "tools/file.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>

#include "tools/descriptor.h"
#include "tools/named_file.h"

namespace gim {
namespace {

namespace fs = std::filesystem;

Result<Bytes> read_all(int fd) {
    // The size is only a hint, because pipes have none.
    Bytes bytes;
    struct stat info = {};
    if (::fstat(fd, &info) == 0 && S_ISREG(info.st_mode)) bytes.reserve(static_cast<size_t>(info.st_size) + 1);
    size_t used = 0;
    for (;;) {
        if (used == bytes.size()) bytes.resize(std::max(bytes.capacity(), used + (size_t{1} << 16)));
        const ssize_t n = ::read(fd, bytes.data() + used, bytes.size() - used);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return Error{Stage::kInput, "the file cannot be read: " + reason(errno)};
        if (n == 0) break;
        used += static_cast<size_t>(n);
    }
    bytes.resize(used);
    return bytes;
}

}  // namespace

Result<Bytes> read_file(const std::string& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) return Error{Stage::kInput, reason(EISDIR) + "; name a file"};
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (file.get() < 0) return Error{Stage::kInput, "the file cannot be opened: " + reason(errno)};
    return read_all(file.get());
}

Result<Bytes> read_named(const std::string& name) {
    const std::optional<int> open = descriptor_named(name, Direction::kRead);
    return open ? read_all(*open) : read_file(name);
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
