// Fitting a geometry image to its surface (fit.h).
//
// A round: split the cells; sample both surfaces by area and find the closest points; minimise over the displacements
// dx
//
//     sum_o w |p - S(x + dx)|^2_W + sum_m w |S(x + dx) - q|^2_W + lambda sum_edges a/4 |T (x_i - x_j)|^2 + mu sum_v a_v
//     |dx|^2
//
// with S(x) the sampled point of the image, p and q points of the reference, W = n n^T + tau (1 - n n^T); n is the face
// normal where the closest point is inside a face, else the direction to it; T projects on the tangent plane and x_i,
// x_j run over grid edges; then step as far as the guard allows: no face may turn further away from the reference's
// normal once it is steep. lambda falls from round to round, and the number of samples rises. Where the start has folds,
// the first rounds begin with unfolding: the samples around them are relaxed along the surface.
//
// Everything runs in a frame where the reference's bounding box has diagonal 1.
#include "encoder/fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>

#include "encoder/closest_point.h"
#include "encoder/creases.h"
#include "encoder/grid_surface.h"
#include "encoder/parallel.h"
#include "encoder/refine.h"
#include "encoder/result.h"
#include "encoder/stencil_solver.h"
#include "encoder/surface_samples.h"
#include "encoder/topology_summary.h"

namespace gim {

namespace {

constexpr double kTangentWeight = 0.003;  // tau
constexpr double kDamping = 0.001;        // mu
constexpr double kSteepest = 0.1;         // cosine below which the guard wakes up
constexpr double kUnsuspicious = 0.7;     // cosine above which the guard believes a face without looking twice
constexpr int kMostHalvings = 8;
constexpr double kUnfolded = 0.2;      // cosine that unfolding is content with
constexpr int kUnfoldPasses = 4;       // in each round that unfolds
constexpr uint32_t kUnfoldRounds = 4;  // the first ones of a schedule
constexpr double kUnfoldReach = 0.25;  // in mean sample spacings, in each of these rounds
constexpr int kLastUnfoldings = 3;     // of a fit that has more folds than its start, before it is given up
constexpr double kCreased = 0.06;      // part of a surface at creases above which unfolding may do harm
constexpr double kUnfoldPrice = 1.06;  // in RMS distance that unfolding may cost: half a decibel
constexpr int kMostFreezings = 16;     // further rounds of the guard, in which steps are not halved but given up

struct Schedule {
    double first_lambda, last_lambda;
    uint32_t rounds;
    double first_density, last_density;  // samples of the reference per face of the image
};

// The stiff lambda is where files of 65 and 70 dB are smallest (bunny-closed, horse, gargoyle, rocker-arm: 0.03 to 0.05;
// 0.08 costs about 1 % more, 0.3 costs 4 to 11 % more).
Schedule schedule_of(const FitOptions& options) {
    Schedule schedule = options.strength == FitOptions::Strength::kStiff ? Schedule{0.05, 0.05, 7, 1.5, 2}
                                                                         : Schedule{0.02, 0.0003, 16, 1, 3.5};
    if (options.thorough && options.strength == FitOptions::Strength::kLoose) schedule = {0.02, 0.0001, 32, 1, 3.5};
    if (options.rounds > 0) schedule.rounds = options.rounds;
    return schedule;
}

// ---- the two surfaces
// ------------------------------------------------------------------------------------------------

struct Frame {
    Vec3 middle = Vec3::Zero();
    double scale = 1;  // of the input's unit

    explicit Frame(const Mesh& mesh) {
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
    std::vector<Vec3> into(const std::vector<Vec3>& points) const {
        std::vector<Vec3> result(points.size());
        for (size_t k = 0; k < points.size(); ++k) result[k] = (points[k] - middle) * scale;
        return result;
    }
    Vec3 out_of(const Vec3& point) const { return point / scale + middle; }
};

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

// What stays the same from round to round.
struct Reference {
    Mesh mesh;
    std::vector<Vec3> normals;
    ClosestPointTree tree;
    Mesh curve;
    ClosestPointTree curve_tree;

