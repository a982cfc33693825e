// Patches that are split put the same vertices on their borders.
#include "tools/gpu/split_patches.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/gpu/views.h"

namespace gim {
namespace {

using namespace gim::test;

TEST(SplitPatches, TrianglesStayTheSame) {
    Random random(9);
    for (const char* name : {"tiles-one-lossy", "torus-33-lossy"}) {
        SCOPED_TRACE(name);
        Model model(name);
        for (int i = 0; i < 10; ++i) {
            const auto patches = model.banded_patches(model.depth() - 1, 2, random);
            for (uint32_t extra = 0; extra < 3; ++extra) {
                const auto whole = expand_patches(patches, model.surface, extra);
                for (const uint32_t most : {1u, 2u, 3u, 4u}) {
                    InstancedPatches split;
                    add_patches(patches, 5, most, extra, &split);
                    for (const gim_patch& p : split.patches) {
                        const uint32_t edges = std::min<uint32_t>(p.side, p.inside + extra + (p.finer != 0 ? 1 : 0));
                        EXPECT_TRUE(edges <= most || p.inside == 0);
                    }
                    EXPECT_EQ(split.instances, std::vector<uint32_t>(split.patches.size(), 5));
                    const auto parts = expand_patches(split.patches, model.surface, extra);
                    EXPECT_EQ(std::multiset(parts.begin(), parts.end()), std::multiset(whole.begin(), whole.end()));
                }
            }
        }
    }
}

}  // namespace
}  // namespace gim
