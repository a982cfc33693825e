// libFuzzer: the reader of OFF.
#include "tests/fuzz/reader_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    gim::fuzz::read_as(gim::MeshFormat::kOff, data, size);
    return 0;
}
