#include "encoder/surface/repair_warnings.h"

#include <algorithm>

#include "encoder/surface/describe_mesh.h"

namespace gim {

namespace {

constexpr double kWarnedShare = 0.001;  // of the triangles

std::string list_of(const std::vector<Vec3>& places) {
    std::string text;
    for (size_t k = 0; k < std::min(kListed, places.size()); ++k)
        text += (k == 0 ? "; at " : ", ") + text_of({places[k][0], places[k][1], places[k][2]});
    return text + (places.size() > kListed ? ", ..." : "");
}

}  // namespace

std::vector<Vec3> middles_of(const std::vector<Point>& positions, const std::vector<Triangle>& triangles,
                             const std::vector<uint32_t>& half_edges) {
    std::vector<Vec3> middles;
    for (const uint32_t h : half_edges) middles.push_back(to_vec(middle_of_edge(positions, triangles, h)));
    return middles;
}

std::vector<std::string> repair_warnings(const Repairs& repairs, const RepairPlaces& places, uint64_t triangles) {
    std::vector<std::string> warnings;
    const auto is_many = [&](uint64_t n) {
        return n > 0 && static_cast<double>(n) >= kWarnedShare * static_cast<double>(triangles);
    };
    if (repairs.one_sided_cuts > 0) {
        warnings.push_back("the surface has only one side (like a Moebius strip); it was cut open along " +
                           count_of(repairs.one_sided_cuts, "edge", "edges") + list_of(places.slits));
    }
    if (repairs.cut_edges > 0) {
        warnings.push_back(count_of(repairs.cut_edges, "edge has", "edges have") +
                           " more than two faces that do not form pairs; the surface was cut open there" +
                           list_of(places.cut));
    }
    if (is_many(repairs.crowded_edges) && repairs.crowded_edges > repairs.cut_edges) {
        warnings.push_back(count_of(repairs.crowded_edges, "edge has", "edges have") +
                           " more than two faces; faces were joined in pairs" + list_of(places.crowded));
    }
    if (is_many(repairs.split_points)) {
        warnings.push_back("the surface touches itself in " + count_of(repairs.split_points, "point", "points") +
                           "; each part has its own vertex there" + list_of(places.touching));
    }
    if (is_many(repairs.nearly_welded)) {
        warnings.push_back(count_of(repairs.nearly_welded, "boundary vertex was", "boundary vertices were") +
                           " welded to another at almost the same place (--weld 0 keeps them apart)");
    }
    if (is_many(repairs.double_triangles)) {
        warnings.push_back(count_of(repairs.double_triangles, "triangle lies", "triangles lie") +
                           " on the back of another and went; the surface keeps one side");
    }
    if (is_many(repairs.duplicate_triangles)) {
        warnings.push_back(count_of(repairs.duplicate_triangles, "triangle repeats", "triangles repeat") +
                           " another and went");
    }
    if (is_many(repairs.slivers)) {
        warnings.push_back(count_of(repairs.slivers, "triangle has", "triangles have") +
                           " no area; their points went into the neighbours' edges" + list_of(places.slivers));
    }
    if (is_many(repairs.flipped_triangles)) {
        warnings.push_back(count_of(repairs.flipped_triangles, "triangle was", "triangles were") +
                           " turned over to agree with the neighbours");
    }
    return warnings;
}

}  // namespace gim
