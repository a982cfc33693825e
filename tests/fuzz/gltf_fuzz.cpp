// libFuzzer: the reader of glTF and GLB.
#include "tests/fuzz/reader_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    gim::fuzz::read_as(gim::MeshFormat::kGltf, data, size);
    return 0;
}
