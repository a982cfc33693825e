// Views of several levels have no gaps: no background and no back face shows through.
#include "tests/gpu/gpu_scene.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr int kCameras = 20;  // of each model

class Cracks : public GpuTest {
  protected:
    void expect_tight(uint32_t levels) {
        Random random(100 + levels);
        for (const char* name : kRefinables) {
            SCOPED_TRACE(name);
            Model model(name);
            if (model.depth() + 1 < levels) continue;
            GlSurface surface = surface_of(model);
            for (int i = 0; i < kCameras; ++i) {
                SCOPED_TRACE(i);
                const std::vector<gim_patch> patches =
                    model.banded_patches(model.depth() + 1 - levels, levels, random);
                if (count_cell_sizes(patches) < levels) continue;
                const ShaderView view = lit_view(random_camera(model.centre, model.radius, random));
                expect_tight(model, patches, view, surface, std::to_string(levels) + "-levels-" + std::to_string(i));
                ++frames_;
            }
        }
        EXPECT_GE(frames_, 60);
        std::cout << frames_ << " views of " << levels << " levels, largest difference " << worst_ << "\n";
    }

  private:
    void expect_tight(const Model& model, const std::vector<gim_patch>& patches, const ShaderView& view,
                      GlSurface& surface, const std::string& what) {
        const std::vector<SampleTriangle> triangles = expand_patches(patches, model.surface);
        ASSERT_EQ(count_open_edges(triangles, model.surface) == 0, is_closed(model));
        const FramePixels reference = software_frame(placed(triangles, model.surface), model, view);
        surface.set_patches(one_instance(patches));
        surface.set_view(view);
        const FramePixels frames[2] = {expanded(surface), tessellated(surface)};
        keep_frame(reference, model.name + "-" + what + "-software");
        for (int way = 0; way < 2; ++way) {
            const char* name = way == 0 ? "expanded" : "tessellated";
            keep_frame(frames[way], model.name + "-" + what + "-" + name);
            const Leaks leaks = find_leaks(frames[way], reference);
            EXPECT_EQ(leaks.background, 0u) << name;
            EXPECT_EQ(leaks.backs, 0u) << name;
        }
        const FrameDifference found = compare_frames(frames[0], reference, kClose);
        EXPECT_LE(found.worst, kClose);
        worst_ = std::max(worst_, found.worst);
    }

    int frames_ = 0;
    uint32_t worst_ = 0;
};

TEST_F(Cracks, TwoLevelsAreTight) { expect_tight(2); }
TEST_F(Cracks, FourLevelsAreTight) { expect_tight(4); }

// The test above would notice them: without the rule for borders there are gaps.
TEST_F(Cracks, BordersThatForgetTheirNeighboursLeak) {
    Random random(7);
    uint32_t leaky[2] = {0, 0};
    for (const char* name : {"tiles-torus-lossy", "torus-33-lossy", "tiles-cube-lossy"}) {
        Model model(name);
        GlSurface surface = surface_of(model);
        for (int i = 0; i < kCameras; ++i) {
            std::vector<gim_patch> patches = model.banded_patches(0, 4, random);
            const ShaderView view = lit_view(random_camera(model.centre, model.radius, random));
            const FramePixels reference =
                software_frame(placed(expand_patches(patches, model.surface), model.surface), model, view);
            for (gim_patch& p : patches) p.finer = 0;
            surface.set_patches(one_instance(patches));
            surface.set_view(view);
            const FramePixels frames[2] = {expanded(surface), tessellated(surface)};
            for (int way = 0; way < 2; ++way) {
                const Leaks leaks = find_leaks(frames[way], reference);
                leaky[way] += leaks.background + leaks.backs > 0 ? 1 : 0;
                keep_frame(frames[way], std::string(name) + "-leaky-" + std::to_string(2 * i + way));
            }
        }
    }
    std::cout << leaky[0] << " and " << leaky[1] << " of " << 3 * kCameras << " views leak\n";
    EXPECT_GT(leaky[0], 30u);
    EXPECT_GT(leaky[1], 30u);
}

}  // namespace
}  // namespace gim
