#include "tests/gpu/views.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <set>

namespace gim::test {
namespace {

std::array<double, 3> random_direction(Random& random) {
    for (;;) {
        const std::array<double, 3> v = {between(random, -1, 1), between(random, -1, 1), between(random, -1, 1)};
        const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        if (length > 0.1 && length < 1) return {v[0] / length, v[1] / length, v[2] / length};
    }
}

// As Refinable wants it: relative to the folder of vectors.
std::string path_of(const std::string& file) {
    const bool is_model = std::find(std::begin(kModels), std::end(kModels), file) != std::end(kModels);
    return (is_model ? "../../../tests/gpu/models/" : "") + file;
}

struct WantedDepth {
    const Model& model;
    const Model::Wanted& wanted;
};

float need_of(void* user, uint32_t vertex, const float* position, float, float) {
    const auto* want = static_cast<const WantedDepth*>(user);
    return want->model.level_of[vertex] <= 2 * want->wanted(position) ? 2.0f : 0.0f;
}

}  // namespace

Model::Model(const std::string& file, uint32_t level) : name(file), refinable(path_of(file), 0, level), level_(level) {
    auto read = read_surface_data(refinable.info, refinable.file, 0, level);
    EXPECT_TRUE(read.ok());
    surface = std::move(read.value());
    std::array<double, 3> low{}, high{};
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (size_t i = 0; i < refinable.positions.size(); ++i) {
        low[i % 3] = std::min<double>(low[i % 3], refinable.positions[i]);
        high[i % 3] = std::max<double>(high[i % 3], refinable.positions[i]);
    }
    for (size_t a = 0; a < 3; ++a) {
        centre[a] = (low[a] + high[a]) / 2;
        radius = std::hypot(radius, (high[a] - low[a]) / 2);
    }
    level_of.assign(refinable.shape.vertex_count, 0);
    (void)finest_patches();
    for (uint32_t h = 0; h < 3 * refinable.count(); ++h) {
        const gim_half_edge edge = refinable.half_edge(h);
        level_of[edge.vertex] = edge.level;
    }
}

uint32_t Model::depth() const {
    uint32_t depth = 0;
    while (refinable.shape.intervals >> depth > 1) ++depth;
    return depth;
}

std::vector<gim_patch> Model::patches_of_depth(const Wanted& wanted) {
    WantedDepth want{*this, wanted};
    gim_rule rule{};
    rule.need = need_of;
    rule.user = &want;
    EXPECT_EQ(gim_refine(refinable.mesh, &rule, 0, nullptr), GIM_OK);
    std::vector<gim_patch> patches(2 * size_t{refinable.count()});
    uint32_t count = 0;
    EXPECT_EQ(gim_read_patches(refinable.mesh, patches.data(), static_cast<uint32_t>(patches.size()), &count), GIM_OK);
    patches.resize(count);
    return patches;
}

std::vector<gim_patch> Model::banded_patches(uint32_t first_depth, uint32_t bands, Random& random) {
    const auto place_along = [](const std::array<double, 3>& direction, const float* position) {
        return direction[0] * position[0] + direction[1] * position[1] + direction[2] * position[2];
    };
    // A direction and a width of bands may leave no room for the coarsest cells; others do, unless tiles are few.
    std::vector<gim_patch> best;
    for (int tries = 0; tries < 30; ++tries) {
        const std::array<double, 3> across = random_direction(random);
        const double power = between(random, 1, 4);
        double low = std::numeric_limits<double>::infinity(), high = -low;
        for (size_t i = 0; i < refinable.positions.size(); i += 3) {
            low = std::min(low, place_along(across, &refinable.positions[i]));
            high = std::max(high, place_along(across, &refinable.positions[i]));
        }
        std::vector<gim_patch> patches = patches_of_depth([&](const float* position) {
            const double part = std::clamp((place_along(across, position) - low) / (high - low), 0.0, 1.0);
            return first_depth + static_cast<uint32_t>(std::min(std::pow(part, power) * bands, bands - 1.0));
        });
        if (count_cell_sizes(patches) > count_cell_sizes(best)) best = std::move(patches);
        if (count_cell_sizes(best) == bands) break;
    }
    return best;
}

std::vector<gim_patch> Model::finest_patches() {
    return patches_of_depth([this](const float*) { return depth(); });
}

std::vector<SoftTriangle> Model::decoded_mesh() const {
    const Refinable& r = refinable;
    gim_level_info shape;
    EXPECT_EQ(gim_read_level_info(&r.info, r.file.data(), r.file.size(), 0, level_, &shape), GIM_OK);
    const size_t samples = size_t{shape.width} * shape.height;
    std::vector<uint32_t> triangles(size_t{3} * shape.triangle_count), grid_triangles(triangles.size());
    std::vector<float> positions(size_t{3} * shape.vertex_count), grid(3 * samples), texcoords(2 * samples);
    Block scratch(shape.scratch_size);
    EXPECT_EQ(gim_decode_mesh(&r.info, r.file.data(), r.file.size(), 0, level_, positions.data(), nullptr, nullptr,
                              triangles.data(), scratch.get(), scratch.size()),
              GIM_OK);
    EXPECT_EQ(gim_decode_grid(&r.info, r.file.data(), r.file.size(), 0, level_, grid.data(), nullptr, texcoords.data(),
                              grid_triangles.data(), scratch.get(), scratch.size()),
              GIM_OK);
    std::vector<SoftTriangle> out(shape.triangle_count);
    for (size_t i = 0; i < triangles.size(); ++i) {
        const size_t sample = grid_triangles[i];
        SoftTriangle& t = out[i / 3];
        std::copy_n(&positions[3 * size_t{triangles[i]}], 3, t.positions[i % 3].begin());
        EXPECT_TRUE(std::equal(t.positions[i % 3].begin(), t.positions[i % 3].end(), &grid[3 * sample]));
        t.texels[i % 3] = {texcoords[2 * sample] * (surface.map_width - 1.0),
                           texcoords[2 * sample + 1] * (surface.map_height - 1.0)};
    }
    return out;
}

uint32_t count_cell_sizes(const std::vector<gim_patch>& patches) {
    std::set<int> sizes;
    for (const gim_patch& p : patches) sizes.insert(p.side - p.inside);
    return static_cast<uint32_t>(sizes.size());
}

Camera random_camera(const std::array<double, 3>& centre, double radius, Random& random) {
    Camera camera;
    const double distance = radius * between(random, 1.15, 3);
    const std::array<double, 3> side = random_direction(random), aside = random_direction(random);
    for (size_t a = 0; a < 3; ++a) {
        camera.eye[a] = centre[a] + distance * side[a];
        camera.target[a] = centre[a] + 0.3 * radius * aside[a];
    }
    camera.up = random_direction(random);
    camera.field_of_view = between(random, 0.5, 1.3);
    camera.nearest = 0.9 * (distance - radius);
    camera.farthest = distance + 1.1 * radius;
    return camera;
}

ShaderView lit_view(const Camera& camera) {
    ShaderView view = view_of(camera);
    double length = 0;
    std::array<double, 3> light{};
    for (size_t a = 0; a < 3; ++a) {
        light[a] = camera.eye[a] - camera.target[a];
        length = std::hypot(length, light[a]);
    }
    for (size_t a = 0; a < 3; ++a) light[a] = light[a] / length + 0.6 * (a == 0 ? 1 : -0.5);
    const double sum = std::hypot(light[0], light[1], light[2]);
    for (size_t a = 0; a < 3; ++a) view.light[a] = static_cast<float>(light[a] / sum);
    return view;
}

}  // namespace gim::test
