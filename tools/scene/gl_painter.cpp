// Draws scenes by the compute shader and one indirect draw, or by the tessellator.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "tools/details.h"
#include "tools/gpu/camera.h"
#include "tools/gpu/egl_context.h"
#include "tools/gpu/gl_expand.h"
#include "tools/gpu/gl_frame.h"
#include "tools/gpu/gl_surface.h"
#include "tools/gpu/gl_tessellate.h"
#include "tools/gpu/surface_data.h"
#include "tools/scene/scene_painter.h"
#include "tools/scene/scene_run.h"

namespace gim {
namespace {

constexpr uint32_t kFirstCapacity = 1u << 20;                      // triangles
constexpr std::array<float, 4> kInside = {0.35f, 0.3f, 0.25f, 1};  // of open surfaces
constexpr std::array<float, 4> kSky = {0.16f, 0.18f, 0.22f, 1};

class GlPainter final : public ScenePainter {
  public:
    static Result<std::unique_ptr<ScenePainter>> create(const Scene& scene, const std::vector<SceneSurface>& surfaces) {
        Result<EglContext> context = EglContext::create();
        if (!context.ok()) return context.error();
        std::vector<SurfaceData> data;
        for (const SceneSurface& surface : surfaces) {
            if (surface.has_details()) {
                data.push_back(surface_data_of(surface.domain(), surface.shape(),
                                               surface.info().layout == GIM_LAYOUT_TILES, surface.positions(),
                                               vertex_normals(surface.positions(), surface.finest_indices())));
                continue;
            }
            Result<SurfaceData> read = read_surface_data(surface.info(), surface.file(), 0, 0);
            if (!read.ok()) return read.error();
            data.push_back(std::move(read.value()));
        }
        Result<GlExpand> expand = GlExpand::create(kFirstCapacity);
        if (!expand.ok()) return expand.error();
        Result<GlTessellate> tessellate = GlTessellate::create();
        if (!tessellate.ok()) return tessellate.error();
        Result<GlFrame> frame = GlFrame::create(scene.width, scene.height);
        if (!frame.ok()) return frame.error();
        return std::unique_ptr<ScenePainter>(new GlPainter(scene, std::move(context.value()), join_surfaces(data),
                                                           std::move(expand.value()), std::move(tessellate.value()),
                                                           std::move(frame.value()), surfaces));
    }

    std::string renderer() const override { return context_.renderer(); }

    void upload(const SceneLod& lod, LodWay way, const CameraKey& camera, const FramePatches& patches) override {
        is_expanded_ = patches.levels.empty();
        if (!is_expanded_) take_levels(patches);
        InstancedPatches list;
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const std::span<const gim_patch> of_instance(patches.patches.data() + patches.first[i],
                                                         patches.first[i + 1] - patches.first[i]);
            add_patches(of_instance, i, kTessellatorEdges, 0, &list);
        }
        surface_.set_patches(list);
        surface_.set_instances(instances(lod, way, camera));
        ShaderView view = view_of(camera_of(camera), scene_.pixel_error);
        view.back = kInside;
        surface_.set_view(view);
        glFinish();
    }

    Result<uint64_t> draw() override {
        const bool by_tessellator = is_expanded_ && scene_.tessellates;
        if (is_expanded_ && !by_tessellator) expand();
        frame_.begin(kSky);
        by_tessellator ? tessellate_.draw(surface_) : expand_.draw(surface_);
        glFinish();
        const Result<void> checked = check_gl("drawing a frame");
        if (!checked.ok()) return checked.error();
        return uint64_t{by_tessellator ? 0 : expand_.needed()};
    }

    std::vector<uint8_t> picture() const override {
        const FramePixels pixels = frame_.read();
        std::vector<uint8_t> rgb;
        rgb.reserve(pixels.rgba.size() / 4 * 3);
        for (size_t i = 0; i < pixels.rgba.size(); i += 4)
            rgb.insert(rgb.end(), pixels.rgba.begin() + static_cast<std::ptrdiff_t>(i),
                       pixels.rgba.begin() + static_cast<std::ptrdiff_t>(i) + 3);
        return rgb;
    }

