// libFuzzer: the reader of OBJ, and that of its material files. What follows the first NUL byte is one of those.
#include "tests/fuzz/reader_fuzz.h"
#include "tools/read_mtl.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    const uint8_t* const zero = std::find(data, data + size, uint8_t{0});
    gim::fuzz::read_as(gim::MeshFormat::kObj, data, static_cast<size_t>(zero - data));
    const std::string_view materials(reinterpret_cast<const char*>(zero), static_cast<size_t>(data + size - zero));
    gim::Textures textures("/nonexistent");
    std::vector<gim::Material> found;
    gim::read_materials(materials, textures, found);
    for (const gim::Material& material : found) {
        if (!gim::find_material(found, material.name)) __builtin_trap();
    }
    return 0;
}
