// The terms of a round: distances sampled from both surfaces, the membrane, and the hold on the input's boundary.
#include <algorithm>
#include <cmath>

#include "encoder/base/parallel.h"
#include "encoder/fit/fitter.h"
#include "encoder/fit/image_surface.h"
#include "encoder/surface/surface_samples.h"

namespace gim {

namespace {

constexpr double kDamping = 0.001;  // mu
constexpr double kGrip = 10;        // of boundaries and rails

bool is_inside(const std::array<double, 3>& barycentric) {
    return barycentric[0] > 0 && barycentric[1] > 0 && barycentric[2] > 0;
}

// Runs body(row) for all rows of cells. Only bodies two or more rows apart run at once, so a body may write to both
// rows of samples that its cells touch, and sums are always added in the same order.
template <class Body>
void for_cell_rows(uint32_t cell_rows, const Body& body) {
    for (uint32_t parity = 0; parity < 2; ++parity) {
        parallel_blocks((cell_rows + 1 - parity) / 2, 4, 0, [&](size_t, size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) body(static_cast<uint32_t>(2 * k + parity));
        });
    }
}

void add_pulls(FitSystem& system, const ImageSurface& image, const std::vector<Pull>& pulls) {
    const uint32_t cell_rows = system.matrix.height() - 1, slots_per_row = 2 * (system.matrix.width() - 1);
    // Counting sort by row of cells. Samples keep their order inside a row.
    std::vector<uint32_t> first(cell_rows + 1, 0);
    const auto row_of = [&](const Pull& pull) { return image.slot[pull.face] / slots_per_row; };
    for (const Pull& pull : pulls) {
        if (pull.face != kNone) ++first[row_of(pull) + 1];
    }
    for (uint32_t row = 0; row < cell_rows; ++row) first[row + 1] += first[row];
    std::vector<uint32_t> order(first.back()), fill(first.begin(), first.end() - 1);
    for (uint32_t k = 0; k < pulls.size(); ++k) {
        if (pulls[k].face != kNone) order[fill[row_of(pulls[k])]++] = k;
    }
    for_cell_rows(cell_rows, [&](uint32_t row) {
        for (uint32_t k = first[row]; k < first[row + 1]; ++k) {
            const Pull& pull = pulls[order[k]];
            system.add(image.mesh.triangles[pull.face], pull);
        }
    });
}

}  // namespace

FitSystem Fitter::linearise(double lambda, double density, uint64_t seed) {
    const ImageSurface image(x_, gluing_);
    find_vertex_frames(image);
    FitSystem system(gluing_.width, gluing_.height);
    add_pulls(system, image, pulls_from_reference(image, density, seed));
    add_pulls(system, image, pulls_from_image(image, density, seed + 1));
    add_membrane(system, lambda);
    add_boundary(system);
    add_rails(system);
    return system;
}

void Fitter::find_vertex_frames(const ImageSurface& image) {
    vertex_area_.assign(x_.size(), 0);
    vertex_normal_.assign(x_.size(), Vec3::Zero());
    for (size_t f = 0; f < image.mesh.triangles.size(); ++f) {
        for (const uint32_t v : image.mesh.triangles[f]) {
            vertex_area_[v] += image.areas[f] / 3;
            vertex_normal_[v] += image.areas[f] * image.normals[f];
        }
    }
    for (const auto& members : gluing_.shared) {
        double area = 0;
        Vec3 normal = Vec3::Zero();
        for (const uint32_t v : members) {
            area += vertex_area_[v];
            normal += vertex_normal_[v];
        }
        for (const uint32_t v : members) {
            vertex_area_[v] = area;
            vertex_normal_[v] = normal;
        }
    }
    mean_area_ = image.area() / samples_;
    for (Vec3& normal : vertex_normal_) normal = direction_or(normal, Vec3::Zero());
}

std::vector<Pull> Fitter::pulls_from_reference(const ImageSurface& image, double density, uint64_t seed) {
    const auto count = static_cast<uint32_t>(density * static_cast<double>(image.areas.size()));
    const SurfaceSamples samples = sample_by_area(reference_.mesh, count, seed);
    image_tree_.refit(image.mesh);
    const std::vector<ClosestPoint> found = image_tree_.find_all(samples.points);
    std::vector<Pull> pulls(samples.points.size());
    parallel_blocks(pulls.size(), 4096, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const ClosestPoint& at = found[k];
            Pull& pull = pulls[k];
            pull.face = at.triangle;
            pull.weights = at.barycentric;
            pull.residual = samples.points[k] - at.point;
            pull.normal = is_inside(at.barycentric) ? image.normals[at.triangle]
                                                    : direction_or(pull.residual, image.normals[at.triangle]);
            pull.strength = samples.area / mean_area_ / static_cast<double>(pulls.size());
        }
    });
    return pulls;
}

