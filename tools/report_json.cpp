#include "tools/report_json.h"

#include <cmath>

namespace gim {

using nlohmann::ordered_json;

ordered_json to_json(const TopologySummary& topology) {
    return {{"vertices", topology.vertices},
            {"edges", topology.edges},
            {"triangles", topology.triangles},
            {"components", topology.components},
            {"boundary_loops", topology.boundary_loops},
            {"boundary_edges", topology.boundary_edges},
            {"euler", topology.euler},
            {"genus", topology.genus},
            {"nonmanifold_edges", topology.nonmanifold_edges},
            {"nonmanifold_vertices", topology.nonmanifold_vertices},
            {"misoriented_edges", topology.misoriented_edges},
            {"manifold", topology.manifold},
            {"watertight", topology.watertight}};
}

ordered_json to_json(const Comparison& comparison) {
    ordered_json json = {{"diagonal", comparison.diagonal},
                         {"rms_to_test", comparison.rms_to_test},
                         {"rms_to_reference", comparison.rms_to_reference},
                         {"rms", comparison.rms},
                         {"max_to_test", comparison.max_to_test},
                         {"max_to_reference", comparison.max_to_reference},
                         {"hausdorff", comparison.hausdorff},
                         {"psnr", comparison.psnr}};
    if (const auto& normals = comparison.normals) {
        json["normal_error"] = {
            {"to_test", normals->to_test}, {"to_reference", normals->to_reference}, {"mean", normals->mean}};
    }
    if (comparison.defects) json["defects"] = to_json(*comparison.defects);
    return json;
}

ordered_json to_json(const Defects& defects) {
    return {{"folded_faces", defects.folded_faces},
            {"folded_area", defects.folded_area},
            {"off_by_20", defects.off_by_20},
            {"off_by_45", defects.off_by_45},
            {"normals_p95", defects.normals_p95},
            {"normals_p99", defects.normals_p99},
            {"p999_over_rms", defects.p999_over_rms},
            {"max_over_rms", defects.max_over_rms},
            {"folded_back_edges", defects.folded_back_edges},
            {"folded_back_edges_of_reference", defects.folded_back_edges_of_reference},
            {"largest_fold",
             {{"center", defects.largest_fold.center},
              {"area", defects.largest_fold.area},
              {"faces", defects.largest_fold.faces}}}};
}

ordered_json to_json(const Repairs& repairs) {
    return {{"welded_vertices", repairs.welded_vertices},
            {"unreferenced_vertices", repairs.unreferenced_vertices},
            {"degenerate_triangles", repairs.degenerate_triangles},
            {"nearly_welded", repairs.nearly_welded},
            {"duplicate_triangles", repairs.duplicate_triangles},
            {"double_triangles", repairs.double_triangles},
            {"slivers", repairs.slivers},
            {"crowded_edges", repairs.crowded_edges},
            {"cut_edges", repairs.cut_edges},
            {"split_points", repairs.split_points},
            {"one_sided_cuts", repairs.one_sided_cuts},
            {"flipped_triangles", repairs.flipped_triangles},
            {"inside_out", repairs.inside_out}};
}

const char* name_of(Layout layout) {
    switch (layout) {
        case Layout::kMcgim:
            return "mcgim";
        case Layout::kTiles:
            return "tiles";
        case Layout::kGim:
        case Layout::kAuto:
            break;
    }
    return "gim";
}

ordered_json to_json(const EncodeReport& report) {
    ordered_json planes = ordered_json::array();
    for (const PlaneReport& plane : report.planes) {
        const bool is_color = plane.kind == PlaneReport::Kind::kColors;
        ordered_json entry = {{"kind", is_color ? "colors" : "normals"},
                              {"width", plane.width},
                              {"height", plane.height},
                              {"bytes", plane.bytes}};
        entry[is_color ? "psnr" : "mean_angle"] = is_color ? plane.psnr : plane.mean_angle;
        planes.push_back(entry);
    }
    ordered_json times = ordered_json::array();
    for (const StageTime& time : report.times) times.push_back({{"stage", time.stage}, {"seconds", time.seconds}});
    ordered_json levels = ordered_json::array();
    for (const LevelReport& level : report.levels) {
        levels.push_back({{"level", level.level},
                          {"width", level.width},
                          {"height", level.height},
                          {"vertices", level.vertices},
                          {"triangles", level.triangles},
                          {"prefix_bytes", level.prefix_bytes},
                          {"psnr", level.psnr},
                          {"rms_error", level.rms_error},
                          {"max_error", level.max_error},
                          {"defects", to_json(level.defects)}});
    }
    ordered_json others = ordered_json::array();
    for (const LayoutCost& cost : report.others) {
        others.push_back({{"layout", name_of(cost.layout)},
                          {"bytes", std::round(cost.bytes)},
                          {"psnr", cost.psnr},
                          {"is_estimate", cost.is_estimate}});
    }
    return {{"input_vertices", report.input_vertices},
            {"input_triangles", report.input_triangles},
            {"repairs", to_json(report.repairs)},
            {"warnings", report.warnings},
            {"topology", to_json(report.topology)},
            {"hard_edges", report.hard_edges},
            {"hard_edges_kept", report.hard_edges_kept},
            {"layout", name_of(report.layout)},
            {"others", others},
            {"images", report.images},
            {"width", report.width},
            {"height", report.height},
            {"samples", report.samples},
            {"charts", report.charts},
            {"border_samples", report.border_samples},
            {"open_samples", report.open_samples},
            {"tiles", report.tiles},
            {"defined_samples", report.defined_samples},
            {"packing_efficiency", report.packing_efficiency},
            {"side", report.side},
            {"node_side", report.node_side},
            {"cut_paths", report.cut_paths},
            {"cut_length", report.cut_length},
            {"stretch_efficiency", report.stretch_efficiency},
            {"folds", report.folds},
            {"folds_before_fit", report.folds_before_fit},
            {"flipped_triangles", report.flipped_triangles},
            {"bits_per_sample", report.bits_per_sample},
            {"bits_per_vertex", report.bits_per_vertex},
            {"file_bytes", report.file_bytes},
            {"sideband_bytes", report.sideband_bytes},
            {"planes", planes},
            {"error", to_json(report.error)},
            {"levels", levels},
            {"times", times},
            {"seconds", report.seconds}};
}

std::string json_text(const ordered_json& document) {
    return document.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace gim
