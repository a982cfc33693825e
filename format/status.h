// Results of reading and decoding. The numbers are part of the C interface (gim/decoder.h) and are never reused.
#pragma once

#include <cstdint>

namespace gim {

// Negative: feed more bytes and call again. Zero: done. Positive: final.
enum class [[nodiscard]] Status : int32_t{
    kNeedMoreInput = -1,  // the bytes end before the requested level is complete
    kOk = 0,
    kNotGim = 1,              // the magic number is missing
    kUnsupportedVersion = 2,  // a newer format version, or an unknown critical chunk
    kMalformed = 3,           // bytes that no encoder writes
    kLimitExceeded = 4,       // valid, but larger than the caller's limits
    kBadArgument = 5,         // the caller's mistake
    kScratchTooSmall = 6,     // scratch or output memory is smaller than the size functions say
    kChecksum = 7,            // header or chunk bytes do not match their checksum
    kNoSuchLevel = 8,         // coarser than the coarsest level that the seams can close
    kNoSuchPlane = 9,         // the file has no plane of that kind
};

}  // namespace gim
