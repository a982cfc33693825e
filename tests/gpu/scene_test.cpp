// Several instances of several surfaces in one draw, each as fine as the screen wants it.
#include <cmath>

#include "tests/gpu/gpu_scene.h"

namespace gim {
namespace {

using namespace gim::test;

// Turns about the y axis, scales, moves.
std::array<float, 16> placed_at(double turn, double scale, const std::array<double, 3>& place) {
    const double c = scale * std::cos(turn), s = scale * std::sin(turn);
    const double columns[16] = {c, 0, -s, 0, 0, scale, 0, 0, s, 0, c, 0, place[0], place[1], place[2], 1};
    std::array<float, 16> out{};
    for (size_t i = 0; i < 16; ++i) out[i] = static_cast<float>(columns[i]);
    return out;
}

// As extra_of in gim.glsl.
uint32_t extra_of(const ShaderInstance& instance, const ShaderView& view) {
    double distance = 0;
    for (size_t a = 0; a < 3; ++a) distance = std::hypot(distance, view.eye[a] - instance.ball[a]);
    const double too_large = instance.error * view.eye[3] / (distance - instance.ball[3]);
    const double wanted = too_large > 1 ? std::ceil(std::log2(too_large) / 2) : 0;
    return instance.extra + static_cast<uint32_t>(std::min(wanted, 2.0));
}

class Scene : public GpuTest {
  protected:
    // Instances in a row that leads away from the eye.
    void add_instances(uint32_t count, Random& random) {
        for (uint32_t i = 0; i < count; ++i) {
            const uint32_t domain = i % static_cast<uint32_t>(models_.size());
            const Model& model = models_[domain];
            ShaderInstance instance;
            const double scale = 1 / model.radius;
            const uint32_t row = i / 4;
            const std::array<double, 3> place = {2.2 * (i % 4) - 3.3, 0.4 * (i % 3) - 0.4, -2.5 * row};
            instance.transform = placed_at(between(random, 0, 6), scale, place);
            for (size_t a = 0; a < 3; ++a) {
                double centre = instance.transform[12 + a];
                for (size_t c = 0; c < 3; ++c) centre += instance.transform[4 * c + a] * model.centre[c];
                instance.ball[a] = static_cast<float>(centre);
            }
            instance.ball[3] = 1;
            instance.domain = domain;
            instance.error = 0.1f;
            instances_.push_back(instance);
        }
    }

    std::vector<Model> models_;
    std::vector<ShaderInstance> instances_;
};

TEST_F(Scene, OneDrawShowsManyInstancesAsFineAsTheScreenWants) {
    Random random(31);
    for (const char* name : {"limbs-tiles", "torus-square", "tori-2-tiles", "sphere-tiles"}) models_.emplace_back(name);
    add_instances(16, random);
    std::vector<SurfaceData> surfaces;
    std::vector<std::vector<gim_patch>> coarse;
    for (Model& model : models_) {
        surfaces.push_back(model.surface);
        coarse.push_back(model.banded_patches(0, 2, random));
    }
    GlSurface surface(join_surfaces(surfaces));
    InstancedPatches patches;
    for (uint32_t i = 0; i < instances_.size(); ++i)
        add_patches(coarse[instances_[i].domain], i, kTessellatorEdges, 2, &patches);
    surface.set_instances(instances_);
    surface.set_patches(patches);

    Camera camera;
    camera.eye = {0, 3, 5};
    camera.target = {0, 0, -3};
    camera.width = camera.height = kFrameSide;
    ShaderView view = lit_view(camera);
    view.eye[3] /= 4;  // 4 pixels
    surface.set_view(view);

    SoftwareFrame reference(kFrameSide, kFrameSide, kFiner, kBackground);
    std::set<uint32_t> extras;
    for (const ShaderInstance& instance : instances_) {
        const Model& model = models_[instance.domain];
        const uint32_t extra = extra_of(instance, view);
        extras.insert(extra);
        reference.draw(placed(expand_patches(coarse[instance.domain], model.surface, extra), model.surface),
                       model.surface, instance, view);
    }
    EXPECT_GE(extras.size(), 2u) << "all instances are as fine";
    const FramePixels frames[2] = {expanded(surface), tessellated(surface)};
    keep_frame(reference.pixels(), "scene-software");
    keep_frame(frames[0], "scene-expanded");
    keep_frame(frames[1], "scene-tessellated");
    const Reference expected{reference.pixels(), reference.contested()};
    const FrameDifference found = compare_frames(frames[0], expected, kClose);
    EXPECT_EQ(found.background + found.backs, 0u);
    EXPECT_LE(found.worst, kClose);
    // The tessellator takes other diagonals, and coarse cells show it.
    EXPECT_LT(compare_frames(frames[1], expected, 32).shifted, kFrameSide * kFrameSide / 50);
}

}  // namespace
}  // namespace gim
