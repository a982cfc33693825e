#include "tools/scene/scene_surface.h"

#include <algorithm>
#include <cmath>

#include "tools/decoded.h"

namespace gim {

gim_status SceneSurface::open() {
    gim_status status = gim_read_info(file_.data(), file_.size(), nullptr, &info_);
    if (status != GIM_OK) return status;
    gim_level_info level;
    status = gim_read_level_info(&info_, file_.data(), file_.size(), 0, 0, &level);
    if (status != GIM_OK) return status;
    positions_.resize(3 * size_t{level.vertex_count});
    AlignedMemory of_level(level.scratch_size);
    status = gim_decode_mesh(&info_, file_.data(), file_.size(), 0, 0, positions_.data(), nullptr, nullptr, nullptr,
                             of_level.get(), of_level.size());
    if (status != GIM_OK) return status;
    status = gim_read_domain_info(&info_, file_.data(), file_.size(), 0, 0, &shape_);
    if (status != GIM_OK) return status;
    memory_ = AlignedMemory(shape_.domain_size);
    AlignedMemory scratch(shape_.scratch_size);
    return gim_open_domain(&info_, file_.data(), file_.size(), 0, 0, positions_.data(), memory_.get(), memory_.size(),
                           scratch.get(), scratch.size(), &domain_);
}

namespace {

// The vertices of every 2^level-th sample, and how far the others are.
struct Kept {
    std::vector<uint8_t> fineness;  // per vertex: the coarsest level that has it
    uint32_t level = 0;

    static float need(void* user, uint32_t vertex, const float*, float, float) {
        const auto& kept = *static_cast<const Kept*>(user);
        return kept.fineness[vertex] >= kept.level ? 2.0f : 0.0f;
    }
};

// The coarsest level that has a sample at this row or column of a tile.
uint8_t level_of(uint32_t at, uint32_t intervals) {
    uint8_t level = 0;
    while ((1u << (level + 1)) <= intervals && at % (1u << (level + 1)) == 0) ++level;
    return level;
}

}  // namespace

gim_status SceneSurface::make_levels() {
    const auto most = static_cast<uint32_t>(std::min<uint64_t>(shape_.most_triangles, UINT32_MAX / 4));
    AlignedMemory memory(gim_refined_size(domain_, most));
    gim_refined* mesh = nullptr;
    gim_status status = gim_begin_refined(domain_, most, memory.get(), memory.size(), &mesh);
    if (status != GIM_OK) return status;
    Kept kept;
    kept.fineness.assign(shape_.vertex_count, 0);
    gim_rule rule{};
    rule.need = Kept::need;
    rule.user = &kept;
    // The finest mesh tells where each vertex lies.
    status = gim_refine(mesh, &rule, 0, nullptr);
    if (status != GIM_OK) return status;
    uint32_t count = 0;
    (void)gim_refined_triangles(mesh, &count);
    for (uint32_t h = 0; h < 3 * count; ++h) {
        gim_half_edge edge;
        (void)gim_read_half_edge(mesh, h, &edge);
        kept.fineness[edge.vertex] =
            std::min(level_of(edge.start[0], shape_.intervals), level_of(edge.start[1], shape_.intervals));
    }
    for (; kept.level < kDiscreteLevels && (shape_.intervals >> kept.level) > 0; ++kept.level) {
        status = gim_refine(mesh, &rule, 0, nullptr);
        if (status != GIM_OK) return status;
        DiscreteLevel level;
        (void)gim_refined_triangles(mesh, &level.triangles);
        level.patches.resize(2 * size_t{level.triangles});
        uint32_t patches = 0;
        status = gim_read_patches(mesh, level.patches.data(), 2 * level.triangles, &patches);
        if (status != GIM_OK) return status;
        level.patches.resize(patches);
        for (uint32_t v = 0; v < shape_.vertex_count; ++v) {
            float error = 0, radius = 0;
            gim_vertex_worth(domain_, v, &error, &radius);
            if (kept.fineness[v] < kept.level) level.error = std::max(level.error, double{error});
        }
        levels_.push_back(std::move(level));
    }
    return GIM_OK;
}

Result<SceneSurface> SceneSurface::read(const std::string& path) {
    Result<Bytes> file = read_file(path);
    if (!file.ok()) return file.error();
    SceneSurface s;
    s.file_ = std::move(file.value());
    gim_status status = s.open();
    if (status == GIM_OK) status = s.make_levels();
    if (status == GIM_BAD_ARGUMENT)
        return Error{Stage::kInput, "charts cannot be refined; encode with --layout tiles or gim"};
    if (status != GIM_OK) return Error{Stage::kInput, describe_status(status)};
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
