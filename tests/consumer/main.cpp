// Does what main.c does, in C++ with gim/decoder.hpp.
#include <gim/decoder.hpp>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream file(argv[1], std::ios::binary);
    const std::vector<char> read{std::istreambuf_iterator<char>(file), {}};
    const std::vector<uint8_t> bytes(read.begin(), read.end());
    gim::Decoder decoder;
    if (decoder.open(bytes) != GIM_OK) return 1;
    for (uint32_t image = 0; image < decoder.info().image_count; ++image) {
        gim::DecoderLevel level;
        if (decoder.read_level(image, 0, &level) != GIM_OK) return 1;
        std::vector<float> positions(size_t{level.vertex_count} * 3);
        std::vector<uint32_t> triangles(size_t{level.triangle_count} * 3);
        if (decoder.mesh(level, {positions, {}, {}, triangles}) != GIM_OK) return 1;
        std::printf("image %u: side %u\n", static_cast<unsigned>(image), static_cast<unsigned>(level.side));
    }
    return 0;
}
