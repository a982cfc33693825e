// What the compute shader writes, triangle by triangle.
#include "tests/gpu/gpu_scene.h"

namespace gim {
namespace {

using namespace gim::test;

using Written = std::array<uint32_t, 4>;  // three samples and an instance

// Begins with its lowest sample, so that equal triangles compare equal.
std::multiset<Written> sorted(const std::vector<Written>& triangles) {
    std::multiset<Written> out;
    for (Written t : triangles) {
        std::rotate(t.begin(), std::min_element(t.begin(), t.begin() + 3), t.begin() + 3);
        out.insert(t);
    }
    return out;
}

std::multiset<Written> expected(const std::vector<gim_patch>& patches, const SurfaceData& surface, uint32_t extra,
                                uint32_t instance) {
    std::vector<Written> out;
    for (const SampleTriangle& t : expand_patches(patches, surface, extra)) {
        Written w{};
        for (size_t k = 0; k < 3; ++k) w[k] = t[k][1] << 16 | t[k][0];
        w[3] = instance;
        out.push_back(w);
    }
    return sorted(out);
}

class Expand : public GpuTest {};

TEST_F(Expand, EveryTriangleIsThere) {
    Random random(21);
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Model model(name);
        GlSurface surface = surface_of(model);
        for (uint32_t extra = 0; extra < 4; ++extra) {
            ShaderInstance instance;
            instance.extra = extra;
            surface.set_instances(std::span<const ShaderInstance>(&instance, 1));
            for (uint32_t first = 0; first <= model.depth(); ++first) {
                const std::vector<gim_patch> patches = model.banded_patches(first, model.depth() + 1 - first, random);
                surface.set_patches(one_instance(patches));
                expand_->expand(surface);
                EXPECT_EQ(sorted(expand_->read_triangles()), expected(patches, model.surface, extra, 0));
            }
        }
    }
}

TEST_F(Expand, NothingIsWrittenBeyondTheCapacity) {
    Model model("tiles-torus-lossy");
    GlSurface surface = surface_of(model);
    const std::vector<gim_patch> patches = model.finest_patches();
    surface.set_patches(one_instance(patches));
    const std::multiset<Written> all = expected(patches, model.surface, 0, 0);
    for (const uint32_t capacity : {0u, 1u, 100u, static_cast<uint32_t>(all.size()) - 1}) {
        auto made = GlExpand::create(capacity);
        ASSERT_TRUE(made.ok());
        GlExpand& small = made.value();
        small.expand(surface);
        EXPECT_EQ(small.needed(), all.size());
        const std::vector<Written> written = small.read_triangles();
        ASSERT_EQ(written.size(), capacity);
        for (const Written& t : sorted(written)) EXPECT_EQ(all.count(t), 1u);
        frame_->begin(kClear);
        small.draw(surface);
        small.set_capacity(small.needed());
        small.expand(surface);
        EXPECT_EQ(sorted(small.read_triangles()), all);
    }
}

TEST_F(Expand, MorePatchesThanGroupsInARow) {
    Model model("tiles-cube-lossy");
    GlSurface surface = surface_of(model);
    const std::vector<gim_patch> base = model.patches_of_depth([](const float*) { return 0u; });
    InstancedPatches many;
    while (many.patches.size() < 70000) add_patches(base, 0, kTessellatorEdges, 0, &many);
    surface.set_patches(many);
    expand_->expand(surface);
    EXPECT_EQ(expand_->needed(), 2 * many.patches.size());
    surface.set_patches({});
    expand_->expand(surface);
    EXPECT_EQ(expand_->needed(), 0u);
}

}  // namespace
}  // namespace gim
