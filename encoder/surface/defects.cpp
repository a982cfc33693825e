#include "encoder/surface/defects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "encoder/base/disjoint_sets.h"
#include "encoder/base/parallel.h"
#include "encoder/surface/shading_normals.h"
#include "encoder/surface/topology_summary.h"

namespace gim {

namespace {

constexpr double kFoldedBack = -0.86602540378443864676;  // -cos 30 degrees

Vec3 face_normal(const Mesh& mesh, const Triangle& t) {
    const Vec3& a = mesh.positions[t[0]];
    const Vec3 area = (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a);
    const double length = area.stableNorm();
    return length > 0 ? Vec3(area / length) : Vec3::Zero();
}

std::vector<Vec3> face_normals(const Mesh& mesh) {
    std::vector<Vec3> normals(mesh.triangles.size());
    parallel_blocks(normals.size(), 16384, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) normals[f] = face_normal(mesh, mesh.triangles[f]);
    });
    return normals;
}

// Angles, in degrees, between the shading normals of samples and of their closest points.
std::vector<double> normal_angles(const Mesh& from, const std::vector<Vec3>& from_normals, const Mesh& to,
                                  const std::vector<Vec3>& to_normals, const PairedSamples& pairs, uint32_t threads) {
    std::vector<double> angles(pairs.samples.points.size());
    parallel_blocks(angles.size(), 4096, threads, [&](size_t, size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            const Vec2& b = pairs.samples.barycentrics[i];
            const Vec3 here =
                shading_normal_at(from, from_normals, pairs.samples.triangles[i], {1 - b[0] - b[1], b[0], b[1]});
            const Vec3 there = shading_normal_at(to, to_normals, pairs.found[i].triangle, pairs.found[i].barycentric);
            angles[i] = degrees_between(here, there);
        }
    });
    return angles;
}

double share_above(const std::vector<double>& values, double limit) {
    const auto above = std::count_if(values.begin(), values.end(), [&](double v) { return v > limit; });
    return static_cast<double>(above) / static_cast<double>(std::max<size_t>(1, values.size()));
}

double folded_share(const Mesh& test, const Mesh& reference, const PairedSamples& from_test, uint32_t threads) {
    const size_t count = from_test.samples.points.size();
    const double folded = parallel_sum(count, threads, [&](size_t i) {
        const Vec3 here = face_normal(test, test.triangles[from_test.samples.triangles[i]]);
        const Vec3 there = face_normal(reference, reference.triangles[from_test.found[i].triangle]);
        return here.dot(there) < 0 ? 1.0 : 0.0;
    });
    return folded / static_cast<double>(std::max<size_t>(1, count));
}

}  // namespace

std::vector<uint8_t> find_folded_faces(const Mesh& test, const Mesh& reference, const ClosestPointTree& tree,
                                       uint32_t threads) {
    std::vector<uint8_t> folded(test.triangles.size());
    parallel_blocks(folded.size(), 2048, threads, [&](size_t, size_t begin, size_t end) {
        uint32_t hint = kNone;
        for (size_t f = begin; f < end; ++f) {
            const Triangle& t = test.triangles[f];
            const Vec3 centroid = (test.positions[t[0]] + test.positions[t[1]] + test.positions[t[2]]) / 3;
            hint = tree.find(centroid, hint).triangle;
            folded[f] = face_normal(test, t).dot(face_normal(reference, reference.triangles[hint])) < 0;
        }
    });
    return folded;
}

std::vector<std::array<uint32_t, 2>> find_folded_back_edges(const Mesh& mesh) {
    const std::vector<uint32_t> first = first_at_position(mesh);
    std::vector<Triangle> joined = mesh.triangles;
    for (Triangle& t : joined) {
        for (uint32_t& v : t) v = first[v];
    }
    const std::vector<Vec3> normals = face_normals(mesh);
    const EdgeTable table = build_edge_table(joined, mesh.positions.size());
    std::vector<std::array<uint32_t, 2>> edges;
    for (size_t e = 0; e < table.size(); ++e) {
        const auto around = table.around(e);
        if (around.size() != 2) continue;
        const uint32_t h = around[0];
        const auto [from, to] = std::minmax(joined[face_of(h)][h % 3], joined[face_of(h)][next(h) % 3]);
        if (normals[face_of(h)].dot(normals[face_of(around[1])]) < kFoldedBack) edges.push_back({from, to});
    }
    return edges;
}

