// gim_results: writes corpus/results.csv, the record of what the encoder reaches (CONTRIBUTING.md, "Results").
// Models that this machine does not have keep the rows that the file already holds.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <limits>
#include <optional>
#include <sstream>

#include "corpus/corpus.h"
#include "gim/decoder.hpp"
#include "tools/decoded.h"
#include "tools/file.h"
#include "tools/input.h"

namespace gim {
namespace {

constexpr const char* kHeader =
    "model,setting,width,height,charts,packing,vertices,bytes,psnr_db,rms_to_test,rms_to_reference,hausdorff,"
    "stretch_efficiency,folds_sampled,folds,levels,decode_ms,encode_s";
constexpr const char* kPackagedBunny = "/usr/share/glmark2/models/bunny.obj";

// In the order of the file. Generated models first: every machine has them.
constexpr std::array kGenerated = {"sphere-rough-10800", "box-19200",   "limbs-rough",
                                   "torus-rough-4096",   "tori-3",      "plate-5",
                                   "terrain-3200",       "annulus-512", "sphere-holes-6"};
constexpr std::array kScanned = {
    "bunny-closed", "horse",          "dragon",     "feline",  "gargoyle",   "igea",    "venus",
    "hand",         "david",          "rocker-arm", "fandisk", "block",      "eight",   "cow",
    "three-torus",  "flange-genus13", "bunny",      "mask",    "mask-holes", "laurana", "terrain-sthelens",
    "teapot",       "bones"};

struct Setting {
    const char* name;
    RateTarget rate;
    uint32_t bits;
    Layout layout = Layout::kGim;
};
constexpr uint32_t kChartSamples = 65536;  // as in the paper's tables
constexpr std::array<Setting, 5> kSettings = {
    {{"quality-75", {RateTarget::Kind::kQuality, 75}, 12},
     {"psnr-70", {RateTarget::Kind::kPsnr, 70}, 12},
     {"lossless-16", {RateTarget::Kind::kLossless, 0}, 16},
     {"mcgim-lossless-16", {RateTarget::Kind::kLossless, 0}, 16, Layout::kMcgim},
     {"mcgim-2-bits-a-sample", {RateTarget::Kind::kBytes, kChartSamples * 2.0 / 8}, 12, Layout::kMcgim}}};

std::optional<TriangleMesh> scanned_mesh(const std::string& name, const std::string& folder) {
    Result<TriangleMesh> mesh = read_surface(folder + "/" + name + ".ply", 0);
    if (!mesh.ok() && name == "bunny-closed") mesh = read_surface(kPackagedBunny, 0);
    if (!mesh.ok()) return std::nullopt;
    return std::move(mesh.value());
}

// Level 0 of all images as meshes with normals: best of several, so that other work on the machine counts little. One thread,
// warm memory. Negative: it does not decode.
double decode_milliseconds(const Bytes& file) {
    constexpr int kRuns = 20;
    Decoder decoder;
    if (decoder.open(file) != GIM_OK) return -1;
    double sum = 0;
    for (uint32_t image = 0; image < decoder.info().image_count; ++image) {
        DecoderLevel level;
        if (decoder.read_level(image, 0, &level) != GIM_OK) return -1;
        std::vector<float> positions(size_t{3} * level.vertex_count);
        std::vector<float> normals(positions.size());
        std::vector<uint32_t> triangles(size_t{3} * level.triangle_count);
        double best = std::numeric_limits<double>::infinity();
        for (int i = 0; i < kRuns; ++i) {
            const auto begin = std::chrono::steady_clock::now();
            if (decoder.mesh(level, {positions, normals, {}, triangles}) != GIM_OK) return -1;
            const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
            best = std::min(best, time.count());
        }
        sum += best;
    }
    return sum;
}

std::string row(const std::string& model, const Setting& setting, const TriangleMesh& mesh, uint32_t side) {
    EncodeOptions options;
    options.side = side;
    options.bits = setting.bits;
    options.layout = setting.layout;
    options.samples = kChartSamples;
    options.rate = setting.rate;
    options.color_side = 0;  // the surface alone
    const Result<Encoded> encoded = encode(mesh, options);
    char line[400];
    if (!encoded.ok()) {
        const std::string stage(stage_name(encoded.error().stage));
        std::snprintf(line, sizeof(line), "%s,%s,,,,,%zu,failed: %s,,,,,,,,,,", model.c_str(), setting.name,
                      mesh.positions.size(), stage.c_str());
        return line;
    }
    const EncodeReport& r = encoded.value().report;
    std::snprintf(line, sizeof(line), "%s,%s,%u,%u,%u,%.3f,%llu,%llu,%.2f,%.4g,%.4g,%.4g,%.4f,%llu,%llu,%zu,%.2f,%.1f",
                  model.c_str(), setting.name, r.width, r.height, r.charts, r.charts > 0 ? r.packing_efficiency : 1.0,
                  static_cast<unsigned long long>(r.input_vertices), static_cast<unsigned long long>(r.file_bytes),
                  r.error.psnr, r.error.rms_to_test, r.error.rms_to_reference, r.error.hausdorff, r.stretch_efficiency,
                  static_cast<unsigned long long>(r.folds_before_fit), static_cast<unsigned long long>(r.folds),
                  r.levels.size(), decode_milliseconds(encoded.value().bytes), r.seconds);
    return line;
}

std::vector<std::string> old_rows(const std::string& path, const std::string& model) {
    std::vector<std::string> rows;
    const Result<Bytes> old = read_file(path);
    if (!old.ok()) return rows;
    std::istringstream lines(std::string(old.value().begin(), old.value().end()));
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(model + ",")) rows.push_back(line);
    }
    return rows;
}

