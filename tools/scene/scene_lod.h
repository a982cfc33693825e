// What the CPU decides for a frame: how fine each instance is, as patches.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "tools/scene/scene.h"
#include "tools/scene/scene_surface.h"

namespace gim {

// From the space of a mesh to that of the scene: stood up, turned about z, scaled, moved.
struct Placement {
    double scale = 1, cosine = 1, sine = 0;
    bool is_y_up = false;
    std::array<double, 3> middle = {}, position = {};

    std::array<double, 3> to_mesh(const std::array<double, 3>& point) const;
    std::array<float, 16> matrix() const;  // column after column
};
Placement placement_of(const SceneInstance& instance, const SceneSurface& surface, bool is_y_up);

// The patches of all instances, one after the other.
struct FramePatches {
    std::vector<gim_patch> patches;
    std::vector<uint32_t> first;  // per instance, and the end
    std::vector<uint8_t> levels;  // per instance: the discrete level; then there are no patches
    uint64_t triangles = 0;       // of the meshes that the patches stand for
    double largest_error = 0;     // pixels, of the instance that errs most
    double refining = 0;          // milliseconds of the whole that refining took; the rest lists patches
};

enum class LodWay { kAdaptive, kFull, kDiscrete };

class SceneLod {
  public:
    // Keeps references. An Error names the instance that has no room for its base.
    static Result<std::unique_ptr<SceneLod>> create(const Scene& scene, const std::vector<SceneSurface>& surfaces);

    // Adaptive: refines all instances for the camera. Where they would have more triangles than the scene allows, all err a
    // little more. Discrete: each instance takes the coarsest mesh that errs less than the scene allows. Full: all samples.
    void choose(LodWay way, const CameraKey& camera, FramePatches* out);

    const Placement& placement(size_t instance) const { return placements_[instance]; }
    double pixels_per_unit() const { return pixels_per_unit_; }
    // How many pixels the CPU leaves to err.
    double pixel_error() const { return pixel_error_; }
    uint64_t bytes_of_meshes() const { return bytes_; }

  private:
    SceneLod(const Scene& scene, const std::vector<SceneSurface>& surfaces);
    Result<void> begin();
    void refine(const CameraKey& camera, FramePatches* out);
    void list(size_t instance, uint32_t triangles);
    double distance(size_t instance, const CameraKey& camera) const;  // to the ball around it, above 0

    const Scene& scene_;
    const std::vector<SceneSurface>& surfaces_;
    std::vector<Placement> placements_;
    std::vector<Scratch> memory_;
    std::vector<gim_refined*> meshes_;
    std::vector<gim_patch> room_;                 // for the patches of one instance
    std::vector<std::vector<gim_patch>> listed_;  // per instance, as long as its mesh does not change
    double pixels_per_unit_ = 1;
    double wanted_error_ = 1, pixel_error_ = 1;  // that the CPU leaves: within the budget, and now
    uint64_t bytes_ = 0;
};

}  // namespace gim