Defects::Fold find_largest_fold(const Mesh& mesh, const std::vector<uint8_t>& folded) {
    const std::vector<uint32_t> first = first_at_position(mesh);
    DisjointSets groups(mesh.positions.size());
    for (size_t f = 0; f < folded.size(); ++f) {
        if (!folded[f]) continue;
        const Triangle& t = mesh.triangles[f];
        groups.unite(first[t[0]], first[t[1]]);
        groups.unite(first[t[0]], first[t[2]]);
    }
    struct Group {
        Defects::Fold fold;
        Vec3 moment = Vec3::Zero();
    };
    std::map<uint32_t, Group> found;
    for (uint32_t f = 0; f < folded.size(); ++f) {
        if (!folded[f]) continue;
        const Triangle& t = mesh.triangles[f];
        Group& group = found[groups.find(first[t[0]])];
        const double area = face_area(mesh, f);
        group.fold.area += area;
        group.fold.faces += 1;
        group.moment += area / 3 * (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]);
    }
    Group largest;
    for (const auto& [name, group] : found) {
        if (group.fold.area > largest.fold.area) largest = group;
    }
    if (largest.fold.area > 0) {
        const Vec3 center = largest.moment / largest.fold.area;
        largest.fold.center = {center.x(), center.y(), center.z()};
    }
    return largest.fold;
}

DefectMap locate_defects(const Mesh& test, const Mesh& reference, const ClosestPointTree& tree, uint32_t threads) {
    DefectMap map;
    map.folded = find_folded_faces(test, reference, tree, threads);
    map.folded_back = find_folded_back_edges(test);
    const std::vector<Vec3> test_normals = shading_normals(test, NormalWeight::kAngle),
                            reference_normals = shading_normals(reference, NormalWeight::kAngle);
    std::vector<uint8_t> used(test.positions.size(), 0);
    for (const Triangle& t : test.triangles) {
        for (const uint32_t v : t) used[v] = 1;
    }
    map.off.resize(test.positions.size(), 0.0F);
    parallel_blocks(map.off.size(), 2048, threads, [&](size_t, size_t begin, size_t end) {
        uint32_t hint = kNone;
        for (size_t v = begin; v < end; ++v) {
            if (!used[v]) continue;
            const ClosestPoint found = tree.find(test.positions[v], hint);
            hint = found.triangle;
            const Vec3 there = shading_normal_at(reference, reference_normals, found.triangle, found.barycentric);
            map.off[v] = static_cast<float>(degrees_between(test_normals[v], there));
        }
    });
    return map;
}

double percentile(std::vector<double>& values, double part) {
    const double rank = std::ceil(part * static_cast<double>(values.size()));
    const auto index = static_cast<size_t>(std::clamp(rank, 1.0, static_cast<double>(values.size()))) - 1;
    std::nth_element(values.begin(), values.begin() + static_cast<ptrdiff_t>(index), values.end());
    return values[index];
}

DefectTraits defect_traits(const Mesh& mesh) {
    return {shading_normals(mesh, NormalWeight::kAngle), find_folded_back_edges(mesh).size()};
}

Defects measure_defects(const Mesh& test, const DefectReference& reference, const PairedSamples& from_test,
                        const PairedSamples& from_reference, uint32_t threads) {
    Defects defects;
    const std::vector<uint8_t> folded = find_folded_faces(test, reference.mesh, reference.tree, threads);
    defects.folded_faces = static_cast<uint64_t>(std::count(folded.begin(), folded.end(), 1));
    defects.largest_fold = find_largest_fold(test, folded);
    defects.folded_area = folded_share(test, reference.mesh, from_test, threads);
    const DefectTraits traits = defect_traits(test);
    defects.folded_back_edges = traits.folded_back_edges;
    defects.folded_back_edges_of_reference = reference.traits.folded_back_edges;

    std::vector<double> angles =
        normal_angles(test, traits.normals, reference.mesh, reference.traits.normals, from_test, threads);
    defects.off_by_20 = share_above(angles, 20);
    defects.off_by_45 = share_above(angles, 45);
    const std::vector<double> others =
        normal_angles(reference.mesh, reference.traits.normals, test, traits.normals, from_reference, threads);
    angles.insert(angles.end(), others.begin(), others.end());
    defects.normals_p95 = percentile(angles, 0.95);
    defects.normals_p99 = percentile(angles, 0.99);
    return defects;
}

}  // namespace gim
