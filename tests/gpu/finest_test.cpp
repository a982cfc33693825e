// The finest mesh on the GPU is what gim_decode_mesh gives.
#include "tests/gpu/gpu_scene.h"

namespace gim {
namespace {

using namespace gim::test;

constexpr int kCameras = 5;  // of each model

class Finest : public GpuTest {
  protected:
    void SetUp() override {
        GpuTest::SetUp();
        if (context_) std::cout << context_->renderer() << "\n";
    }

    FramePixels drawn(bool is_expanded, GlSurface& surface, const ShaderView& view) {
        surface.set_view(view);
        return is_expanded ? expanded(surface) : tessellated(surface);
    }

    // Compares frames from random sides with those of the same triangles drawn by the processor.
    FrameDifference compare(bool is_expanded, const Model& model, GlSurface& surface,
                            const std::vector<SoftTriangle>& triangles, int cameras, const std::string& name) {
        Random random(11);
        FrameDifference most;
        for (int i = 0; i < cameras; ++i) {
            const ShaderView view = lit_view(random_camera(model.centre, model.radius, random));
            const Reference reference = software_frame(triangles, model, view);
            EXPECT_GT(covered_part(reference.samples), 0.01);
            EXPECT_LT(contested_part(reference), 0.01);
            const FramePixels frame = drawn(is_expanded, surface, view);
            keep_frame(frame, name + "-" + std::to_string(i));
            keep_frame(reference.samples, name + "-" + std::to_string(i) + "-software");
            const FrameDifference found = compare_frames(frame, reference, kClose);
            most.worst = std::max(most.worst, found.worst);
            most.far = std::max(most.far, found.far);
            most.shifted = std::max(most.shifted, found.shifted);
            most.background = std::max(most.background, found.background);
            most.backs = std::max(most.backs, found.backs);
        }
        std::cout << name << ": largest difference " << most.worst << " in " << most.far << " pixels; " << most.shifted
                  << " pixels are shifted\n";
        return most;
    }
};

TEST_F(Finest, ExpandedFramesAreThoseOfTheDecodedMesh) {
    for (const char* name : kModels) {
        Model model(name);
        GlSurface surface = surface_of(model);
        surface.set_patches(one_instance(model.finest_patches()));
        const FrameDifference most =
            compare(true, model, surface, model.decoded_mesh(), kCameras, std::string("expanded-") + name);
        EXPECT_LE(most.worst, kClose) << name;
        EXPECT_EQ(most.background + most.backs, 0u) << name;
    }
}

// Triangles by the places of their corners, each beginning with the lowest one.
std::multiset<std::array<std::array<float, 3>, 3>> places_of(const std::vector<SoftTriangle>& triangles) {
    std::multiset<std::array<std::array<float, 3>, 3>> out;
    for (const SoftTriangle& t : triangles) {
        auto corners = t.positions;
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
        out.insert(corners);
    }
    return out;
}

TEST_F(Finest, ExpandedTrianglesAreThoseOfTheDecodedMesh) {
    for (const char* name : kModels) {
        Model model(name);
        GlSurface surface = surface_of(model);
        surface.set_patches(one_instance(model.finest_patches()));
        expand_->expand(surface);
        std::vector<SampleTriangle> triangles;
        for (const auto& t : expand_->read_triangles())
            triangles.push_back({Sample{t[0] & 0xffff, t[0] >> 16}, Sample{t[1] & 0xffff, t[1] >> 16},
                                 Sample{t[2] & 0xffff, t[2] >> 16}});
        const auto drawn = places_of(placed(triangles, model.surface)), decoded = places_of(model.decoded_mesh());
        EXPECT_EQ(drawn.size(), decoded.size());
        size_t others = 0;
        for (const auto& t : drawn) others += decoded.count(t) == 0 ? 1 : 0;
        std::cout << name << ": " << others << " of " << drawn.size() << " triangles are others\n";
        // Where both diagonals are as long, a GPU may round to the other one.
        EXPECT_LE(others, drawn.size() / 1000) << name;
    }
}

// The tessellator splits cells along diagonals of its own. The mesh is as fine, so what that moves is below a pixel, except
// where the eye is so near that one sees single cells.
TEST_F(Finest, TessellatedFramesAreThoseOfTheDecodedMesh) {
    for (const char* name : kModels) {
        Model model(name);
        GlSurface surface = surface_of(model);
        surface.set_patches(one_instance(model.finest_patches()));
        const std::string title = std::string("tessellated-") + name;
        const FrameDifference most = compare(false, model, surface, model.decoded_mesh(), 3, title);
        EXPECT_LE(most.far, kFrameSide * kFrameSide / 500) << name;
        const std::vector<SoftTriangle> own = captured_triangles(surface, model.surface);
        EXPECT_EQ(own.size(), model.refinable.shape.most_triangles);
        EXPECT_EQ(count_open_edges(own), 0u) << name;
        const FrameDifference of_own = compare(false, model, surface, own, 2, title + "-own");
        EXPECT_LE(of_own.worst, kClose) << name;
        EXPECT_EQ(of_own.background + of_own.backs, 0u) << name;
    }
}

}  // namespace
}  // namespace gim
