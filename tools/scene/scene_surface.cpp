#include "tools/scene/scene_surface.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "tools/decoded.h"

namespace gim {

gim_status SceneSurface::open() {
    gim_status status = gim_read_info(file_.data(), file_.size(), nullptr, &info_);
    if (status != GIM_OK) return status;
    gim_level_info level;
    status = gim_read_level_info(&info_, file_.data(), file_.size(), 0, 0, &level);
    if (status != GIM_OK) return status;
    positions_.resize(3 * size_t{level.vertex_count});
    Scratch of_level(level.scratch_size);
    status = gim_decode_mesh(&info_, file_.data(), file_.size(), 0, 0, positions_.data(), nullptr, nullptr, nullptr,
                             of_level.data(), of_level.size());
    if (status != GIM_OK) return status;
    gim_plane_info plane;
    status = gim_read_plane_info(&info_, file_.data(), file_.size(), 0, GIM_PLANE_DISPLACEMENTS, 0, &plane);
    if (status == GIM_OK) return open_details(plane);
    status = gim_read_domain_info(&info_, file_.data(), file_.size(), 0, 0, &shape_);
    if (status != GIM_OK) return status;
    memory_ = Scratch(shape_.domain_size);
    Scratch scratch(shape_.scratch_size);
    return gim_open_domain(&info_, file_.data(), file_.size(), 0, 0, positions_.data(), memory_.data(), memory_.size(),
                           scratch.data(), scratch.size(), &domain_);
}

gim_status SceneSurface::open_details(const gim_plane_info& plane) {
    std::vector<float> displacements(3 * size_t{plane.width} * plane.height);
    Scratch of_plane(plane.scratch_size);
    gim_status status = gim_decode_plane(&info_, file_.data(), file_.size(), 0, GIM_PLANE_DISPLACEMENTS, 0,
                                         displacements.data(), of_plane.data(), of_plane.size());
    if (status != GIM_OK) return status;
    status = gim_read_detailed_domain_info(&info_, file_.data(), file_.size(), 0, 0, &shape_);
    if (status != GIM_OK) return status;
    const std::vector<float> plain = std::move(positions_);
    positions_.assign(3 * size_t{shape_.vertex_count}, 0.0f);
    memory_ = Scratch(shape_.domain_size);
    Scratch scratch(shape_.scratch_size);
    has_details_ = true;
    return gim_open_detailed_domain(&info_, file_.data(), file_.size(), 0, 0, plain.data(), displacements.data(),
                                    positions_.data(), memory_.data(), memory_.size(), scratch.data(), scratch.size(),
                                    &domain_);
}

gim_status SceneSurface::refine_all() {
    const auto most = static_cast<uint32_t>(std::min<uint64_t>(shape_.most_triangles, UINT32_MAX / 4));
    Scratch memory(gim_refined_size(domain_, most));
    gim_refined* mesh = nullptr;
    gim_status status = gim_begin_refined(domain_, most, memory.data(), memory.size(), &mesh);
    if (status != GIM_OK) return status;
    gim_rule rule{};
    rule.need = [](void*, uint32_t, const float*, float, float) { return 2.0f; };
    status = gim_refine(mesh, &rule, 0, nullptr);
    if (status != GIM_OK) return status;
    const uint32_t* triangles = gim_refined_triangles(mesh, &finest_triangles_);
    indices_.assign(triangles, triangles + 3 * size_t{finest_triangles_});
    uint32_t count = 0;
    finest_patches_.resize(2 * size_t{finest_triangles_});
    status = gim_read_patches(mesh, finest_patches_.data(), 2 * finest_triangles_, &count);
    finest_patches_.resize(count);
    sample_of_.resize(shape_.vertex_count);
    std::vector<uint32_t> vertex_at(size_t{shape_.width} * shape_.height);
    gim_read_sample_vertices(domain_, vertex_at.data());
    for (uint32_t i = 0; i < vertex_at.size(); ++i) {
        if (vertex_at[i] != GIM_NOTHING) sample_of_[vertex_at[i]] = i / shape_.width << 16 | i % shape_.width;
    }
    return status;
}

namespace {

constexpr uint32_t kSamplesOfError = 100000;
constexpr double kShareOfLevel = 0.25;  // of the triangles of the level before

TriangleMesh mesh_of(const std::vector<float>& positions, const std::vector<uint32_t>& indices) {
    TriangleMesh mesh;
    for (size_t i = 0; i < positions.size(); i += 3)
        mesh.positions.push_back({positions[i], positions[i + 1], positions[i + 2]});
    for (size_t i = 0; i < indices.size(); i += 3)
        mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    return mesh;
}

}  // namespace

Result<void> SceneSurface::simplify() {
    const TriangleMesh finest = mesh_of(positions_, indices_);
    double share = 1;
    for (uint32_t l = 0; l < kDiscreteLevels; ++l, share *= kShareOfLevel) {
        std::vector<uint32_t> kept = indices_;
        DiscreteLevel level;
        if (l > 0) {
            const auto wanted = static_cast<size_t>(share * finest_triangles_) * 3;
            kept.resize(meshopt_simplify(kept.data(), indices_.data(), indices_.size(), positions_.data(),
                                         shape_.vertex_count, 3 * sizeof(float), wanted, 1.0f, 0, nullptr));
            CompareOptions options;
            options.samples = kSamplesOfError;
            const Result<Comparison> compared = compare(finest, mesh_of(positions_, kept), options);
            if (!compared.ok()) return compared.error();
            level.error = compared.value().hausdorff;
        }
        for (size_t i = 0; i < kept.size(); i += 3)
            level.triangles.push_back({sample_of_[kept[i]], sample_of_[kept[i + 1]], sample_of_[kept[i + 2]]});
        levels_.push_back(std::move(level));
    }
    return {};
}

Result<SceneSurface> SceneSurface::read(const std::string& path) {
    Result<Bytes> file = read_file(path);
    if (!file.ok()) return file.error();
    SceneSurface s;
    s.file_ = std::move(file.value());
    gim_status status = s.open();
    if (status == GIM_OK) status = s.refine_all();
    if (status == GIM_BAD_ARGUMENT)
        return Error{Stage::kInput, "charts cannot be refined; encode with --layout tiles or gim"};
    if (status != GIM_OK) return Error{Stage::kInput, describe_status(status)};
    if (const Result<void> simplified = s.simplify(); !simplified.ok()) return simplified.error();
    std::array<double, 3> low, high;
    low.fill(HUGE_VAL);
    high.fill(-HUGE_VAL);
    for (size_t i = 0; i < s.positions_.size(); ++i) {
        low[i % 3] = std::min(low[i % 3], double{s.positions_[i]});
        high[i % 3] = std::max(high[i % 3], double{s.positions_[i]});
    }
    for (size_t k = 0; k < 3; ++k) {
        s.middle_[k] = 0.5 * (low[k] + high[k]);
        s.longest_side_ = std::max(s.longest_side_, high[k] - low[k]);
    }
    for (size_t i = 0; i < s.positions_.size(); i += 3)
        s.radius_ = std::max(s.radius_, std::hypot(s.positions_[i] - s.middle_[0], s.positions_[i + 1] - s.middle_[1],
                                                   s.positions_[i + 2] - s.middle_[2]));
    return s;
}

}  // namespace gim
