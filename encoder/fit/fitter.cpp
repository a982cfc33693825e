#include "encoder/fit/fitter.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/base/parallel.h"
#include "encoder/fit/image_surface.h"
#include "encoder/surface/space_order.h"
#include "encoder/surface/surface_samples.h"
#include "encoder/surface/topology_summary.h"

namespace gim {

namespace {

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

// Counts the faces that look away from the reference at their centres.
uint64_t count_folds(const ImageSurface& image, const FitReference& reference, const std::vector<bool>& held,
                     double front) {
    const std::vector<Vec3>& positions = image.mesh.positions;
    std::vector<Vec3> centres(image.mesh.triangles.size());
    for (size_t f = 0; f < centres.size(); ++f) {
        const Triangle& t = image.mesh.triangles[f];
        centres[f] = (positions[t[0]] + positions[t[1]] + positions[t[2]]) / 3;
    }
    const std::vector<ClosestPoint> at_centre = reference.tree.find_all(centres);
    return static_cast<uint64_t>(parallel_sum(centres.size(), 0, [&](size_t f) {
        if (touches(image.mesh.triangles[f], held)) return 0.0;
        return front * image.normals[f].dot(reference.normals[at_centre[f].triangle]) < 0 ? 1.0 : 0.0;
    }));
}

}  // namespace

Mesh boundary_curve(const Mesh& mesh) {
    Mesh curve{mesh.positions, {}};
    const Topology topology = build_topology(mesh);
    for (uint32_t h = 0; h < topology.twin.size(); ++h) {
        if (topology.twin[h] == kNone) curve.triangles.push_back({from(mesh, h), to(mesh, h), to(mesh, h)});
    }
    return curve;
}

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
    : mesh(in_space_order(std::move(input))),
      normals(face_normals(mesh)),
      tree(mesh),
      curve(boundary_curve(mesh)),
      curve_tree(curve) {}

FitQuality measure(const std::vector<Vec3>& positions, const GridGluing& gluing, const FitReference& reference,
                   const std::vector<bool>& held, double front, ClosestPointTree& tree) {
    constexpr uint64_t kSeed = 0x6d6561737572655fu;
    const ImageSurface image(positions, gluing);
    const size_t faces = image.mesh.triangles.size();
    const auto density = static_cast<uint32_t>(std::max(faces / 8, std::min<size_t>(20000, 16 * faces)));
    FitQuality quality;

    tree.refit(image.mesh);
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

    quality.folds = count_folds(image, reference, held, front);
    return quality;
}

double front_side(const std::vector<Vec3>& positions, const GridGluing& gluing, const FitReference& reference) {
    const ImageSurface image(positions, gluing);
    const auto count = static_cast<uint32_t>(std::min<size_t>(8 * image.mesh.triangles.size(), 4000));
    const SurfaceSamples samples = sample_by_area(image.mesh, count, 1);
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
      rails_(frame.into(options.rails)),
      x_(frame.into(start)),
      held_(options.held),
      samples_(static_cast<double>(gluing_.defined_count())),
      face_hint_(2 * gluing_.kind.size(), kNone) {
    if (held_.empty()) held_.assign(x_.size(), false);
    // Puts each class at one place, its mean. If one of its samples is held, all are.
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
    for (size_t v = 0; v < options.still.size(); ++v) fixed_[v] = fixed_[v] || options.still[v];
    has_curve_ = !reference_.curve.triangles.empty();
    for (uint32_t v = 0; v < x_.size(); ++v) {
        if (!gluing_.on_input_boundary[v]) continue;
        if (!has_curve_) fixed_[v] = true;
        on_boundary_.push_back(v);
    }
    front_ = front_side(x_, gluing_, reference_);
}

void Fitter::begin_at(std::vector<Vec3> positions) {
    place(std::move(positions));
    face_hint_.assign(face_hint_.size(), kNone);
}

FitQuality Fitter::quality() { return measure(x_, gluing_, reference_, held_, front_, image_tree_); }

uint64_t Fitter::folds() const { return count_folds(ImageSurface(x_, gluing_), reference_, held_, front_); }

void Fitter::round(double lambda, double density, uint64_t seed, bool guarded) {
    const FitSystem system = linearise(lambda, density, seed);
    take_step(solve(system.matrix, system.right, gluing_, fixed_, {}).values, guarded);
}

}  // namespace gim
