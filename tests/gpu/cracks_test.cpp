// Views of several levels have no gaps: no background and no back face shows through.
#include "tests/gpu/gpu_scene.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr int kCameras = 12;  // of each model

class Cracks : public GpuTest {
  protected:
    void expect_tight(uint32_t levels) {
        Random random(100 + levels);
        for (const char* name : kModels) {
            SCOPED_TRACE(name);
            Model model(name);
            GlSurface surface = surface_of(model);
            for (int i = 0; i < kCameras; ++i) {
                SCOPED_TRACE(i);
                const uint32_t finest = number_between(random, levels - 1, model.depth());
                const std::vector<gim_patch> patches = model.banded_patches(finest + 1 - levels, levels, random);
                ASSERT_EQ(count_cell_sizes(patches), levels);
                surface.set_patches(one_instance(patches));
                const ShaderView view = lit_view(random_camera(model.centre, model.radius, random));
                const std::string what = model.name + "-" + std::to_string(levels) + "-levels-" + std::to_string(i);
                expect_tight(Way::kExpand, placed(expand_patches(patches, model.surface), model.surface), model, view,
                             surface, what);
                expect_tight(Way::kTessellate, captured_triangles(surface, model.surface), model, view, surface, what);
            }
        }
        std::cout << levels << " levels: largest difference " << worst_[0] << " expanded, " << worst_[1]
                  << " tessellated\n";
    }

  private:
    enum class Way { kExpand, kTessellate };

    // The triangles have no gap, and the frame shows them and nothing else.
    void expect_tight(Way way, const std::vector<SoftTriangle>& triangles, const Model& model, const ShaderView& view,
                      GlSurface& surface, const std::string& what) {
        SCOPED_TRACE(way == Way::kExpand ? "expanded" : "tessellated");
        EXPECT_EQ(count_open_edges(triangles), 0u);
        surface.set_view(view);
        const FramePixels frame = way == Way::kExpand ? expanded(surface) : tessellated(surface);
        const Reference reference = software_frame(triangles, model, view);
        EXPECT_LT(contested_part(reference), 0.02);
        const std::string name = what + (way == Way::kExpand ? "-expanded" : "-tessellated");
        keep_frame(frame, name);
        keep_frame(reference.samples, name + "-software");
        const FrameDifference found = compare_frames(frame, reference, kClose);
        EXPECT_EQ(found.background, 0u);
        EXPECT_EQ(found.backs, 0u);
        EXPECT_LE(found.worst, kClose);
        worst_[static_cast<size_t>(way)] = std::max(worst_[static_cast<size_t>(way)], found.worst);
    }

    std::array<uint32_t, 2> worst_{};
};

TEST_F(Cracks, TwoLevelsAreTight) { expect_tight(2); }
TEST_F(Cracks, FourLevelsAreTight) { expect_tight(4); }

// The test above would notice them: without the rule for borders there are gaps.
TEST_F(Cracks, BordersThatForgetTheirNeighboursLeak) {
    Random random(7);
    uint32_t leaky[2] = {0, 0};
    for (const char* name : {"limbs-square", "limbs-tiles", "tori-2-tiles"}) {
        Model model(name);
        GlSurface surface = surface_of(model);
        for (int i = 0; i < kCameras; ++i) {
            std::vector<gim_patch> patches = model.banded_patches(0, 4, random);
            const ShaderView view = lit_view(random_camera(model.centre, model.radius, random));
            const Reference reference =
                software_frame(placed(expand_patches(patches, model.surface), model.surface), model, view);
            for (gim_patch& p : patches) p.finer = 0;
            surface.set_patches(one_instance(patches));
            surface.set_view(view);
            const FramePixels frames[2] = {expanded(surface), tessellated(surface)};
            for (int way = 0; way < 2; ++way) {
                const FrameDifference found = compare_frames(frames[way], reference, kClose);
                leaky[way] += found.background + found.backs > 0 ? 1 : 0;
                keep_frame(frames[way], std::string(name) + "-leaky-" + std::to_string(2 * i + way));
            }
        }
    }
    std::cout << leaky[0] << " and " << leaky[1] << " of " << 3 * kCameras << " views leak\n";
    EXPECT_GT(leaky[0], 2u * kCameras);
    EXPECT_GT(leaky[1], 2u * kCameras);
}

}  // namespace
}  // namespace gim
