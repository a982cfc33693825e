// What the shaders read, as decoder/shaders/README.md describes it.
#pragma once

#include <array>
#include <cstdint>

namespace gim {

// One decoded image: where its samples and its normals are.
struct ShaderDomain {
    uint32_t first_sample = 0, width = 0, slot = 0, unused = 0;
    std::array<float, 2> map_origin{}, map_slot{}, map_interval{}, unused2{};
};
static_assert(sizeof(ShaderDomain) == 48);

struct ShaderInstance {
    std::array<float, 16> transform = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};  // column after column
    std::array<float, 4> ball{};  // centre and radius, in the world
    uint32_t domain = 0;
    uint32_t extra = 0;  // halvings of every cell
    float error = 0;     // of the patches, in the world; above 0 the GPU adds up to 2 halvings where a screen shows it
    uint32_t unused = 0;
};
static_assert(sizeof(ShaderInstance) == 96);

struct ShaderView {
    std::array<float, 16> world_to_clip{};  // column after column
    std::array<float, 4> eye{};             // w: pixels of a unit at distance 1, over the pixels that an error may have
    std::array<float, 4> light{0, 0, 1, 0.25f};  // towards the light; w: ambient part
    std::array<float, 4> front{0.8f, 0.8f, 0.8f, 1}, back{0, 0, 1, 1};
    uint32_t patch_count = 0, capacity = 0;
    std::array<uint32_t, 2> unused{};
};
static_assert(sizeof(ShaderView) == 144);

// The command that the expansion writes. `needed` counts triangles, also those that had no room.
struct ShaderDraw {
    uint32_t vertex_count = 0, instance_count = 1, first_vertex = 0, first_instance = 0, needed = 0;
};
static_assert(sizeof(ShaderDraw) == 20);

}  // namespace gim
