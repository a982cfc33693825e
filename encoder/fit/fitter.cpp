#include "encoder/fit/fitter.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/surface/surface_samples.h"
#include "encoder/surface/topology_summary.h"

namespace gim {

// The image's surface as it is now.
struct ImageSurface {
    Mesh mesh;
    std::vector<uint32_t> slot;  // per face
    std::vector<Vec3> normals;   // per face; zero where there is no area
    std::vector<double> areas;

    ImageSurface(const std::vector<Vec3>& positions, const GridGluing& gluing)
        : ImageSurface(positions, triangulate_grid(positions, gluing)) {}

    double area() const {
        double sum = 0;
        for (const double a : areas) sum += a;
        return sum;
    }

  private:
    ImageSurface(const std::vector<Vec3>& positions, GridFaces faces)
        : mesh{positions, std::move(faces.triangles)},
          slot(std::move(faces.slot)),
          normals(mesh.triangles.size()),
          areas(normals.size()) {
        parallel_blocks(normals.size(), 16384, 0, [&](size_t, size_t begin, size_t end) {
            for (size_t f = begin; f < end; ++f) {
                const Triangle& t = mesh.triangles[f];
                const Vec3& a = positions[t[0]];
                const Vec3 cross = (positions[t[1]] - a).cross(positions[t[2]] - a);
                const double length = cross.norm();
                areas[f] = 0.5 * length;
                normals[f] = length > 0 ? Vec3(cross / length) : Vec3(Vec3::Zero());
            }
        });
    }
};

// One sampled distance: the displacements of three corners should add up, by weight, to `residual`, mostly along
// `normal`.
struct Pull {
    uint32_t face = kNone;  // of the image; kNone: no pull
    std::array<double, 3> weights{};
    Vec3 residual = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double strength = 0;
};

namespace {

constexpr double kTangentWeight = 0.003;  // tau
constexpr double kDamping = 0.001;        // mu
constexpr double kSteepest = 0.1;         // cosine below which the guard wakes up
constexpr double kUnsuspicious = 0.7;     // cosine above which the guard believes a face without looking twice
constexpr int kMostHalvings = 8;
constexpr double kUnfolded = 0.2;      // cosine that unfolding is content with
constexpr int kUnfoldPasses = 4;       // in each round that unfolds
constexpr double kUnfoldReach = 0.25;  // in mean sample spacings, in each of these rounds
constexpr int kMostFreezings = 16;     // further rounds of the guard, in which steps are not halved but given up

std::vector<Vec3> face_normals(const Mesh& mesh) {
    std::vector<Vec3> normals(mesh.triangles.size());
    parallel_blocks(normals.size(), 16384, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const Triangle& t = mesh.triangles[f];
            const Vec3& a = mesh.positions[t[0]];
            normals[f] = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized();
        }
    });
    return normals;
}

// The boundary edges of a mesh, as triangles of no area.
Mesh boundary_curve(const Mesh& mesh) {
    Mesh curve{mesh.positions, {}};
    const Topology topology = build_topology(mesh);
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (topology.twin[h] == kNone) curve.triangles.push_back({from(mesh, h), to(mesh, h), to(mesh, h)});
    }
    return curve;
}

bool touches(const Triangle& t, const std::vector<bool>& marked) {
    return marked[t[0]] || marked[t[1]] || marked[t[2]];
}

bool is_inside(const std::array<double, 3>& barycentric) {
    return barycentric[0] > 0 && barycentric[1] > 0 && barycentric[2] > 0;
}

Vec3 direction_or(const Vec3& v, const Vec3& otherwise) {
    const double length = v.norm();
    return length > 1e-14 ? Vec3(v / length) : otherwise;
}

SymmetricBlock symmetric(const Eigen::Matrix3d& m) {
    return {static_cast<float>(m(0, 0)), static_cast<float>(m(0, 1)), static_cast<float>(m(0, 2)),
            static_cast<float>(m(1, 1)), static_cast<float>(m(1, 2)), static_cast<float>(m(2, 2))};
}

// Runs body(row) for all rows of cells; bodies two rows apart may run at once, so that a body may write to both rows of
// samples that its cells touch, and everything is added in one order.
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
    // Counting sort by row of cells; inside a row the order of the samples.
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

