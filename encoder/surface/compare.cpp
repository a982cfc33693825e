// Measures the distance between two surfaces, both ways (gim/encoder.h, "comparing").
// In: two triangle meshes, of any topology. Out: area-weighted RMS and largest distances, PSNR; if asked for, the angle
// between shading normals, and visible defects.
// Cost: O((|A| + |B| + samples) log); two meshes of 500,000 faces take a few seconds on one core.
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <span>
#include <string>

#include "encoder/base/parallel.h"
#include "encoder/base/result.h"
#include "encoder/surface/closest_point.h"
#include "encoder/surface/compare_frame.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/defects.h"
#include "encoder/surface/shading_normals.h"
#include "encoder/surface/surface_samples.h"
#include "gim/encoder.h"

namespace gim {

namespace {

Result<Mesh> checked_mesh(const TriangleMesh& input, const char* which) {
    const auto fail = [&](const std::string& message) {
        return Error{Stage::kCompare, "the " + std::string(which) + message};
    };
    if (input.triangles.empty()) return fail(" mesh has no triangles");
    Mesh mesh;
    mesh.positions.reserve(input.positions.size());
    for (const auto& p : input.positions) mesh.positions.emplace_back(p[0], p[1], p[2]);
    mesh.triangles = input.triangles;
    for (size_t f = 0; f < mesh.triangles.size(); ++f) {
        for (const uint32_t v : mesh.triangles[f]) {
            if (v >= mesh.positions.size()) {
                return fail(" mesh's triangle " + std::to_string(f) + " uses vertex " + std::to_string(v) +
                            ", but there are only " + std::to_string(mesh.positions.size()));
            }
            if (!mesh.positions[v].allFinite()) return fail(" mesh's vertex " + std::to_string(v) + " is not finite");
        }
    }
    return mesh;
}

// Returns the vertices that triangles use.
std::vector<Vec3> referenced_vertices(const Mesh& mesh) {
    std::vector<bool> used(mesh.positions.size(), false);
    for (const Triangle& t : mesh.triangles) {
        for (const uint32_t v : t) used[v] = true;
    }
    std::vector<Vec3> vertices;
    for (size_t v = 0; v < used.size(); ++v) {
        if (used[v]) vertices.push_back(mesh.positions[v]);
    }
    return vertices;
}

// One side of a comparison. The normals are empty if they are not asked for.
struct Side {
    const Mesh& mesh;
    const ClosestPointTree& tree;
    const std::vector<Vec3>& normals;
};

struct OneWay {
    bool has_area = false;
    double rms = 0, largest = 0;
    double degrees = 0;   // mean angle between shading normals
    PairedSamples pairs;  // empty unless normals or defects are asked for
};

// Sum and maximum of squared distances of points to a surface.
struct Squares {
    double sum = 0, largest = 0;
};

// Stores the closest points in `all`, unless it is empty.
Squares squared_distances(const std::vector<Vec3>& points, const ClosestPointTree& surface, uint32_t threads,
                          std::span<ClosestPoint> all = {}) {
    constexpr size_t kBlock = 2048;
    std::vector<Squares> partial((points.size() + kBlock - 1) / kBlock);
    parallel_blocks(points.size(), kBlock, threads, [&](size_t block, size_t begin, size_t end) {
        uint32_t hint = kNone;
        for (size_t i = begin; i < end; ++i) {
            const ClosestPoint found = surface.find(points[i], hint);
            hint = found.triangle;
            if (!all.empty()) all[i] = found;
            partial[block].sum += found.squared_distance;
            partial[block].largest = std::max(partial[block].largest, found.squared_distance);
        }
    });
    Squares total;
    for (const Squares& p : partial) {
        total.sum += p.sum;
        total.largest = std::max(total.largest, p.largest);
    }
    return total;
}

// Returns the sum of the angles between both surfaces' shading normals at the samples, in degrees.
double angle_sum(const Side& from, const Side& to, const PairedSamples& pairs, uint32_t threads) {
    return parallel_sum(pairs.found.size(), threads, [&](size_t i) {
        const Vec2& b = pairs.samples.barycentrics[i];
        const Vec3 here =
            shading_normal_at(from.mesh, from.normals, pairs.samples.triangles[i], {1 - b[0] - b[1], b[0], b[1]});
        const Vec3 there = shading_normal_at(to.mesh, to.normals, pairs.found[i].triangle, pairs.found[i].barycentric);
        return degrees_between(here, there);
    });
}

// The largest distance is usually at a vertex. Vertices do not enter the mean.
OneWay distance_to(const Side& from, const Side& to, const CompareOptions& options) {
    OneWay result;
    result.pairs.samples = sample_by_area(from.mesh, options.samples, options.seed, options.threads);
    const std::vector<Vec3>& points = result.pairs.samples.points;
    result.pairs.found.resize(options.normals || options.defects ? points.size() : 0);
    const Squares inside = squared_distances(points, to.tree, options.threads, result.pairs.found);
    result.largest = inside.largest;
    if (options.vertices) {
        const Squares corners = squared_distances(referenced_vertices(from.mesh), to.tree, options.threads);
        result.largest = std::max(result.largest, corners.largest);
    }
    result.largest = std::sqrt(result.largest);
    result.has_area = !points.empty();
    if (!result.has_area) return result;
    const auto count = static_cast<double>(points.size());
    result.rms = std::sqrt(inside.sum / count);
    if (options.normals) result.degrees = angle_sum(from, to, result.pairs, options.threads) / count;
    return result;
}

// Small surfaces are known as well by fewer samples: those of 100,000 give the PSNR to .05 dB.
uint32_t usual_samples(size_t faces) {
    constexpr size_t kFewest = 100000, kMost = 500000, kEachFace = 4;
    return static_cast<uint32_t>(std::clamp(kEachFace * faces, kFewest, kMost));
}

double p999_of_distance(const PairedSamples& pairs) {
    std::vector<double> distances;
    distances.reserve(pairs.found.size());
    for (const ClosestPoint& point : pairs.found) distances.push_back(std::sqrt(point.squared_distance));
    return percentile(distances, 0.999);
}

}  // namespace

double bounding_diagonal(const Mesh& mesh) {
    const std::vector<Vec3> points = referenced_vertices(mesh);
    Vec3 low = points.front(), high = low;
    for (const Vec3& p : points) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    return (high - low).norm();
}

class ReferenceSurface::Traits {
  public:
    const std::vector<Vec3>& normals(const Mesh& mesh) {
        once(has_normals_, [&] { normals_ = shading_normals(mesh, NormalWeight::kArea); });
        return normals_;
    }
    const DefectTraits& defects(const Mesh& mesh) {
        once(has_defects_, [&] { defects_ = defect_traits(mesh); });
        return defects_;
    }

