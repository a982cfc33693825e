#include "tools/partial_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <random>

#include "tools/named_file.h"

namespace gim {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = ".gim-partial-";
constexpr int kMostNames = 100;  // tries
constexpr long kUsualNameLength = 255;

std::string random_letters(size_t count) {
    constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
    std::random_device random;
    std::uniform_int_distribution<size_t> letter(0, kLetters.size() - 1);
    std::string text;
    for (size_t i = 0; i < count; ++i) text += kLetters[letter(random)];
    return text;
}

// Cuts the name to that many bytes, between two characters of UTF-8.
std::string shortened(std::string name, size_t most) {
    if (name.size() <= most) return name;
    while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xC0U) == 0x80U) --most;
    name.resize(most);
    return name;
}

std::string temporary_beside(const fs::path& target) {
    const fs::path folder = folder_of(target);
    const long limit = ::pathconf(folder.c_str(), _PC_NAME_MAX);
    const std::string end = kMark + random_letters(6);
    const auto most = static_cast<size_t>(limit > 0 ? limit : kUsualNameLength);
    const size_t room = most > end.size() ? most - end.size() - 1 : 0;
    return (folder / ("." + shortened(target.filename().string(), room) + end)).string();
}

std::string advice(int error) {
    switch (error) {
        case ENOSPC:
        case EDQUOT:
            return "make room, or choose another folder";
        case EFBIG:
            return "raise the limit (ulimit -f), or make a smaller file";
        case EISDIR:
            return "name a file";
        case ENAMETOOLONG:
            return "choose a shorter name";
        case EACCES:
        case EPERM:
        case EROFS:
            return "choose a file and a folder that you may write to";
        case ENOENT:
        case ENOTDIR:
            return "choose an existing folder";
        default:
            return "choose another place";
    }
}

}  // namespace

std::optional<std::string> target_of_partial(const std::string& name) {
    const size_t mark = name.rfind(kMark);
    if (mark == std::string::npos || mark < 1 || name.front() != '.') return {};
    return name.substr(1, mark - 1);
}

void remove_partials_of(const fs::path& target) {
    const std::string begin = "." + target.filename().string() + kMark;
    std::error_code failure;
    for (fs::directory_iterator entry(folder_of(target), failure), end; !failure && entry != end;
         entry.increment(failure)) {
        if (entry->path().filename().string().starts_with(begin)) ::unlink(entry->path().c_str());
    }
}

Error cannot_write(int error) { return {Stage::kWrite, "cannot write: " + reason(error) + "; " + advice(error)}; }

bool write_all(int fd, std::span<const uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t n = ::write(fd, bytes.data(), bytes.size());
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        bytes = bytes.subspan(static_cast<size_t>(n));
    }
    return true;
}

Result<std::unique_ptr<PartialFile>> PartialFile::beside(fs::path target) {
    struct stat info = {};
    // A private file stays private while it is written. A new one gets the permissions that the umask leaves.
    const mode_t mode = ::stat(target.c_str(), &info) == 0 ? 0600 : 0666;
    for (int i = 0; i < kMostNames; ++i) {
        std::unique_ptr<PartialFile> partial(new PartialFile(target, temporary_beside(target)));
        Descriptor file(::open(partial->path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode));
        if (file.get() >= 0) {
            partial->file_.emplace(std::move(file));
            partial->is_there_ = true;
            return partial;
        }
        if (errno != EEXIST) return cannot_write(errno);
    }
    return cannot_write(EEXIST);
}

PartialFile::~PartialFile() {
    if (is_there_) ::unlink(path_.c_str());
}

Result<void> PartialFile::write(std::span<const uint8_t> bytes) {
    if (!write_all(file_->get(), bytes)) return cannot_write(errno);
    struct stat old = {};
    if (::stat(target_.c_str(), &old) == 0) {
        // The owner first, because a change of owner takes permissions away.
        if (::fchown(file_->get(), old.st_uid, old.st_gid) != 0 && errno != EPERM) return cannot_write(errno);
        if (::fchmod(file_->get(), old.st_mode & 0777U) != 0) return cannot_write(errno);
    }
    if (!file_->close_now()) return cannot_write(errno);
    return {};
}

Result<void> PartialFile::take_name() {
    if (std::rename(path_.c_str(), target_.c_str()) != 0) return cannot_write(errno);
    is_there_ = false;
    return {};
}

std::string PartialFile::hand_over() {
    removed_on_signal_.reset();
    is_there_ = false;
    return path_;
}

}  // namespace gim