    explicit Reference(Mesh input)
        : mesh(std::move(input)),
          normals(face_normals(mesh)),
          tree(mesh),
          curve(boundary_curve(mesh)),
          curve_tree(curve) {}
};

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

bool touches(const Triangle& t, const std::vector<bool>& marked) {
    return marked[t[0]] || marked[t[1]] || marked[t[2]];
}

// ---- measuring
// -------------------------------------------------------------------------------------------------------

// Distances by fresh samples, folds at the centres of the faces; `front` is the sign that makes the image face
// outwards.
FitQuality measure(const std::vector<Vec3>& positions, const GridGluing& gluing, const Reference& reference,
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

// +1 if most of the image's area looks the way the reference does, else -1.
double front_side(const std::vector<Vec3>& positions, const GridGluing& gluing, const Reference& reference) {
    const ImageSurface image(positions, gluing);
    const SurfaceSamples samples = sample_by_area(image.mesh, 4000, 1);
    const std::vector<ClosestPoint> found = reference.tree.find_all(samples.points);
    double sum = 0;
    for (size_t k = 0; k < found.size(); ++k) {
        sum += image.normals[samples.triangles[k]].dot(reference.normals[found[k].triangle]);
    }
    return sum < 0 ? -1 : 1;
}

// ---- the quadratic energy
// --------------------------------------------------------------------------------------------

// One sampled distance: the displacements of three corners should add up, by weight, to `residual`, mostly along
// `normal`.
struct Pull {
    uint32_t face = kNone;  // of the image; kNone: no pull
    std::array<double, 3> weights{};
    Vec3 residual = Vec3::Zero();
    Vec3 normal = Vec3::Zero();
    double strength = 0;
};

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

struct System {
    StencilMatrix matrix;
    std::vector<Vec3> right;

    System(uint32_t width, uint32_t height) : matrix(width, height), right(size_t{width} * height, Vec3::Zero()) {}

    void add(const Triangle& corners, const Pull& pull) {
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

    // (dx_i - dx_j) should make up for `difference` = x_i - x_j.
    void add_spring(uint32_t i, uint32_t j, const Eigen::Matrix3d& weight, const Vec3& difference) {
        const SymmetricBlock block = symmetric(weight);
        matrix.add(i, i, block, 1);
        matrix.add(j, j, block, 1);
        matrix.add(i, j, block, -1);
        const Vec3 force = weight * difference;
        right[i] -= force;
        right[j] += force;
    }

    void add_anchor(uint32_t i, const Eigen::Matrix3d& weight, const Vec3& residual) {
        matrix.add(i, i, symmetric(weight), 1);
        right[i] += weight * residual;
    }
};

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

void add_pulls(System& system, const ImageSurface& image, const std::vector<Pull>& pulls) {
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

// ---- a fit in progress
// -----------------------------------------------------------------------------------------------

class Fitter {
  public:
    Fitter(const std::vector<Vec3>& start, const Reference& reference, const GridGluing& gluing, const Frame& frame,
           const FitOptions& options)
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

    const std::vector<Vec3>& positions() const { return x_; }
    const std::vector<bool>& held() const { return held_; }
    FitQuality quality() const { return measure(x_, gluing_, reference_, held_, front_); }

    // Where faces look away from the surface, slides the samples around them along it towards the middle of their
    // neighbours. Sampling leaves such faces where the map squeezes the surface: its rows are then nearer to each other
    // than the map of a triangle mesh is smooth. Samples stay near where they were, or those at a tip would slide off it.
    void unfold() {
        const std::vector<Vec3> origin = x_;
        for (int pass = 0; pass < kUnfoldPasses; ++pass) {
            const ImageSurface image(x_, gluing_);
            const std::vector<uint32_t> steep = steep_cells(image);
            if (steep.empty()) break;
            relax(samples_around(steep), origin, kUnfoldReach * std::sqrt(image.area() / samples_));
        }
    }

    void round(double lambda, double density, uint64_t seed, bool guarded) {
        const ImageSurface image(x_, gluing_);
        find_vertex_frames(image);
        System system(gluing_.width, gluing_.height);
        add_pulls(system, image, pulls_from_reference(image, density, seed));
        add_pulls(system, image, pulls_from_image(image, density, seed + 1));
        add_membrane(system, lambda);
        add_boundary(system);
        const Solution solution = solve(system.matrix, system.right, gluing_, fixed_, {});
        take_step(solution.values, guarded);
        for (size_t f = 0; f < face_hint_.size(); ++f) face_hint_[f] = nearest_reference_face_[f];
    }

  private:
    // Cells with a face that looks, at its centre, away from the reference or nearly so.
    std::vector<uint32_t> steep_cells(const ImageSurface& image) {
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

    // The corners of cells and of the cells next to them, one sample of each class, ascending; without those that may
    // not slide.
    std::vector<uint32_t> samples_around(const std::vector<uint32_t>& cells) const {
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

    // The samples that are the same surface point as v.
    std::span<const uint32_t> class_around(const uint32_t& v) const {
        if (gluing_.class_of[v] == kNone) return {&v, 1};
        return gluing_.shared[gluing_.class_of[v]];
    }

    // Moves samples half-way to the mean of their neighbours in rows and columns, along the reference, and no further
    // than `reach` from their origin.
    void relax(const std::vector<uint32_t>& samples, const std::vector<Vec3>& origin, double reach) {
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

    // Area and normal at the samples, over the whole fan of a class.
    void find_vertex_frames(const ImageSurface& image) {
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

    std::vector<Pull> pulls_from_reference(const ImageSurface& image, double density, uint64_t seed) const {
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

    // At least one sample in every face, so that each learns which way the reference looks there.
    std::vector<Pull> pulls_from_image(const ImageSurface& image, double density, uint64_t seed) {
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

    void add_membrane(System& system, double lambda) const {
        const uint32_t width = gluing_.width;
        for_cell_rows(gluing_.height, [&](uint32_t row) {
            for (uint32_t i = row * width; i < (row + 1) * width; ++i) {
                system.add_anchor(i, kDamping * vertex_area_[i] / mean_area_ * Eigen::Matrix3d::Identity(),
                                  Vec3::Zero());
                if (gluing_.edges[i] & GridGluing::kEast) add_membrane_edge(system, lambda, i, i + 1);
                if (gluing_.edges[i] & GridGluing::kSouth) add_membrane_edge(system, lambda, i, i + width);
            }
        });
    }

    void add_membrane_edge(System& system, double lambda, uint32_t i, uint32_t j) const {
        const Vec3 n = direction_or(vertex_normal_[i] + vertex_normal_[j], Vec3::Zero());
        system.add_spring(i, j, 0.25 * lambda * (Eigen::Matrix3d::Identity() - n * n.transpose()), x_[i] - x_[j]);
    }

    // Samples on the input's boundary: free along the curve, held to it across.
    void add_boundary(System& system) const {
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

    Vec3 moved(uint32_t v, const Vec3& step) const {
        if (!gluing_.on_input_boundary[v] || fixed_[v]) return x_[v] + step;
        return reference_.curve_tree.find(x_[v] + step).point;
    }

    // Goes as far as no sample moves more than half its spacing and, if guarded, no steep cell gets steeper.
    void take_step(const std::vector<Vec3>& step, bool guarded) {
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
    }

    std::vector<uint32_t> cells_around(const std::vector<uint32_t>& samples) const {
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

    // Of the given cells, in order, those that would be steep and steeper than now, split as they would then be split.
    std::vector<uint32_t> cells_that_turn_away(const std::vector<Vec3>& target,
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

    // The smaller cosine between the faces of a cell and the reference at their centres. The reference's face that was
    // near the cell at the beginning of the round tells when there is no need to look.
    double facing(const std::vector<Vec3>& positions, const std::array<Triangle, 2>& faces, uint32_t cell) const {
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

    const GridGluing& gluing_;
    const Reference& reference_;
    std::vector<Vec3> x_;
    std::vector<bool> held_, fixed_;
    std::vector<uint32_t> on_boundary_;
    bool has_curve_ = false;
    double front_ = 1;
    double samples_ = 0;  // defined ones

    // Of the round.
    std::vector<double> vertex_area_;
    std::vector<Vec3> vertex_normal_;
    double mean_area_ = 0;
    std::vector<uint32_t> nearest_reference_face_, face_hint_;
};

std::optional<Error> check_input(const std::vector<Vec3>& start, const GridGluing& gluing, const Mesh& reference,
                                 const std::vector<bool>& held) {
    const auto fail = [](const char* message) { return Error{Stage::kFit, message}; };
    if (gluing.width < 3 || gluing.height < 3 || start.size() != gluing.sample_count())
        return fail("the image is not a rectangle of samples");
    if (reference.triangles.empty()) return fail("the mesh to fit to has no triangles");
    if (!held.empty() && held.size() != start.size())
        return fail("the mask of held samples has another size than the image");
    for (const Vec3& p : start) {
        if (!p.allFinite()) return fail("the image has samples that are not finite");
    }
    return std::nullopt;
}

bool no_worse(const FitQuality& after, const FitQuality& before) {
    return after.to_image <= before.to_image && after.to_reference <= before.to_reference &&
           after.folds <= before.folds;
}

double distance(const FitQuality& quality) { return std::max(quality.to_image, quality.to_reference); }

// The part of the surface within a mean sample spacing of creases.
double crease_share(const Mesh& mesh, double samples) {
    const double area = surface_area(mesh);
    return area > 0 ? 2 * crease_length(mesh) / std::sqrt(area * samples) : 0;
}

// What the first rounds do besides.
struct Plan {
    uint32_t unfolding;  // so many rounds begin with unfolding
    uint32_t unguarded;  // so many rounds may fold faces over: samples that are stuck in a bad place get out of it, and
                         // the guarded rounds that follow unfold more than these have folded
};

void run_schedule(Fitter& fitter, const Schedule& schedule, const Plan& plan, uint64_t seed, const Progress& progress) {
    for (uint32_t k = 0; k < schedule.rounds; ++k) {
        if (progress) progress(Stage::kFit, static_cast<double>(k) / schedule.rounds);
        const double t = schedule.rounds > 1 ? static_cast<double>(k) / (schedule.rounds - 1) : 1.0;
        const double lambda = schedule.first_lambda * std::pow(schedule.last_lambda / schedule.first_lambda, t);
        const double density = schedule.first_density + t * (schedule.last_density - schedule.first_density);
        if (k < plan.unfolding) fitter.unfold();
        fitter.round(lambda, density, mix_bits(seed) + 2 * k, k >= plan.unguarded);
    }
}

Fitted fit_in_arena(const std::vector<Vec3>& start, const GridGluing& gluing, const Mesh& input,
                    const FitOptions& options, const Progress& progress) {
    const Frame frame(input);
    const Reference reference(Mesh{frame.into(input.positions), input.triangles});
    const Fitter untouched(start, reference, gluing, frame, options);
    const FitQuality before = untouched.quality();
    const Schedule schedule = schedule_of(options);

    // An image without folds is kept so from the first round on. Where unfolding costs accuracy, the folds stay.
    std::vector<Plan> plans = {{0, 0}};
    if (before.folds > 0) plans = {{std::min(kUnfoldRounds, schedule.rounds), 0}, {0, schedule.rounds / 2}, {0, 0}};
    // Samples that are relaxed along the surface leave its creases, and not all of them find back. Where that may matter,
    // unfolding has to prove itself against the next plan: when every decibel is wanted, and on machined parts.
    const bool compare = before.folds > 0 && !options.thorough &&
                         (options.strength == FitOptions::Strength::kLoose ||
                          crease_share(reference.mesh, static_cast<double>(gluing.defined_count())) > kCreased);
    Fitted result;
    result.positions = start;
    FitQuality after = before;
    for (size_t k = 0; k < plans.size(); ++k) {
        Fitter fitter = untouched;
        run_schedule(fitter, schedule, plans[k], options.seed, k == 0 ? progress : Progress{});
        result.rounds += schedule.rounds;
        FitQuality reached = fitter.quality();
        for (int again = 0; again < kLastUnfoldings && reached.folds > before.folds; ++again) {
            fitter.unfold();
            reached = fitter.quality();
        }
        if (!no_worse(reached, before)) continue;
        if (result.improved && kUnfoldPrice * distance(reached) >= distance(after))
            break;  // the unfolded one is better
        after = reached;
        for (uint32_t v = 0; v < start.size(); ++v) {
            if (gluing.is_defined(v) && !fitter.held()[v]) result.positions[v] = frame.out_of(fitter.positions()[v]);
        }
        const bool compare_with_next = compare && k == 0 && !result.improved;
        result.improved = true;
        if (!compare_with_next) break;
    }
    const auto in_input_unit = [&](FitQuality quality) {
        quality.to_image /= frame.scale;
        quality.to_reference /= frame.scale;
        return quality;
    };
    result.before = in_input_unit(before);
    result.after = in_input_unit(after);
    if (progress) progress(Stage::kFit, 1.0);
    return result;
}

}  // namespace

Result<Fitted> fit(const std::vector<Vec3>& start, const GridGluing& gluing, const Mesh& reference,
                   const FitOptions& options, const Progress& progress) {
    if (auto bad = check_input(start, gluing, reference, options.held)) return *std::move(bad);
    Fitted result;
    with_threads(options.threads, [&] { result = fit_in_arena(start, gluing, reference, options, progress); });
    return result;
}

Result<Fitted> fit(const GeometryImage& start, const Mesh& reference, const FitOptions& options,
                   const Progress& progress) {
    GIM_TRY(gluing, glue_ring(start.sideband, start.side));
    return fit(start.positions, gluing, reference, options, progress);
}

Result<FitQuality> measure_fit(const std::vector<Vec3>& positions, const GridGluing& gluing, const Mesh& reference,
                               const std::vector<bool>& held, uint32_t threads) {
    if (auto bad = check_input(positions, gluing, reference, held)) return *std::move(bad);
    FitQuality quality;
    with_threads(threads, [&] {
        const Frame frame(reference);
        const Reference scaled(Mesh{frame.into(reference.positions), reference.triangles});
        const std::vector<Vec3> points = frame.into(positions);
        quality = measure(points, gluing, scaled, held.empty() ? std::vector<bool>(points.size(), false) : held,
                          front_side(points, gluing, scaled));
        quality.to_image /= frame.scale;
        quality.to_reference /= frame.scale;
    });
    return quality;
}

Result<FitQuality> measure_fit(const GeometryImage& image, const Mesh& reference, const std::vector<bool>& held,
                               uint32_t threads) {
    GIM_TRY(gluing, glue_ring(image.sideband, image.side));
    return measure_fit(image.positions, gluing, reference, held, threads);
}

}  // namespace gim
