// The same from C++: the header, the sizes, one decode.
#include <gim/decoder.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <vector>

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    std::ifstream file(argv[1], std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
    gim_info info;
    if (gim_read_info(bytes.data(), bytes.size(), nullptr, &info) != GIM_OK) return 1;
    for (uint32_t image = 0; image < info.image_count; ++image) {
        gim_level_info level;
        if (gim_read_level_info(&info, bytes.data(), bytes.size(), image, 0, &level) != GIM_OK) return 1;
        std::vector<float> positions(size_t{level.vertex_count} * 3);
        std::vector<uint32_t> triangles(size_t{level.triangle_count} * 3);
        std::vector<double> scratch(level.scratch_size / sizeof(double) + 1);
        if (gim_decode_mesh(&info, bytes.data(), bytes.size(), image, 0, positions.data(), nullptr, nullptr,
                            triangles.data(), scratch.data(), scratch.size() * sizeof(double)) != GIM_OK)
            return 1;
        std::printf("image %u: side %u\n", static_cast<unsigned>(image), static_cast<unsigned>(level.side));
    }
    return 0;
}