FitFrame::FitFrame(const Mesh& mesh) {
    Vec3 low = mesh.positions[mesh.triangles[0][0]], high = low;
    for (const Triangle& t : mesh.triangles) {
        for (const uint32_t v : t) {
            low = low.cwiseMin(mesh.positions[v]);
            high = high.cwiseMax(mesh.positions[v]);
        }
    }
    middle = 0.5 * (low + high);
    if ((high - low).norm() > 0) scale = 1 / (high - low).norm();
}

FitReference::FitReference(Mesh input)
    : mesh(std::move(input)), normals(face_normals(mesh)), tree(mesh), curve(boundary_curve(mesh)), curve_tree(curve) {}

FitSystem::FitSystem(uint32_t width, uint32_t height)
    : matrix(width, height), right(size_t{width} * height, Vec3::Zero()) {}

void FitSystem::add(const Triangle& corners, const Pull& pull) {
    const Vec3& n = pull.normal;
    const double along = pull.strength * (1 - kTangentWeight), across = pull.strength * kTangentWeight;
    const Eigen::Matrix3d weight = along * n * n.transpose() + across * Eigen::Matrix3d::Identity();
    const Vec3 force = weight * pull.residual;
    const SymmetricBlock block = symmetric(weight);
    for (size_t i = 0; i < 3; ++i) {
        right[corners[i]] += pull.weights[i] * force;
        for (size_t j = i; j < 3; ++j) {
            matrix.add(corners[i], corners[j], block, static_cast<float>(pull.weights[i] * pull.weights[j]));
        }
    }
}

void FitSystem::add_spring(uint32_t i, uint32_t j, const Eigen::Matrix3d& weight, const Vec3& difference) {
    const SymmetricBlock block = symmetric(weight);
    matrix.add(i, i, block, 1);
    matrix.add(j, j, block, 1);
    matrix.add(i, j, block, -1);
    const Vec3 force = weight * difference;
    right[i] -= force;
    right[j] += force;
}

void FitSystem::add_anchor(uint32_t i, const Eigen::Matrix3d& weight, const Vec3& residual) {
    matrix.add(i, i, symmetric(weight), 1);
    right[i] += weight * residual;
}

FitQuality measure(const std::vector<Vec3>& positions, const GridGluing& gluing, const FitReference& reference,
                   const std::vector<bool>& held, double front) {
    constexpr uint64_t kSeed = 0x6d6561737572655fu;
    const ImageSurface image(positions, gluing);
    const auto density = static_cast<uint32_t>(std::max<size_t>(20000, 2 * image.mesh.triangles.size()));
    FitQuality quality;

    const ClosestPointTree tree(image.mesh);
    const SurfaceSamples outer = sample_by_area(reference.mesh, density, kSeed);
    const std::vector<ClosestPoint> to_image = tree.find_all(outer.points);
    quality.to_image =
        std::sqrt(parallel_sum(to_image.size(), 0, [&](size_t k) { return to_image[k].squared_distance; }) /
                  std::max<double>(1, static_cast<double>(to_image.size())));

    const SurfaceSamples inner = sample_by_area(image.mesh, density, kSeed);
    const std::vector<ClosestPoint> to_reference = reference.tree.find_all(inner.points);
    const auto counts = [&](size_t k) { return !touches(image.mesh.triangles[inner.triangles[k]], held); };
    const double used = parallel_sum(inner.points.size(), 0, [&](size_t k) { return counts(k) ? 1.0 : 0.0; });
    quality.to_reference =
        std::sqrt(parallel_sum(inner.points.size(), 0,
                               [&](size_t k) { return counts(k) ? to_reference[k].squared_distance : 0.0; }) /
                  std::max(1.0, used));

    std::vector<Vec3> centres(image.mesh.triangles.size());
    for (size_t f = 0; f < centres.size(); ++f) {
        const Triangle& t = image.mesh.triangles[f];
        centres[f] = (positions[t[0]] + positions[t[1]] + positions[t[2]]) / 3;
    }
    const std::vector<ClosestPoint> at_centre = reference.tree.find_all(centres);
    quality.folds = static_cast<uint64_t>(parallel_sum(centres.size(), 0, [&](size_t f) {
        if (touches(image.mesh.triangles[f], held)) return 0.0;
        return front * image.normals[f].dot(reference.normals[at_centre[f].triangle]) < 0 ? 1.0 : 0.0;
    }));
    return quality;
}

