// libFuzzer: the reader of PLY.
#include "tests/fuzz/reader_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    gim::fuzz::read_as(gim::MeshFormat::kPly, data, size);
    return 0;
}
