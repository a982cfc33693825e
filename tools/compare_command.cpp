// gim compare: measures the distances between two surfaces, the angle between their normals, and their connectivity.
#include <array>
#include <cstdio>

#include "tools/commands.h"
#include "tools/input.h"
#include "tools/report_json.h"

namespace gim {
namespace {

void print_topology(const char* which, const std::string& path, const TopologySummary& t) {
    std::printf("%s %s\n", which, path.c_str());
    std::printf("  vertices %s, triangles %s, components %llu, boundary loops %llu, ",
                with_thousands(t.vertices).c_str(), with_thousands(t.triangles).c_str(),
                static_cast<unsigned long long>(t.components), static_cast<unsigned long long>(t.boundary_loops));
    if (t.manifold) {
        std::printf("genus %g, %s\n", t.genus, t.watertight ? "watertight" : "manifold, not closed");
    } else {
        std::printf("not a manifold (%llu non-manifold edges, %llu non-manifold vertices, %llu misoriented edges)\n",
                    static_cast<unsigned long long>(t.nonmanifold_edges),
                    static_cast<unsigned long long>(t.nonmanifold_vertices),
                    static_cast<unsigned long long>(t.misoriented_edges));
    }
}

std::string count_triangles(uint64_t count) {
    return with_thousands(count) + (count == 1 ? " triangle" : " triangles");
}

void print_defects(const Defects& d) {
    std::printf("folded over                %s\n", describe_folds(d).c_str());
    if (d.largest_fold.faces > 0) std::printf("largest fold               %s\n", describe_fold(d.largest_fold).c_str());
    std::printf("edges folded back          %s (%s in the reference)\n", with_thousands(d.folded_back_edges).c_str(),
                with_thousands(d.folded_back_edges_of_reference).c_str());
    std::printf("normals off by > 20, > 45  %.4f%%, %.4f%% of the area\n", 100 * d.off_by_20, 100 * d.off_by_45);
    std::printf("normals, 95 %%, 99 %%        %.2f, %.2f degrees\n", d.normals_p95, d.normals_p99);
    std::printf("distance / RMS, 99.9 %%     %.2f, largest %.2f\n", d.p999_over_rms, d.max_over_rms);
}

}  // namespace

std::string describe_folds(const Defects& defects) {
    char area[40];
    std::snprintf(area, sizeof(area), "%.4f%%", 100 * defects.folded_area);
    return count_triangles(defects.folded_faces) + ", " + area + " of the area";
}

std::string describe_fold(const Defects::Fold& fold) {
    char place[100];
    std::snprintf(place, sizeof(place), "(%.8g, %.8g, %.8g)", fold.center[0], fold.center[1], fold.center[2]);
    return count_triangles(fold.faces) + " near " + place;
}

int run_compare(const CompareCommand& command) {
    const std::array<NamedFile, 2> files = {{{"REFERENCE", command.reference}, {"TEST", command.test}}};
    if (const auto failure = check_files(files)) return report_error(*failure);
    const std::string reference_name = shown_name(command.reference, Direction::kRead);
    const std::string test_name = shown_name(command.test, Direction::kRead);
    const ReadOptions how = {Want::kShape, command.max_memory, command.format};
    const Result<TriangleMesh> reference = read_surface_aloud(command.reference, 0, how);
    if (!reference.ok()) return report_error(reference_name, reference.error());
    const Result<TriangleMesh> test = read_surface_aloud(command.test, command.level, how);
    if (!test.ok()) return report_error(test_name, test.error());
    CompareOptions options = command.options;
    options.normals = options.defects = true;
    const Result<Comparison> compared = compare(reference.value(), test.value(), options);
    if (!compared.ok()) return report_error(reference_name + " and " + test_name, compared.error());

    const Comparison& c = compared.value();
    const TopologySummary reference_topology = summarize_topology(reference.value());
    const TopologySummary test_topology = summarize_topology(test.value());
    if (command.json) {
        const nlohmann::ordered_json document = {
            {"reference", {{"file", command.reference}, {"topology", to_json(reference_topology)}}},
            {"test", {{"file", command.test}, {"topology", to_json(test_topology)}}},
            {"comparison", to_json(c)}};
        std::fputs(json_text(document).c_str(), stdout);
        return 0;
    }
    print_topology("reference", reference_name, reference_topology);
    print_topology("test     ", test_name, test_topology);
    std::printf("diagonal of the reference  %.9g\n", c.diagonal);
    std::printf("RMS reference to test      %.6g\n", c.rms_to_test);
    std::printf("RMS test to reference      %.6g\n", c.rms_to_reference);
    std::printf("RMS (larger of the two)    %.6g\n", c.rms);
    std::printf("max reference to test      %.6g\n", c.max_to_test);
    std::printf("max test to reference      %.6g\n", c.max_to_reference);
    std::printf("Hausdorff distance         %.6g\n", c.hausdorff);
    std::printf("PSNR                       %.3f dB\n", c.psnr);
    if (c.normals) {
        std::printf("normals, mean angle        %.3f degrees (%.3f reference to test, %.3f test to reference)\n",
                    c.normals->mean, c.normals->to_test, c.normals->to_reference);
    }
    if (c.defects) print_defects(*c.defects);
    return 0;
}

}  // namespace gim