  private:
    GlPainter(const Scene& scene, EglContext context, const SurfaceStore& store, GlExpand expand,
              GlTessellate tessellate, GlFrame frame, const std::vector<SceneSurface>& surfaces)
        : scene_(scene),
          surfaces_(surfaces),
          context_(std::move(context)),
          surface_(store),
          expand_(std::move(expand)),
          tessellate_(std::move(tessellate)),
          frame_(std::move(frame)) {}

    // Twice, if the triangles have no room at first.
    void expand() {
        expand_.expand(surface_);
        const uint32_t needed = expand_.needed();
        if (needed <= expand_.capacity()) return;
        expand_.set_capacity(needed + needed / 4);
        expand_.expand(surface_);
    }
    // Puts the triangles of the chosen levels where expanded ones would be.
    void take_levels(const FramePatches& patches) {
        std::vector<std::array<uint32_t, 4>> triangles;
        triangles.reserve(patches.triangles);
        for (uint32_t i = 0; i < scene_.instances.size(); ++i) {
            const auto& level = surfaces_[scene_.instances[i].mesh].levels()[patches.levels[i]];
            for (const auto& t : level.triangles) triangles.push_back({t[0], t[1], t[2], i});
        }
        expand_.set_triangles(triangles);
    }
    std::vector<ShaderInstance> instances(const SceneLod& lod, LodWay way, const CameraKey& camera) const {
        std::vector<ShaderInstance> list;
        for (size_t i = 0; i < scene_.instances.size(); ++i) {
            const Placement& p = lod.placement(i);
            ShaderInstance instance;
            instance.domain = scene_.instances[i].mesh;
            instance.transform = p.matrix();
            const double radius = p.scale * surfaces_[instance.domain].radius();
            for (size_t k = 0; k < 3; ++k) instance.ball[k] = static_cast<float>(p.position[k]);
            instance.ball[3] = static_cast<float>(radius);
            if (scene_.gpu_refines && way == LodWay::kAdaptive) {
                const double distance = std::hypot(camera.eye[0] - p.position[0], camera.eye[1] - p.position[1],
                                                   camera.eye[2] - p.position[2]);
                instance.error = static_cast<float>(lod.pixel_error() * std::max(distance - radius, 1e-3 * radius) /
                                                    lod.pixels_per_unit());
            }
            list.push_back(instance);
        }
        return list;
    }
    Camera camera_of(const CameraKey& key) const {
        Camera camera;
        camera.eye = key.eye;
        camera.target = key.target;
        camera.up = {0, 0, 1};
        camera.field_of_view = scene_.field_of_view * std::numbers::pi / 180;
        camera.width = scene_.width;
        camera.height = scene_.height;
        double farthest = 0, size = 1e300;
        for (const SceneInstance& i : scene_.instances) {
            farthest = std::max(farthest, i.size + std::hypot(i.position[0] - key.eye[0], i.position[1] - key.eye[1],
                                                              i.position[2] - key.eye[2]));
            size = std::min(size, i.size);
        }
        camera.nearest = std::max(0.02 * size, farthest * 1e-5);
        camera.farthest = std::max(farthest, 2 * camera.nearest);
        return camera;
    }

    const Scene& scene_;
    const std::vector<SceneSurface>& surfaces_;
    EglContext context_;  // goes last
    GlSurface surface_;
    GlExpand expand_;
    GlTessellate tessellate_;
    GlFrame frame_;
    bool is_expanded_ = true;  // patches; else triangles as they are
};

}  // namespace

bool can_draw_scenes() { return true; }

Result<std::unique_ptr<ScenePainter>> make_painter(const Scene& scene, const std::vector<SceneSurface>& surfaces) {
    return GlPainter::create(scene, surfaces);
}

}  // namespace gim
