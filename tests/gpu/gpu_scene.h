// Both ways of drawing on one context.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <optional>
#include <vector>

#include "tests/gpu/captured_triangles.h"
#include "tests/gpu/compare_frames.h"
#include "tests/gpu/views.h"
#include "tools/gpu/egl_context.h"
#include "tools/gpu/gl_expand.h"
#include "tools/gpu/gl_frame.h"
#include "tools/gpu/gl_tessellate.h"

namespace gim::test {

inline constexpr uint32_t kFrameSide = 256;
inline constexpr std::array<float, 4> kClear = {1, 0, 1, 1};  // kBackground

// Of 255. A GPU filters normals of 8 bits with weights of 8 bits and writes colours of 8 bits; 4 has been seen.
inline constexpr uint32_t kClose = 6;

// A test with a context; skips where there is none.
class GpuTest : public ::testing::Test {
  protected:
    void SetUp() override {
        auto made = EglContext::create();
        if (!made.ok()) GTEST_SKIP() << made.error().message;
        context_.emplace(std::move(made.value()));
        auto frame = GlFrame::create(kFrameSide, kFrameSide);
        ASSERT_TRUE(frame.ok()) << frame.error().message;
        frame_.emplace(std::move(frame.value()));
        auto expand = GlExpand::create(1u << 18);
        ASSERT_TRUE(expand.ok()) << expand.error().message;
        expand_.emplace(std::move(expand.value()));
        auto tessellate = GlTessellate::create();
        ASSERT_TRUE(tessellate.ok()) << tessellate.error().message;
        tessellate_.emplace(std::move(tessellate.value()));
    }
    void TearDown() override { EXPECT_TRUE(!context_ || check_gl("the test").ok()); }

    FramePixels expanded(GlSurface& surface) {
        frame_->begin(kClear);
        expand_->expand(surface);
        EXPECT_LE(expand_->needed(), expand_->capacity());
        expand_->draw(surface);
        return frame_->read();
    }
    FramePixels tessellated(GlSurface& surface) {
        frame_->begin(kClear);
        tessellate_->draw(surface);
        return frame_->read();
    }

    std::optional<EglContext> context_;
    std::optional<GlFrame> frame_;
    std::optional<GlExpand> expand_;
    std::optional<GlTessellate> tessellate_;
};

// One instance of a model on the GPU.
inline GlSurface surface_of(const Model& model) {
    GlSurface surface(join_surfaces(std::vector<SurfaceData>{model.surface}));
    const ShaderInstance instance;
    surface.set_instances(std::span<const ShaderInstance>(&instance, 1));
    return surface;
}

inline InstancedPatches one_instance(const std::vector<gim_patch>& patches) {
    InstancedPatches list;
    add_patches(patches, 0, kTessellatorEdges, 0, &list);
    return list;
}

inline Reference software_frame(const std::vector<SoftTriangle>& triangles, const Model& model,
                                const ShaderView& view) {
    SoftwareFrame frame(kFrameSide, kFrameSide, kFiner, kBackground);
    frame.draw(triangles, model.surface, ShaderInstance{}, view);
    return {frame.pixels(), frame.contested()};
}

}  // namespace gim::test
