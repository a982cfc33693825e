#include "encoder/squares/parametrize.h"

#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "encoder/base/result.h"
#include "encoder/surface/describe_mesh.h"
#include "encoder/surface/face_metrics.h"
#include "encoder/surface/progressive_mesh.h"
#include "encoder/surface/refine.h"
#include "encoder/surface/stretch.h"
#include "encoder/surface/tutte.h"

namespace gim {

namespace {

constexpr uint32_t kBaseInterior = 60;   // interior vertices of the base mesh, if collapses allow it
constexpr uint32_t kFewerInterior = 3;   // divides them for the next try
constexpr double kPatientGrowth = 1.03;  // growth in these tries
constexpr int kBaseSweeps = 200;         // enough for the base mesh to converge

bool tutte_map(const ProgressiveMesh& mesh, std::vector<Vec2>& uv) {
    std::vector<uint8_t> fixed(uv.size(), 1);
    std::vector<std::array<uint32_t, 2>> arcs;
    for (uint32_t v = 0; v < uv.size(); ++v) {
        if (mesh.removed(v) || mesh.on_boundary(v)) continue;
        fixed[v] = 0;
        mesh.for_each_neighbour(v, [&](uint32_t w) { arcs.push_back({v, w}); });
    }
    return solve_tutte(arcs, fixed, uv);
}

bool is_upright(const ProgressiveMesh& mesh, const std::vector<Vec2>& uv) {
    for (uint32_t h = 0; h < mesh.half_edge_count(); h += 3) {
        if (!mesh.alive(face_of(h))) continue;
        if (!(twice_signed_area(uv[mesh.origin(h)], uv[mesh.origin(h + 1)], uv[mesh.origin(h + 2)]) > 0)) return false;
    }
    return true;
}

// Optimises the map on a mesh that is refined step by step.
class Optimiser {
  public:
    Optimiser(ProgressiveMesh& mesh, const std::vector<Vec3>& positions, const ParametrizeOptions& options,
              double surface, std::vector<Vec2>& uv)
        : mesh_(mesh),
          metrics_(positions, options.importance, surface, 1, options.squeeze),
          uv_(uv),
          metric_(mesh.half_edge_count() / 3) {
        std::vector<Triangle> faces;
        for (uint32_t f = 0; f < metric_.size(); ++f) {
            if (mesh_.alive(f)) faces.push_back(corners_of(f));
        }
        metrics_.set_least_area(faces, metric_.size());
        for (uint32_t f = 0; f < metric_.size(); ++f) {
            if (mesh_.alive(f)) metric_[f] = metrics_.of(corners_of(f));
        }
    }

    // Makes one pass over all interior vertices. Returns the energy gained, as a part of the energy that is left.
    double sweep(int steps) {
        double gain = 0, total = 0;
        for (uint32_t v = 0; v < uv_.size(); ++v) {
            if (mesh_.removed(v) || mesh_.on_boundary(v)) continue;
            load_star(v);
            const double before = star_energy_at(uv_[v]);
            const double after = minimise_star(star_, uv_[v], steps);
            if (std::isfinite(before)) gain += before - after, total += after;
        }
        return total > 0 ? 3 * gain / total : 0;  // every triangle is in up to three stars
    }

    void sweep_until(int most, double tolerance) {
        for (int i = 0; i < most; ++i) {
            if (sweep(1) < tolerance) break;
        }
    }

    // Puts a vertex that came back inside its star and relaxes its surroundings. Returns false if no place keeps all
    // faces upright.
    bool insert(const VertexSplit& split) {
        mesh_.for_each_outgoing(split.vertex,
                                [&](uint32_t h) { metric_[face_of(h)] = metrics_.of(corners_of(face_of(h))); });
        load_star(split.vertex);
        Vec2 x = Vec2::Zero();
        for (const StarTriangle& t : star_) x += t.p1;
        x /= static_cast<double>(star_.size());
        if (!std::isfinite(star_energy_at(x)) && !find_kernel_point(star_, x)) return false;
        minimise_star(star_, x, 4);
        uv_[split.vertex] = x;
        for (const uint32_t v : {split.into, split.left, split.right, split.vertex}) relax(v, 2);
        return true;
    }

    void relax(uint32_t v, int steps) {
        if (mesh_.on_boundary(v)) return;
        load_star(v);
        minimise_star(star_, uv_[v], steps);
    }

