// The finest mesh on the GPU is what gim_decode_mesh gives.
#include "tests/gpu/gpu_scene.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr int kCameras = 12;  // of each model

class Finest : public GpuTest {};

TEST_F(Finest, FramesAreThoseOfTheDecodedMesh) {
    Random random(11);
    std::cout << context_->renderer() << "\n";
    for (const char* name : kRefinables) {
        SCOPED_TRACE(name);
        Model model(name);
        const std::vector<SoftTriangle> decoded = model.decoded_mesh();
        GlSurface surface = surface_of(model);
        surface.set_patches(one_instance(model.finest_patches()));
        FrameDifference worst;
        for (int i = 0; i < kCameras; ++i) {
            SCOPED_TRACE(i);
            const ShaderView view = lit_view(random_camera(model.centre, model.radius, random));
            surface.set_view(view);
            const FramePixels reference = software_frame(decoded, model, view);
            ASSERT_GT(count_covered(reference), 500u);
            const FramePixels frames[2] = {expanded(surface), tessellated(surface)};
            if (i == 0) {
                keep_frame(reference, std::string(name) + "-finest-software");
                keep_frame(frames[0], std::string(name) + "-finest-expanded");
                keep_frame(frames[1], std::string(name) + "-finest-tessellated");
            }
            for (int way = 0; way < 2; ++way) {
                const FrameDifference found = compare_frames(frames[way], reference, kClose);
                EXPECT_LE(found.worst, kClose) << (way == 0 ? "expanded" : "tessellated");
                worst.worst = std::max(worst.worst, found.worst);
                worst.differing = std::max(worst.differing, found.differing);
            }
        }
        std::cout << name << ": largest difference " << worst.worst << ", most pixels that differ "
                  << worst.differing << "\n";
    }
}

}  // namespace
}  // namespace gim
