#include "tools/scene/scene_run.h"

#include <chrono>
#include <utility>

#include "tools/scene/scene_painter.h"

namespace gim {
namespace {

// Milliseconds that f takes.
template <class F>
double time_of(const F& f) {
    const auto start = std::chrono::steady_clock::now();
    f();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

struct Runner {
    const Scene& scene;
    const SceneRun& run;
    SceneLod& lod;
    ScenePainter* painter;  // nullptr: nothing is drawn

    Result<std::vector<FrameFigures>> frames(LodWay way) {
        std::vector<FrameFigures> all;
        FramePatches patches;
        // Meshes begin with their base: the first frame comes twice, and counts once.
        lod.choose(way, scene.camera(0), &patches);
        for (uint32_t frame = 0; frame < scene.frames; ++frame) {
            FrameFigures f;
            const CameraKey camera = scene.camera(frame);
            const double chosen = time_of([&] { lod.choose(way, camera, &patches); });
            f.refine = way == LodWay::kAdaptive ? patches.refining : chosen;
            f.list = chosen - f.refine;
            f.triangles = patches.triangles;
            f.patches = patches.patches.size();
            f.pixel_error = patches.largest_error;
            if (painter) {
                f.upload = time_of([&] { painter->upload(lod, way, camera, patches); });
                Result<uint64_t> drawn = uint64_t{0};
                f.draw = time_of([&] { drawn = painter->draw(); });
                if (!drawn.ok()) return drawn.error();
                f.drawn = drawn.value();
                if (way == LodWay::kAdaptive && run.take_frame) {
                    const Result<void> taken = run.take_frame({frame, scene.width, scene.height, painter->picture()});
                    if (!taken.ok()) return taken.error();
                }
            }
            all.push_back(f);
        }
        return all;
    }
};

}  // namespace

Result<SceneFigures> run_scene(const Scene& scene, const SceneRun& run) {
    std::vector<SceneSurface> surfaces;
    SceneFigures figures;
    for (const SceneMesh& mesh : scene.meshes) {
        Result<SceneSurface> surface = SceneSurface::read(mesh.path);
        if (!surface.ok()) return Error{surface.error().stage, mesh.path + ": " + surface.error().message};
        figures.bytes_of_files += surface.value().file().size();
        surfaces.push_back(std::move(surface.value()));
    }
    Result<std::unique_ptr<SceneLod>> lod = SceneLod::create(scene, surfaces);
    if (!lod.ok()) return lod.error();
    figures.bytes_of_meshes = lod.value()->bytes_of_meshes();
    std::unique_ptr<ScenePainter> painter;
    if (run.draws) {
        Result<std::unique_ptr<ScenePainter>> made = make_painter(scene, surfaces);
        if (!made.ok()) return made.error();
        painter = std::move(made.value());
        figures.renderer = painter->renderer();
    }
    Runner runner{scene, run, *lod.value(), painter.get()};
    const std::pair<LodWay, std::vector<FrameFigures>*> ways[] = {
        {LodWay::kAdaptive, &figures.adaptive}, {LodWay::kDiscrete, &figures.discrete}, {LodWay::kFull, &figures.full}};
    for (const auto& [way, of_way] : ways) {
        if (way != LodWay::kAdaptive && !run.compares) continue;
        Result<std::vector<FrameFigures>> frames = runner.frames(way);
        if (!frames.ok()) return frames.error();
        *of_way = std::move(frames.value());
    }
    return figures;
}

}  // namespace gim