double front_side(const std::vector<Vec3>& positions, const GridGluing& gluing, const FitReference& reference) {
    const ImageSurface image(positions, gluing);
    const SurfaceSamples samples = sample_by_area(image.mesh, 4000, 1);
    const std::vector<ClosestPoint> found = reference.tree.find_all(samples.points);
    double sum = 0;
    for (size_t k = 0; k < found.size(); ++k) {
        sum += image.normals[samples.triangles[k]].dot(reference.normals[found[k].triangle]);
    }
    return sum < 0 ? -1 : 1;
}

Fitter::Fitter(const std::vector<Vec3>& start, const FitReference& reference, const GridGluing& gluing,
               const FitFrame& frame, const FitOptions& options)
    : gluing_(gluing),
      reference_(reference),
      x_(frame.into(start)),
      held_(options.held),
      samples_(static_cast<double>(gluing.defined_count())),
      face_hint_(2 * gluing.kind.size(), kNone) {
    if (held_.empty()) held_.assign(x_.size(), false);
    // A class is held, and at one place, as a whole.
    for (const auto& members : gluing_.shared) {
        bool any = false;
        Vec3 mean = Vec3::Zero();
        for (const uint32_t v : members) {
            any = any || held_[v];
            mean += x_[v] / static_cast<double>(members.size());
        }
        for (const uint32_t v : members) {
            held_[v] = any;
            x_[v] = mean;
        }
    }
    fixed_ = held_;
    has_curve_ = !reference_.curve.triangles.empty();
    for (uint32_t v = 0; v < x_.size(); ++v) {
        if (!gluing_.on_input_boundary[v]) continue;
        if (!has_curve_) fixed_[v] = true;
        on_boundary_.push_back(v);
    }
    front_ = front_side(x_, gluing_, reference_);
}

void Fitter::unfold() {
    const std::vector<Vec3> origin = x_;
    for (int pass = 0; pass < kUnfoldPasses; ++pass) {
        const ImageSurface image(x_, gluing_);
        const std::vector<uint32_t> steep = steep_cells(image);
        if (steep.empty()) break;
        relax(samples_around(steep), origin, kUnfoldReach * std::sqrt(image.area() / samples_));
    }
}

FitQuality Fitter::quality() const { return measure(x_, gluing_, reference_, held_, front_); }

FitSystem Fitter::linearise(double lambda, double density, uint64_t seed) {
    const ImageSurface image(x_, gluing_);
    find_vertex_frames(image);
    FitSystem system(gluing_.width, gluing_.height);
    add_pulls(system, image, pulls_from_reference(image, density, seed));
    add_pulls(system, image, pulls_from_image(image, density, seed + 1));
    add_membrane(system, lambda);
    add_boundary(system);
    return system;
}

void Fitter::round(double lambda, double density, uint64_t seed, bool guarded) {
    const FitSystem system = linearise(lambda, density, seed);
    take_step(solve(system.matrix, system.right, gluing_, fixed_, {}).values, guarded);
}

std::vector<uint32_t> Fitter::steep_cells(const ImageSurface& image) {
    std::vector<uint8_t> is_steep(image.normals.size());
    parallel_blocks(is_steep.size(), 2048, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const Triangle& t = image.mesh.triangles[f];
            if (touches(t, held_)) continue;
            uint32_t& hint = face_hint_[image.slot[f]];
            const auto cosine = [&] { return front_ * image.normals[f].dot(reference_.normals[hint]); };
            if (hint != kNone && cosine() > kUnsuspicious) continue;
            hint = reference_.tree.find((x_[t[0]] + x_[t[1]] + x_[t[2]]) / 3, hint).triangle;
            if (cosine() < kUnfolded) is_steep[f] = 1;
        }
    });
    std::vector<uint32_t> steep;
    for (size_t f = 0; f < is_steep.size(); ++f) {
        const uint32_t cell = image.slot[f] / 2;
        if (is_steep[f] && (steep.empty() || steep.back() != cell)) steep.push_back(cell);
    }
    return steep;
}

