// Cleans input meshes (clean.h). Not from a paper: layouts need oriented 2-manifolds, and files do not promise them.
#include "encoder/surface/clean.h"

#include <algorithm>
#include <string>
#include <utility>

#include "encoder/base/result.h"
#include "encoder/surface/check_mesh.h"
#include "encoder/surface/cut_one_sided.h"
#include "encoder/surface/describe_mesh.h"
#include "encoder/surface/flip_slivers.h"
#include "encoder/surface/join_surface.h"
#include "encoder/surface/make_simplicial.h"
#include "encoder/surface/normal_breaks.h"
#include "encoder/surface/orient_faces.h"
#include "encoder/surface/repair_warnings.h"

namespace gim {

namespace {

Error error(std::string message) { return Error{Stage::kClean, std::move(message)}; }

// A vertex for each fan of joined faces.
CleanMesh make_vertices(const std::vector<Point>& positions, const JoinedSurface& surface) {
    Fans fans = number_fans(surface.joins.twin, surface.places, surface.triangles);
    CleanMesh result;
    for (const uint32_t name : fans.name) result.mesh.positions.push_back(to_vec(positions[surface.place[name]]));
    for (size_t c = 0; c < fans.of_corner.size(); c += 3)
        result.mesh.triangles.push_back({fans.of_corner[c], fans.of_corner[c + 1], fans.of_corner[c + 2]});
    result.source_vertex = std::move(fans.name);
    return result;
}

// Counts the input vertices that became part of another, and those without a face.
void count_vertices(const std::vector<Triangle>& triangles, const CleanMesh& made, size_t vertices, Repairs& repairs) {
    std::vector<uint8_t> is_used(vertices, 0), has_own(vertices, 0);
    for (const Triangle& t : triangles) {
        for (const uint32_t v : t) is_used[v] = 1;
    }
    for (const uint32_t v : made.source_vertex) has_own[v] = 1;
    for (size_t v = 0; v < vertices; ++v) {
        repairs.unreferenced_vertices += is_used[v] ? 0 : 1;
        repairs.welded_vertices += is_used[v] && !has_own[v] ? 1 : 0;
    }
}

// Returns the first vertex of each place at which the surface has several.
std::vector<uint32_t> find_touching(const CleanMesh& made, const std::vector<uint32_t>& place) {
    std::vector<uint8_t> count(place.size(), 0);
    std::vector<uint32_t> touching;
    for (uint32_t v = 0; v < made.source_vertex.size(); ++v) {
        uint8_t& here = count[place[made.source_vertex[v]]];
        if (here == 1) touching.push_back(v);
        here = static_cast<uint8_t>(std::min(here + 1, 2));
    }
    return touching;
}

// Gives each fan of a vertex its own vertex, and drops vertices without faces.
void renumber(CleanMesh& made) {
    const Fans fans = number_fans(build_topology(made.mesh).twin, made.mesh.triangles, made.mesh.triangles);
    std::vector<Vec3> positions;
    std::vector<uint32_t> sources;
    for (const uint32_t v : fans.name) {
        positions.push_back(made.mesh.positions[v]);
        sources.push_back(made.source_vertex[v]);
    }
    for (size_t c = 0; c < fans.of_corner.size(); ++c) made.mesh.triangles[c / 3][c % 3] = fans.of_corner[c];
    made.mesh.positions = std::move(positions);
    made.source_vertex = std::move(sources);
}

std::vector<uint64_t> sizes_of_components(const Mesh& mesh) {
    const Components components = connected_components(mesh.triangles, mesh.positions.size());
    std::vector<uint64_t> sizes(components.count, 0);
    for (const uint32_t c : components.of_face) ++sizes[c];
    return sizes;
}

}  // namespace

Result<CleanMesh> clean(const TriangleMesh& input, const CleanOptions& options) {
    GIM_CHECK(check_numbers(input));
    const std::vector<Point>& positions = input.positions;
    GIM_TRY(surface, join_surface(input, options));
    RepairPlaces places;
    places.crowded = middles_of(positions, surface.places, surface.joins.crowded);
    places.cut = middles_of(positions, surface.places, surface.joins.cut);
    places.slits = middles_of(positions, surface.places, cut_one_sided(positions, surface.places, surface.joins.twin));
    const OrientCounts turned = orient_faces(positions, surface.triangles, surface.places, surface.joins.twin);
    CleanMesh made = make_vertices(positions, surface);

    Repairs repairs = surface.repairs;
    count_vertices(input.triangles, made, positions.size(), repairs);
    for (const uint32_t v : find_touching(made, surface.place)) places.touching.push_back(made.mesh.positions[v]);
    repairs.crowded_edges = places.crowded.size();
    repairs.cut_edges = places.cut.size();
    repairs.split_points = places.touching.size();
    repairs.one_sided_cuts = places.slits.size();
    repairs.flipped_triangles = turned.flipped;
    repairs.inside_out = turned.inside_out;

    make_simplicial(made.mesh, surface.joins.twin, made.source_vertex);
    const SliverCounts slivers = flip_slivers(made.mesh, surface.resolution);
    repairs.slivers = slivers.flipped + slivers.dropped;
    for (const uint32_t v : slivers.vertices) places.slivers.push_back(made.mesh.positions[v]);
    if (made.mesh.triangles.empty())
        return error("every triangle of the mesh is a line, but for rounding; the surface has no area");
    if (slivers.dropped > 0) renumber(made);
    made.breaks = find_breaks(input, surface.place, made.mesh, made.source_vertex);

    made.report.topology = analyse_topology(made.mesh.triangles, made.mesh.positions.size()).summary;
    if (options.require_connected && made.report.topology.components > 1)
        return error(describe_components(sizes_of_components(made.mesh)));
    made.report.repairs = repairs;
    made.report.warnings = repair_warnings(repairs, places, input.triangles.size());
    return made;
}

}  // namespace gim
