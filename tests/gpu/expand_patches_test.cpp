// The reference itself: triangles of patches leave no gaps.
#include <gtest/gtest.h>

#include "tests/gpu/views.h"

namespace gim {
namespace {

using namespace gim::test;

TEST(ExpandPatches, ClosedSurfacesStayClosed) {
    Random random(3);
    uint32_t most_sizes = 0;
    for (const char* name : kModels) {
        SCOPED_TRACE(name);
        Model model(name);
        for (uint32_t bands = 1; bands <= model.depth() + 1; ++bands) {
            const std::vector<gim_patch> patches = model.banded_patches(model.depth() + 1 - bands, bands, random);
            most_sizes = std::max(most_sizes, count_cell_sizes(patches));
            for (uint32_t extra = 0; extra < 3; ++extra) {
                const auto triangles = placed(expand_patches(patches, model.surface, extra), model.surface);
                EXPECT_EQ(count_open_edges(triangles), 0u) << "extra " << extra;
            }
        }
    }
    EXPECT_EQ(most_sizes, 5u);
}

TEST(ExpandPatches, PlacesInTheMapAreThoseOfTheDecoder) {
    for (const char* name : kRefinables) {
        for (const uint32_t level : {0u, 1u}) {
            SCOPED_TRACE(name + std::to_string(level));
            Model model(name, level);
            std::map<std::array<float, 3>, std::set<std::array<double, 2>>> places;  // rounded to a 1024th of a texel
            const auto rounded = [](const std::array<double, 2>& t) {
                return std::array<double, 2>{std::round(t[0] * 1024), std::round(t[1] * 1024)};
            };
            for (const SoftTriangle& t : model.decoded_mesh()) {
                for (size_t k = 0; k < 3; ++k) places[t.positions[k]].insert(rounded(t.texels[k]));
            }
            const auto triangles = placed(expand_patches(model.finest_patches(), model.surface), model.surface);
            for (const SoftTriangle& t : triangles) {
                for (size_t k = 0; k < 3; ++k)
                    ASSERT_EQ(places[t.positions[k]].count(rounded(t.texels[k])), 1u) << t.texels[k][0];
            }
        }
    }
}

}  // namespace
}  // namespace gim
