#include "tools/scene/scene_lod.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

namespace gim {
namespace {

constexpr double kLeftToGpu = 4;  // times the error: one halving of cells makes up for it
constexpr double kOverBudget = 1.1, kUnderBudget = 0.95, kRoom = 0.85;

double radians(double degrees) { return degrees * std::numbers::pi / 180; }

}  // namespace

std::array<double, 3> Placement::to_mesh(const std::array<double, 3>& point) const {
    const double a = (point[0] - position[0]) / scale, b = (point[1] - position[1]) / scale;
    const double x = cosine * a + sine * b, y = -sine * a + cosine * b, z = (point[2] - position[2]) / scale;
    if (is_y_up) return {middle[0] + x, middle[1] + z, middle[2] - y};
    return {middle[0] + x, middle[1] + y, middle[2] + z};
}

std::array<float, 16> Placement::matrix() const {
    const double a = scale * cosine, b = scale * sine;
    // Where the axes of the mesh go, column after column.
    const double standing[3][3] = {{a, b, 0}, {0, 0, scale}, {b, -a, 0}},
                 lying[3][3] = {{a, b, 0}, {-b, a, 0}, {0, 0, scale}};
    const auto& axes = is_y_up ? standing : lying;
    std::array<float, 16> m = {};
    for (size_t row = 0; row < 3; ++row) {
        double origin = position[row];
        for (size_t column = 0; column < 3; ++column) {
            m[4 * column + row] = static_cast<float>(axes[column][row]);
            origin -= axes[column][row] * middle[column];
        }
        m[12 + row] = static_cast<float>(origin);
    }
    m[15] = 1;
    return m;
}

Placement placement_of(const SceneInstance& instance, const SceneSurface& surface, bool is_y_up) {
    Placement p;
    p.is_y_up = is_y_up;
    p.scale = instance.size / std::max(surface.longest_side(), 1e-300);
    p.cosine = std::cos(radians(instance.turn));
    p.sine = std::sin(radians(instance.turn));
    p.middle = surface.middle();
    p.position = instance.position;
    return p;
}

SceneLod::SceneLod(const Scene& scene, const std::vector<SceneSurface>& surfaces)
    : scene_(scene),
      surfaces_(surfaces),
      pixels_per_unit_(scene.height / (2 * std::tan(radians(scene.field_of_view) / 2))),
      wanted_error_(scene.pixel_error * (scene.gpu_refines ? kLeftToGpu : 1)),
      pixel_error_(wanted_error_) {
    for (const SceneInstance& instance : scene.instances)
        placements_.push_back(placement_of(instance, surfaces[instance.mesh], scene.meshes[instance.mesh].is_y_up));
}

Result<std::unique_ptr<SceneLod>> SceneLod::create(const Scene& scene, const std::vector<SceneSurface>& surfaces) {
    std::unique_ptr<SceneLod> lod(new SceneLod(scene, surfaces));
    const Result<void> begun = lod->begin();
    if (!begun.ok()) return begun.error();
    return lod;
}

Result<void> SceneLod::begin() {
    for (size_t i = 0; i < scene_.instances.size(); ++i) {
        const SceneSurface& surface = surfaces_[scene_.instances[i].mesh];
        const auto room =
            static_cast<uint32_t>(std::min<uint64_t>(scene_.instance_triangles, surface.shape().most_triangles));
        const uint64_t size = gim_refined_size(surface.domain(), room);
        gim_refined* mesh = nullptr;
        if (size > 0) {
            memory_.emplace_back(size);
            bytes_ += size;
        }
        if (size == 0 ||
            gim_begin_refined(surface.domain(), room, memory_.back().data(), memory_.back().size(), &mesh) != GIM_OK)
            return Error{Stage::kInput, "scene: instance " + std::to_string(i) +
                                            " has more triangles in its base than instance_triangles allows"};
        meshes_.push_back(mesh);
    }
    listed_.resize(meshes_.size());
    return {};
}

double SceneLod::distance(size_t instance, const CameraKey& camera) const {
    const Placement& p = placements_[instance];
    const double radius = p.scale * surfaces_[scene_.instances[instance].mesh].radius();
    const double to_middle =
        std::hypot(camera.eye[0] - p.position[0], camera.eye[1] - p.position[1], camera.eye[2] - p.position[2]);
    return std::max(to_middle - radius, 1e-6 * radius);
}

void SceneLod::list(size_t instance, uint32_t triangles) {
    if (room_.size() < 2 * size_t{triangles}) room_.resize(2 * size_t{triangles});
    uint32_t patches = 0;
    (void)gim_read_patches(meshes_[instance], room_.data(), static_cast<uint32_t>(room_.size()), &patches);
    listed_[instance].assign(room_.begin(), room_.begin() + patches);
}

void SceneLod::refine(const CameraKey& camera, FramePatches* out) {
    const auto start = std::chrono::steady_clock::now();
    for (size_t i = 0; i < meshes_.size(); ++i) {
        const std::array<double, 3> eye = placements_[i].to_mesh(camera.eye);
        gim_rule rule{};
        rule.pixel_error = static_cast<float>(pixel_error_);
        // Errors and distances grow alike with the scale, so pixels stay pixels.
        rule.pixels_per_unit = static_cast<float>(pixels_per_unit_);
        for (size_t k = 0; k < 3; ++k) rule.eye[k] = static_cast<float>(eye[k]);
        (void)gim_refine(meshes_[i], &rule, 0, nullptr);
    }
    out->refining = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    for (size_t i = 0; i < meshes_.size(); ++i) {
        gim_changes changes;
        gim_take_changes(meshes_[i], &changes);
        if (changes.changed_count > 0 || changes.triangles_before != changes.triangle_count)
            list(i, changes.triangle_count);
        out->triangles += changes.triangle_count;
        out->patches.insert(out->patches.end(), listed_[i].begin(), listed_[i].end());
        out->first[i + 1] = static_cast<uint32_t>(out->patches.size());
    }
    out->largest_error = pixel_error_;
    // The budget of the next frame: all instances err alike.
    const double share = double(out->triangles) / scene_.most_triangles;
    if (share > 1)
        pixel_error_ *= std::max(kOverBudget, share);
    else if (share < kRoom)
        pixel_error_ = std::max(wanted_error_, pixel_error_ * kUnderBudget);
}

void SceneLod::choose(LodWay way, const CameraKey& camera, FramePatches* out) {
    out->patches.clear();
    out->first.assign(meshes_.size() + 1, 0);
    out->triangles = 0;
    out->largest_error = 0;
    out->levels.clear();
    if (way == LodWay::kAdaptive) return refine(camera, out);
    for (size_t i = 0; i < meshes_.size(); ++i) {
        const SceneSurface& surface = surfaces_[scene_.instances[i].mesh];
        if (way == LodWay::kFull) {
            out->patches.insert(out->patches.end(), surface.finest_patches().begin(), surface.finest_patches().end());
            out->triangles += surface.finest_triangles();
            out->first[i + 1] = static_cast<uint32_t>(out->patches.size());
            continue;
        }
        const double pixels = pixels_per_unit_ * placements_[i].scale / distance(i, camera);
        size_t level = 0;
        while (level + 1 < surface.levels().size() && surface.levels()[level + 1].error * pixels <= scene_.pixel_error)
            ++level;
        out->largest_error = std::max(out->largest_error, surface.levels()[level].error * pixels);
        out->levels.push_back(static_cast<uint8_t>(level));
        out->triangles += surface.levels()[level].triangles.size();
    }
}

}  // namespace gim
