#include "tools/batch/hash_file.h"

#include <sys/stat.h>
#include <xxhash.h>

#include <cerrno>
#include <memory>
#include <vector>

#include "tools/descriptor.h"

namespace gim {
namespace {

constexpr size_t kPiece = size_t{1} << 20;  // bytes

struct FreeState {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};

std::string hexadecimal(XXH128_hash_t hash) {
    XXH128_canonical_t bytes;
    XXH128_canonicalFromHash(&bytes, hash);
    std::string text;
    for (const unsigned char byte : bytes.digest) {
        text += "0123456789abcdef"[byte >> 4U];
        text += "0123456789abcdef"[byte & 15U];
    }
    return text;
}

Error cannot_read(int error) { return {Stage::kInput, "cannot read: " + reason(error)}; }

}  // namespace

Result<std::string> hash_file(const std::string& path) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));  // a pipe must not make it wait
    struct stat info = {};
    if (file.get() < 0 || ::fstat(file.get(), &info) != 0) return cannot_read(errno);
    if (!S_ISREG(info.st_mode)) return Error{Stage::kInput, "this is no file but a folder, a pipe or a device"};
    const std::unique_ptr<XXH3_state_t, FreeState> state(XXH3_createState());
    if (!state || XXH3_128bits_reset(state.get()) != XXH_OK) return cannot_read(ENOMEM);
    std::vector<uint8_t> piece(kPiece);
    for (;;) {
        const ssize_t size = ::read(file.get(), piece.data(), piece.size());
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) return cannot_read(errno);
        if (size == 0) return hexadecimal(XXH3_128bits_digest(state.get()));
        XXH3_128bits_update(state.get(), piece.data(), static_cast<size_t>(size));
    }
}

}  // namespace gim
