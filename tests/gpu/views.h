// Models to draw, meshes of several levels over them, cameras.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/decoder/refine/refinable.h"
#include "tests/gpu/expand_patches.h"
#include "tests/random_numbers.h"
#include "tools/gpu/camera.h"
#include "tools/gpu/surface_data.h"

namespace gim::test {

// Closed surfaces in tests/gpu/models: squares and tiles, with and without handles.
inline constexpr const char* kModels[] = {"limbs-square", "limbs-tiles", "sphere-tiles", "tori-2-tiles",
                                          "torus-square"};

struct Model {
    std::string name;
    Refinable refinable;
    SurfaceData surface;
    std::array<double, 3> centre{};
    double radius = 0;
    std::vector<uint32_t> level_of;  // per vertex: splits that lead to it

    // A file of tests/gpu/models or of spec/vectors/valid.
    explicit Model(const std::string& file, uint32_t level = 0);

    uint32_t depth() const;  // log2 of the intervals of a tile
    // Patches of a mesh whose cells are halved wanted(position) times, and neighbours as little more as they must.
    using Wanted = std::function<uint32_t(const float* position)>;
    std::vector<gim_patch> patches_of_depth(const Wanted& wanted);
    // Bands across a random direction, each halved once more than the one before, from first_depth on. Cells have as many
    // sizes as there are bands, if random directions give that.
    std::vector<gim_patch> banded_patches(uint32_t first_depth, uint32_t bands, Random& random);
    std::vector<gim_patch> finest_patches();

    // The triangles of gim_decode_mesh at this level, with the places of gim_decode_grid in the normal map.
    std::vector<SoftTriangle> decoded_mesh() const;

  private:
    uint32_t level_;
};

// Different sizes of cells.
uint32_t count_cell_sizes(const std::vector<gim_patch>& patches);

// Looks at the model from a random side, sometimes past it, and from so near that it fills the frame.
Camera random_camera(const std::array<double, 3>& centre, double radius, Random& random);

// A view with a light from beside the eye.
ShaderView lit_view(const Camera& camera);

}  // namespace gim::test