std::vector<Pull> Fitter::pulls_from_image(const ImageSurface& image, double density, uint64_t seed) {
    const auto per_face = static_cast<size_t>(std::max(1.0, std::round(0.5 * density)));
    const bool skips_half = density < 1 && is_large();  // of the faces: one of the two of each cell
    nearest_reference_face_.assign(face_hint_.size(), kNone);
    std::vector<Pull> pulls(per_face * image.areas.size());
    parallel_blocks(image.areas.size(), 2048, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const Triangle& t = image.mesh.triangles[f];
            if (touches(t, held_)) continue;
            uint32_t hint = face_hint_[image.slot[f]];
            if (skips_half && ((mix_bits(seed ^ (image.slot[f] / 2)) ^ image.slot[f]) & 1)) {
                nearest_reference_face_[image.slot[f]] = hint;
                continue;
            }
            for (size_t k = 0; k < per_face; ++k) {
                Pull& pull = pulls[per_face * f + k];
                const uint64_t bits = mix_bits(mix_bits(seed) + per_face * f + k);
                double v = static_cast<double>(bits >> 32) * 0x1p-32,
                       w = static_cast<double>(bits & 0xffffffffu) * 0x1p-32;
                if (v + w > 1) {
                    v = 1 - v;
                    w = 1 - w;
                }
                const Vec3 point = (1 - v - w) * x_[t[0]] + v * x_[t[1]] + w * x_[t[2]];
                const ClosestPoint at = reference_.tree.find(point, hint);
                hint = at.triangle;
                if (k == 0) nearest_reference_face_[image.slot[f]] = at.triangle;
                pull.face = static_cast<uint32_t>(f);
                pull.weights = {1 - v - w, v, w};
                pull.residual = at.point - point;
                const Vec3& normal = reference_.normals[at.triangle];
                pull.normal = is_inside(at.barycentric) ? normal : direction_or(pull.residual, normal);
                pull.strength = (skips_half ? 2 : 1) * image.areas[f] / mean_area_ / static_cast<double>(per_face);
            }
        }
    });
    return pulls;
}

void Fitter::add_membrane(FitSystem& system, double lambda) const {
    const uint32_t width = gluing_.width;
    for_cell_rows(gluing_.height, [&](uint32_t row) {
        for (uint32_t i = row * width; i < (row + 1) * width; ++i) {
            system.add_anchor(i, kDamping * vertex_area_[i] / mean_area_ * Eigen::Matrix3d::Identity(), Vec3::Zero());
            if (gluing_.edges[i] & GridGluing::kEast) add_membrane_edge(system, lambda, i, i + 1);
            if (gluing_.edges[i] & GridGluing::kSouth) add_membrane_edge(system, lambda, i, i + width);
        }
    });
}

void Fitter::add_membrane_edge(FitSystem& system, double lambda, uint32_t i, uint32_t j) const {
    const Vec3 n = direction_or(vertex_normal_[i] + vertex_normal_[j], Vec3::Zero());
    system.add_spring(i, j, 0.25 * lambda * (Eigen::Matrix3d::Identity() - n * n.transpose()), x_[i] - x_[j]);
}

void Fitter::add_boundary(FitSystem& system) const {
    if (!has_curve_) return;
    for (const uint32_t v : on_boundary_) {
        const ClosestPoint at = reference_.curve_tree.find(x_[v]);
        const Triangle& edge = reference_.curve.triangles[at.triangle];
        const Vec3 along =
            direction_or(reference_.curve.positions[edge[1]] - reference_.curve.positions[edge[0]], Vec3::Zero());
        system.add_anchor(v, kGrip * (Eigen::Matrix3d::Identity() - along * along.transpose()), at.point - x_[v]);
    }
}

void Fitter::add_rails(FitSystem& system) const {
    for (uint32_t v = 0; v < x_.size(); ++v) {
        if (!rails_.holds(v)) continue;
        const Vec3 along = rails_.direction(v, x_[v]);
        system.add_anchor(v, kGrip * (Eigen::Matrix3d::Identity() - along * along.transpose()),
                          rails_.nearest(v, x_[v]) - x_[v]);
    }
}

}  // namespace gim