std::vector<uint32_t> Fitter::samples_around(const std::vector<uint32_t>& cells) const {
    const uint32_t width = gluing_.width;
    std::vector<bool> inside(x_.size(), false);
    for (const uint32_t cell : cells) {
        const uint32_t row = cell / (width - 1), column = cell % (width - 1);
        for (uint32_t r = row > 0 ? row - 1 : 0; r <= std::min(row + 2, gluing_.height - 1); ++r) {
            for (uint32_t c = column > 0 ? column - 1 : 0; c <= std::min(column + 2, width - 1); ++c) {
                if (gluing_.is_defined(r * width + c)) inside[gluing_.representative[r * width + c]] = true;
            }
        }
    }
    std::vector<uint32_t> samples;
    for (uint32_t v = 0; v < inside.size(); ++v) {
        if (inside[v] && !fixed_[v] && !gluing_.on_input_boundary[v]) samples.push_back(v);
    }
    return samples;
}

std::span<const uint32_t> Fitter::class_around(const uint32_t& v) const {
    if (gluing_.class_of[v] == kNone) return {&v, 1};
    return gluing_.shared[gluing_.class_of[v]];
}

void Fitter::relax(const std::vector<uint32_t>& samples, const std::vector<Vec3>& origin, double reach) {
    std::vector<Vec3> target(samples.size());
    parallel_blocks(samples.size(), 512, 0, [&](size_t, size_t begin, size_t end) {
        uint32_t hint = kNone;
        for (size_t k = begin; k < end; ++k) {
            const uint32_t v = samples[k];
            Vec3 sum = Vec3::Zero();
            double count = 0;
            const auto add = [&](uint32_t w) {
                sum += x_[w] - x_[v];
                count += 1;
            };
            for (const uint32_t u : class_around(v)) {
                if (gluing_.edges[u] & GridGluing::kNorth) add(u - gluing_.width);
                if (gluing_.edges[u] & GridGluing::kSouth) add(u + gluing_.width);
                if (gluing_.edges[u] & GridGluing::kWest) add(u - 1);
                if (gluing_.edges[u] & GridGluing::kEast) add(u + 1);
            }
            hint = reference_.tree.find(x_[v], hint).triangle;
            const Vec3& normal = reference_.normals[hint];
            Vec3 travel = x_[v] + 0.5 / count * (sum - sum.dot(normal) * normal) - origin[v];
            if (travel.norm() > reach) travel *= reach / travel.norm();
            target[k] = reference_.tree.find(origin[v] + travel, hint).point;
        }
    });
    for (size_t k = 0; k < samples.size(); ++k) {
        for (const uint32_t u : class_around(samples[k])) x_[u] = target[k];
    }
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

std::vector<Pull> Fitter::pulls_from_reference(const ImageSurface& image, double density, uint64_t seed) const {
    const auto count = static_cast<uint32_t>(density * static_cast<double>(image.areas.size()));
    const SurfaceSamples samples = sample_by_area(reference_.mesh, count, seed);
    const ClosestPointTree tree(image.mesh);
    const std::vector<ClosestPoint> found = tree.find_all(samples.points);
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
    nearest_reference_face_.assign(face_hint_.size(), kNone);
    std::vector<Pull> pulls(per_face * image.areas.size());
    parallel_blocks(image.areas.size(), 2048, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const Triangle& t = image.mesh.triangles[f];
            if (touches(t, held_)) continue;
            uint32_t hint = face_hint_[image.slot[f]];
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
                pull.strength = image.areas[f] / mean_area_ / static_cast<double>(per_face);
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
    constexpr double kGrip = 10;
    for (const uint32_t v : on_boundary_) {
        const ClosestPoint at = reference_.curve_tree.find(x_[v]);
        const Triangle& edge = reference_.curve.triangles[at.triangle];
        const Vec3 along =
            direction_or(reference_.curve.positions[edge[1]] - reference_.curve.positions[edge[0]], Vec3::Zero());
        system.add_anchor(v, kGrip * (Eigen::Matrix3d::Identity() - along * along.transpose()), at.point - x_[v]);
    }
}

Vec3 Fitter::moved(uint32_t v, const Vec3& step) const {
    if (!gluing_.on_input_boundary[v] || fixed_[v]) return x_[v] + step;
    return reference_.curve_tree.find(x_[v] + step).point;
}

void Fitter::take_step(const std::vector<Vec3>& step, bool guarded) {
    std::vector<double> factor(x_.size(), 1.0);
    for (size_t v = 0; v < x_.size(); ++v) {
        const double limit = 0.5 * std::sqrt(vertex_area_[v]), length = step[v].norm();
        if (length > limit) factor[v] = limit / length;
    }
    std::vector<Vec3> target(x_.size());
    std::vector<uint32_t> moving(x_.size()), cells;
    std::iota(moving.begin(), moving.end(), 0u);
    for (uint32_t cell = 0; cell < gluing_.kind.size(); ++cell) {
        if (gluing_.kind[cell] != CellKind::kEmpty) cells.push_back(cell);
    }
    for (int halving = 0; halving < kMostHalvings + kMostFreezings; ++halving) {
        parallel_blocks(moving.size(), 4096, 0, [&](size_t, size_t begin, size_t end) {
            for (size_t k = begin; k < end; ++k) {
                const uint32_t v = moving[k];
                target[v] = factor[v] == 0 ? x_[v] : moved(v, factor[v] * step[v]);
            }
        });
        if (!guarded) break;
        const std::vector<uint32_t> bad = cells_that_turn_away(target, cells);
        if (bad.empty()) break;
        moving.clear();
        std::vector<bool> shortened(x_.size(), false);
        for (const uint32_t cell : bad) {
            for (const uint32_t corner : gluing_.corners(cell)) {
                const auto shorten = [&](uint32_t v) {
                    if (shortened[v]) return;
                    shortened[v] = true;
                    factor[v] = halving < kMostHalvings ? 0.5 * factor[v] : 0;
                    moving.push_back(v);
                };
                if (gluing_.class_of[corner] == kNone) {
                    shorten(corner);
                } else {
                    for (const uint32_t v : gluing_.shared[gluing_.class_of[corner]]) shorten(v);
                }
            }
        }
        cells = cells_around(moving);
    }
    x_ = std::move(target);
    for (size_t f = 0; f < face_hint_.size(); ++f) face_hint_[f] = nearest_reference_face_[f];
}

std::vector<uint32_t> Fitter::cells_around(const std::vector<uint32_t>& samples) const {
    const uint32_t width = gluing_.width, last_row = gluing_.height - 2, last_column = width - 2;
    std::vector<uint32_t> cells;
    for (const uint32_t v : samples) {
        const uint32_t row = v / width, column = v % width;
        for (uint32_t r = row > 0 ? row - 1 : 0; r <= std::min(row, last_row); ++r) {
            for (uint32_t c = column > 0 ? column - 1 : 0; c <= std::min(column, last_column); ++c)
                cells.push_back(r * (width - 1) + c);
        }
    }
    std::sort(cells.begin(), cells.end());
    cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
    return cells;
}

std::vector<uint32_t> Fitter::cells_that_turn_away(const std::vector<Vec3>& target,
                                                   const std::vector<uint32_t>& cells) const {
    std::vector<uint8_t> bad(cells.size());
    parallel_blocks(cells.size(), 2048, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t k = begin; k < end; ++k) {
            const uint32_t cell = cells[k];
            const std::array<Triangle, 2> now = split_cell(x_, gluing_, cell);
            const auto is_held = [&](const Triangle& t) { return t != kNoFace && touches(t, held_); };
            if (is_held(now[0]) || is_held(now[1])) continue;
            const double then = facing(target, split_cell(target, gluing_, cell), cell);
            bad[k] = then < kSteepest && then < facing(x_, now, cell) ? 1 : 0;
        }
    });
    std::vector<uint32_t> result;
    for (size_t k = 0; k < cells.size(); ++k) {
        if (bad[k]) result.push_back(cells[k]);
    }
    return result;
}

double Fitter::facing(const std::vector<Vec3>& positions, const std::array<Triangle, 2>& faces, uint32_t cell) const {
    double least = 1;
    for (size_t half = 0; half < 2; ++half) {
        const Triangle& t = faces[half];
        if (t == kNoFace) continue;
        const Vec3 &a = positions[t[0]], &b = positions[t[1]], &c = positions[t[2]];
        const Vec3 normal = front_ * direction_or((b - a).cross(c - a), Vec3::Zero());
        const uint32_t known = nearest_reference_face_[2 * size_t{cell} + half];
        double cosine = known == kNone ? -1 : normal.dot(reference_.normals[known]);
        if (cosine < kUnsuspicious) {
            cosine = normal.dot(reference_.normals[reference_.tree.find((a + b + c) / 3, known).triangle]);
        }
        least = std::min(least, cosine);
    }
    return least;
}

}  // namespace gim