  private:
    // Isolated: a thread that waits for the work's own tasks must not begin another comparison, which would wait for it.
    template <class Work>
    static void once(std::once_flag& flag, const Work& work) {
        std::call_once(flag, [&] { tbb::this_task_arena::isolate(work); });
    }

    std::once_flag has_normals_, has_defects_;
    std::vector<Vec3> normals_;
    DefectTraits defects_;
};

ReferenceSurface::ReferenceSurface(Mesh mesh, uint32_t threads)
    : mesh_(std::move(mesh)),
      tree_(mesh_, threads),
      diagonal_(bounding_diagonal(mesh_)),
      traits_(std::make_unique<Traits>()) {}
ReferenceSurface::~ReferenceSurface() = default;

Result<Comparison> ReferenceSurface::compare(const Mesh& test, const CompareOptions& asked) const {
    CompareOptions options = asked;
    if (options.samples == 0) options.samples = usual_samples(mesh_.triangles.size() + test.triangles.size());
    const auto no_area = [](const char* which) {
        return Error{Stage::kCompare,
                     "the " + std::string(which) + " mesh has no area: all its triangles are degenerate"};
    };
    const ClosestPointTree test_tree(test, options.threads);
    const std::vector<Vec3> none, test_normals = options.normals ? shading_normals(test, NormalWeight::kArea) : none;
    const Side reference_side{mesh_, tree_, options.normals ? traits_->normals(mesh_) : none};
    const Side test_side{test, test_tree, test_normals};
    const OneWay to_test = distance_to(reference_side, test_side, options);
    if (!to_test.has_area) return no_area("reference");
    const OneWay to_reference = distance_to(test_side, reference_side, options);
    if (!to_reference.has_area) return no_area("test");
    Comparison result;
    result.diagonal = diagonal_;
    result.rms_to_test = to_test.rms;
    result.rms_to_reference = to_reference.rms;
    result.rms = std::max(to_test.rms, to_reference.rms);
    result.max_to_test = to_test.largest;
    result.max_to_reference = to_reference.largest;
    result.hausdorff = std::max(to_test.largest, to_reference.largest);
    result.psnr =
        result.rms > 0 ? 20 * std::log10(result.diagonal / result.rms) : std::numeric_limits<double>::infinity();
    if (options.normals) {
        result.normals = NormalError{.to_test = to_test.degrees,
                                     .to_reference = to_reference.degrees,
                                     .mean = (to_test.degrees + to_reference.degrees) / 2};
    }
    if (options.defects) {
        const DefectReference reference{mesh_, tree_, traits_->defects(mesh_)};
        result.defects = measure_defects(test, reference, to_reference.pairs, to_test.pairs, options.threads);
        if (result.rms > 0) {
            result.defects->max_over_rms = result.hausdorff / result.rms;
            result.defects->p999_over_rms =
                std::max(p999_of_distance(to_test.pairs), p999_of_distance(to_reference.pairs)) / result.rms;
        }
    }
    return result;
}

Result<Comparison> compare(const TriangleMesh& reference, const TriangleMesh& test, const CompareOptions& options) {
    GIM_TRY(mesh_a, checked_mesh(reference, "reference"));
    GIM_TRY(mesh_b, checked_mesh(test, "test"));
    const CompareFrame frame = choose_compare_frame(mesh_a, mesh_b);
    move_into(frame, mesh_a);
    move_into(frame, mesh_b);
    GIM_TRY(comparison, ReferenceSurface(std::move(mesh_a), options.threads).compare(mesh_b, options));
    move_out_of(frame, comparison);
    return comparison;
}

Result<DefectMap> map_defects(const TriangleMesh& reference, const TriangleMesh& test, uint32_t threads) {
    GIM_TRY(mesh_a, checked_mesh(reference, "reference"));
    GIM_TRY(mesh_b, checked_mesh(test, "test"));
    const CompareFrame frame = choose_compare_frame(mesh_a, mesh_b);
    move_into(frame, mesh_a);
    move_into(frame, mesh_b);
    return locate_defects(mesh_b, mesh_a, ClosestPointTree(mesh_a, threads), threads);
}

}  // namespace gim