  private:
    Triangle corners_of(uint32_t f) const {
        return {mesh_.origin(3 * f), mesh_.origin(3 * f + 1), mesh_.origin(3 * f + 2)};
    }
    void load_star(uint32_t v) {
        star_.clear();
        mesh_.for_each_outgoing(v, [&](uint32_t h) {
            const FaceMetric& m = metric_[face_of(h)];
            const uint32_t i = h % 3;
            star_.push_back({uv_[mesh_.target(h)],
                             uv_[mesh_.origin(prev(h))],
                             {m.squared_length[i], m.squared_length[(i + 1) % 3], m.squared_length[(i + 2) % 3]},
                             m.weight,
                             m.squeeze});
        });
    }
    double star_energy_at(const Vec2& x) const {
        double energy = 0;
        for (const StarTriangle& t : star_)
            energy += stretch_energy({t.squared_length, t.weight, t.squeeze}, x, t.p1, t.p2);
        return energy;
    }

    ProgressiveMesh& mesh_;
    FaceMetrics metrics_;
    std::vector<Vec2>& uv_;
    std::vector<FaceMetric> metric_;
    std::vector<StarTriangle> star_;
};

Error flipped_error(const Mesh& mesh, const std::vector<Vec2>& uv) {
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        const Triangle& t = mesh.triangles[f];
        if (twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]) > 0) continue;
        const Vec3& p = mesh.positions[t[0]];
        return {Stage::kParametrize,
                std::to_string(count_flipped(mesh, uv)) + " triangles could not be kept upright, the first near " +
                    text_of({p.x(), p.y(), p.z()}) + "; remove slivers there, or simplify the mesh a little"};
    }
    return {Stage::kParametrize, "no triangle is flipped"};
}

}  // namespace

DiskMapper::DiskMapper(const Mesh& mesh, std::vector<uint8_t> sides, std::vector<Vec2> uv)
    : mesh_(mesh),
      sides_(std::move(sides)),
      border_(std::move(uv)),
      boundary_(static_cast<uint32_t>(sides_.size() - std::count(sides_.begin(), sides_.end(), 0))),
      coarse_(coarsened_to(kBaseInterior)) {}

// Coarsens the mesh to its boundary and some interior vertices.
ProgressiveMesh DiskMapper::coarsened_to(uint32_t interior) const {
    ProgressiveMesh hierarchy(mesh_);
    simplify(hierarchy, mesh_.positions, {boundary_ + interior, true, sides_});
    return hierarchy;
}

// Maps a coarse version, and refines it. Returns an Error if a face has no room in double precision.
Result<std::vector<Vec2>> DiskMapper::map_from(ProgressiveMesh hierarchy, const ParametrizeOptions& options,
                                               const Progress& progress) const {
    std::vector<Vec2> uv = border_;
    if (!tutte_map(hierarchy, uv) || !is_upright(hierarchy, uv))
        return Error{Stage::kParametrize, "a coarse version of the surface could not be mapped to the square"};

    Optimiser optimiser(hierarchy, mesh_.positions, options, surface_area(mesh_), uv);
    optimiser.sweep_until(kBaseSweeps, options.tolerance);
    const auto total = static_cast<double>(hierarchy.collapse_count());
    double sweep_at = options.growth * std::max(hierarchy.vertex_count() - boundary_, 1u);
    while (hierarchy.coarsened()) {
        if (!optimiser.insert(hierarchy.split())) return flipped_error(mesh_, uv);
        if (hierarchy.vertex_count() - boundary_ < sweep_at) continue;
        sweep_at *= options.growth;
        optimiser.sweep_until(options.sweeps, options.tolerance);
        if (progress) progress(Stage::kParametrize, 1 - static_cast<double>(hierarchy.collapse_count()) / total);
    }
    optimiser.sweep_until(options.final_sweeps, options.tolerance);
    if (count_flipped(mesh_, uv) != 0) return flipped_error(mesh_, uv);
    return uv;
}

// Tutte's map shrinks by a factor with every triangle that encloses the next. Where many do, it leaves no digits to the
// innermost faces. A coarser base mesh has fewer, and those that come back later are spread soon.
Result<std::vector<Vec2>> DiskMapper::map(const ParametrizeOptions& options, const Progress& progress) const {
    auto map = map_from(coarse_, options, progress);
    ParametrizeOptions patient = options;
    patient.growth = std::min(options.growth, kPatientGrowth);
    for (uint32_t interior = kBaseInterior; !map.ok() && interior > 0;) {
        interior /= kFewerInterior;
        map = map_from(coarsened_to(interior), patient, progress);
    }
    return map;
}

Result<std::vector<Vec2>> parametrize(const Mesh& mesh, const std::vector<uint8_t>& sides, std::vector<Vec2> uv,
                                      const ParametrizeOptions& options, const Progress& progress) {
    return DiskMapper(mesh, sides, std::move(uv)).map(options, progress);
}

uint64_t count_flipped(const Mesh& mesh, const std::vector<Vec2>& uv) {
    return static_cast<uint64_t>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        return !(twice_signed_area(uv[t[0]], uv[t[1]], uv[t[2]]) > 0);
    }));
}

}  // namespace gim