bool is_wanted(const std::vector<std::string>& only, const std::string& name) {
    return only.empty() || std::find(only.begin(), only.end(), name) != only.end();
}

struct Wanted {
    std::vector<std::string> models, settings;  // empty: all
};

int run(const std::string& path, const std::string& models, const Wanted& wanted, uint32_t side) {
    std::string text = std::string(kHeader) + "\n";
    const auto add_model = [&](const std::string& name, const std::optional<TriangleMesh>& mesh) {
        const bool is_model_wanted = is_wanted(wanted.models, name);
        if (!mesh || !is_model_wanted) {
            std::fprintf(stderr, "%-20s %s\n", name.c_str(),
                         is_model_wanted ? "not here, its old rows stay" : "left as it is");
            for (const std::string& line : old_rows(path, name)) text += line + "\n";
            return;
        }
        for (const Setting& setting : kSettings) {
            if (!is_wanted(wanted.settings, setting.name)) {
                for (const std::string& line : old_rows(path, name + "," + setting.name)) text += line + "\n";
                continue;
            }
            const std::string line = row(name, setting, *mesh, side);
            std::fprintf(stderr, "%s\n", line.c_str());
            text += line + "\n";
        }
    };
    for (const char* name : kGenerated) add_model(name, corpus::corpus().named(name).mesh());
    for (const char* name : kScanned) add_model(name, scanned_mesh(name, models));

    const Result<bool> written = write_file(path, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    if (!written.ok()) {
        std::fprintf(stderr, "gim_results: %s: %s\n", path.c_str(), written.error().message.c_str());
        return 1;
    }
    return 0;
}

}  // namespace
}  // namespace gim

int main(int argc, char** argv) {
    std::string path;
    std::string models = GIM_MODELS_DIR;
    gim::Wanted wanted;
    uint32_t side = 257;
    CLI::App app("gim_results: encodes the corpus and writes the record of bytes, error and time.");
    app.footer("decode_ms and encode_s depend on the machine; everything else must not.");
    app.add_option("CSV", path, "File to write, usually corpus/results.csv")->required();
    app.add_option("--models", models, "Folder of the development models (PLY)")->capture_default_str();
    app.add_option("--only", wanted.models, "Measure these models, keep the other rows");
    app.add_option("--settings", wanted.settings, "Measure only these settings, keep the other rows");
    app.add_option("--size", side, "Samples per side")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return gim::run(path, models, wanted, side);
}
