// gim bench-scene: draws a scene of many instances, and says what each part of a frame costs.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>

#include "tools/commands.h"
#include "tools/file.h"
#include "tools/output_files.h"
#include "tools/scene/scene_run.h"
#include "tools/stb.h"

namespace gim {
namespace {

using nlohmann::json;

double median(std::vector<double> values) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
}

template <class F>
std::vector<double> each(const std::vector<FrameFigures>& frames, const F& f) {
    std::vector<double> values;
    for (const FrameFigures& frame : frames) values.push_back(double(f(frame)));
    return values;
}

double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }
double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

json milliseconds(const std::vector<double>& values) { return {{"median", median(values)}, {"worst", most(values)}}; }

json describe(const std::vector<FrameFigures>& frames) {
    const auto triangles = each(frames, [](const FrameFigures& f) { return f.triangles; });
    const auto patches = each(frames, [](const FrameFigures& f) { return f.patches; });
    constexpr double kBytesOfPatch = 8, kBytesOfTriangle = 12;
    json out;
    out["refine_ms"] = milliseconds(each(frames, [](const FrameFigures& f) { return f.refine; }));
    out["list_ms"] = milliseconds(each(frames, [](const FrameFigures& f) { return f.list; }));
    out["upload_ms"] = milliseconds(each(frames, [](const FrameFigures& f) { return f.upload; }));
    out["draw_ms"] = milliseconds(each(frames, [](const FrameFigures& f) { return f.draw; }));
    out["frame_ms"] = milliseconds(each(frames, [](const FrameFigures& f) { return f.total(); }));
    out["triangles"] = {{"mean", mean(triangles)}, {"most", most(triangles)}};
    out["drawn"] = {{"mean", mean(each(frames, [](const FrameFigures& f) { return f.drawn; }))}};
    out["patches"] = {{"mean", mean(patches)}, {"most", most(patches)}};
    out["patch_bytes_over_index_bytes"] = mean(patches) * kBytesOfPatch / (mean(triangles) * kBytesOfTriangle);
    out["most_pixel_error"] = most(each(frames, [](const FrameFigures& f) { return f.pixel_error; }));
    return out;
}

json describe(const Scene& scene, const SceneFigures& figures) {
    json root = {{"instances", scene.instances.size()},
                 {"meshes", scene.meshes.size()},
                 {"frames", scene.frames},
                 {"width", scene.width},
                 {"height", scene.height},
                 {"pixel_error", scene.pixel_error},
                 {"renderer", figures.renderer.empty() ? json() : json(figures.renderer)},
                 {"bytes_of_files", figures.bytes_of_files},
                 {"bytes_of_refined_meshes", figures.bytes_of_meshes},
                 {"adaptive", describe(figures.adaptive)}};
    if (!figures.full.empty()) {
        root["discrete"] = describe(figures.discrete);
        root["full"] = describe(figures.full);
    }
    return root;
}

void print_row(const char* name, const json& way) {
    char line[256];
    std::snprintf(line, sizeof line, "  %-9s %9.2f %9.2f %9.2f %9.2f %9.2f %9.2f  %12s", name,
                  way["refine_ms"]["median"].get<double>(), way["list_ms"]["median"].get<double>(),
                  way["upload_ms"]["median"].get<double>(), way["draw_ms"]["median"].get<double>(),
                  way["frame_ms"]["median"].get<double>(), way["frame_ms"]["worst"].get<double>(),
                  with_thousands(static_cast<uint64_t>(way["triangles"]["mean"].get<double>())).c_str());
    print_line(line);
}

void print_table(const json& figures) {
    print_line(std::to_string(figures["instances"].get<uint64_t>()) + " instances, " +
               std::to_string(figures["frames"].get<uint32_t>()) + " frames" +
               (figures["renderer"].is_null() ? ", nothing drawn" : "; " + figures["renderer"].get<std::string>()));
    print_line("  median ms    refine      list    upload      draw     frame     worst     triangles");
    print_row("adaptive", figures["adaptive"]);
    if (!figures.contains("full")) return;
    print_row("4 levels", figures["discrete"]);
    print_row("full", figures["full"]);
}

std::string name_of_frame(const std::string& folder, uint32_t number) {
    char name[32];
    std::snprintf(name, sizeof name, "frame-%05u.png", number);
    return (std::filesystem::path(folder) / name).string();
}

Result<void> write_frame(const std::string& folder, const SceneFrame& frame) {
    OutputFiles outputs;
    const Result<void> staged =
        outputs.stage(name_of_frame(folder, frame.number), png_bytes(frame.rgb.data(), frame.width, frame.height));
    if (!staged.ok()) return staged.error();
    if (const auto failure = outputs.commit()) return failure->error;
    return {};
}

}  // namespace

int run_bench_scene(const BenchSceneCommand& command) {
    const std::array<NamedFile, 2> names = {
        {{"SCENE", command.scene, Direction::kRead}, {"--json", command.json, Direction::kWrite}}};
    if (const auto failure = check_files(names)) return report_error(*failure);
    const std::string name = shown_name(command.scene, Direction::kRead);
    const Result<Bytes> text = read_named(command.scene);
    if (!text.ok()) return report_error(name, text.error());
    const Result<Scene> scene = read_scene(std::string(text.value().begin(), text.value().end()),
                                           std::filesystem::path(command.scene).parent_path().string());
    if (!scene.ok()) return report_error(name, scene.error());
    if (!command.frames.empty()) {
        std::error_code failed;
        std::filesystem::create_directories(command.frames, failed);
        if (failed) return report_error(command.frames, {Stage::kWrite, failed.message()});
    }
    SceneRun run;
    run.draws = command.draws;
    run.compares = command.compares;
    if (!command.frames.empty())
        run.take_frame = [&](const SceneFrame& frame) { return write_frame(command.frames, frame); };
    const Result<SceneFigures> figures = run_scene(scene.value(), run);
    if (!figures.ok()) return report_error(name, figures.error());
    const json described = describe(scene.value(), figures.value());
    if (!is_standard_output(command.json)) print_table(described);
    if (command.json.empty()) return 0;
    OutputFiles outputs;
    const std::string out = described.dump(2) + "\n";
    const Result<void> staged = outputs.stage(command.json, Bytes(out.begin(), out.end()));
    if (!staged.ok()) return report_error(command.json, staged.error());
    if (const auto failure = outputs.commit()) return report_error(*failure);
    return 0;
}

}  // namespace gim
