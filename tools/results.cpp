// gim_results: measures the encoder and writes corpus/results.csv (CONTRIBUTING.md, "Results").
// The file is written again after each measured row. Rows that are not measured stay as they are.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include "corpus/corpus.h"
#include "gim/decoder.hpp"
#include "tools/decoded.h"
#include "tools/file.h"
#include "tools/input.h"
#include "tools/report_json.h"

namespace gim {
namespace {

constexpr std::string_view kHeader =
    "model,setting,coder,width,height,charts,packing,vertices,bytes,psnr_db,rms_to_test,rms_to_reference,hausdorff,"
    "stretch_efficiency,folds_sampled,folded_faces,folded_area,off_by_20,off_by_45,normals_p95,normals_p99,"
    "p999_over_rms,max_over_rms,folded_back_edges,folded_back_edges_of_reference,level1_folded_faces,"
    "level1_folded_area,levels,decode_ms,encode_cpu_s,layout,tiles";
constexpr const char* kPackagedBunny = "/usr/share/glmark2/models/bunny.obj";
constexpr uint32_t kDefaultSide = 257;

// In the order of the file. Generated models come first, because every machine has them.
constexpr std::array kGenerated = {"sphere-rough-10800", "box-19200",   "limbs-rough",
                                   "torus-rough-4096",   "tori-3",      "plate-5",
                                   "terrain-3200",       "annulus-512", "sphere-holes-6"};
constexpr std::array kScanned = {
    "bunny-closed", "horse",          "dragon",     "feline",  "gargoyle",   "igea",    "venus",
    "hand",         "david",          "rocker-arm", "fandisk", "block",      "eight",   "cow",
    "three-torus",  "flange-genus13", "bunny",      "mask",    "mask-holes", "laurana", "terrain-sthelens",
    "teapot",       "bones"};
constexpr std::array kAgainstRivals = {"bunny", "horse",  "feline",   "venus", "igea",
                                       "hand",  "dragon", "gargoyle", "david", "rocker-arm"};
constexpr std::array kRaced = {"bunny",   "horse",  "feline",         "venus",  "igea",
                               "hand",    "dragon", "gargoyle",       "david",  "rocker-arm",
                               "fandisk", "block",  "flange-genus13", "teapot", "bones"};
constexpr std::array kOfThePaper = {"horse", "dragon", "feline", "gargoyle"};

struct Setting {
    const char* name;
    std::span<const char* const> models;  // measured unless --only names others; empty: all
    RateTarget rate;
    uint32_t bits = 12;
    Layout layout = Layout::kGim;
    bool any_side = false;  // the encoder may choose a smaller side, as the program does without --size
};
constexpr uint32_t kChartSamples = 65536;  // as in the paper's tables
constexpr RateTarget kLossless = {RateTarget::Kind::kLossless, 0};
constexpr RateTarget psnr_target(double value) { return {RateTarget::Kind::kPsnr, value}; }
constexpr std::array<Setting, 13> kSettings = {
    {{"quality-75", {}, {RateTarget::Kind::kQuality, 75}},
     {"psnr-70", {}, psnr_target(70)},
     {"file-60-db", kAgainstRivals, psnr_target(60), 12, Layout::kGim, true},
     {"file-65-db", kAgainstRivals, psnr_target(65), 12, Layout::kGim, true},
     {"file-70-db", kAgainstRivals, psnr_target(70), 12, Layout::kGim, true},
     {"file-75-db", kAgainstRivals, psnr_target(75), 12, Layout::kGim, true},
     {"auto-60-db", kRaced, psnr_target(60), 12, Layout::kAuto, true},
     {"auto-65-db", kRaced, psnr_target(65), 12, Layout::kAuto, true},
     {"auto-70-db", kRaced, psnr_target(70), 12, Layout::kAuto, true},
     {"auto-75-db", kRaced, psnr_target(75), 12, Layout::kAuto, true},
     {"lossless-16", {}, kLossless, 16},
     {"mcgim-lossless-16", kScanned, kLossless, 16, Layout::kMcgim},
     {"mcgim-2-bits-a-sample", kOfThePaper, {RateTarget::Kind::kBytes, kChartSamples * 2.0 / 8}, 12, Layout::kMcgim}}};

std::optional<TriangleMesh> scanned_mesh(const std::string& name, const std::string& folder) {
    Result<TriangleMesh> mesh = read_surface(folder + "/" + name + ".ply", 0);
    if (!mesh.ok() && name == "bunny-closed") mesh = read_surface(kPackagedBunny, 0);
    if (!mesh.ok()) return std::nullopt;
    return std::move(mesh.value());
}

// Time to decode level 0 of all images to meshes with normals, on one thread with warm memory. The best of several runs
// counts, because other programs may use the machine too. Negative if the file does not decode.
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

// Like printf, into a string.
template <class... Value>
std::string cells(const char* format, Value... values) {
    char text[400];
    std::snprintf(text, sizeof(text), format, values...);
    return text;
}

unsigned long long wide(uint64_t count) { return count; }

// Cells of the decoded surface's defects; those of level 1 are empty if the file has no such level.
std::string defect_cells(const EncodeReport& report) {
    const Defects& d = *report.error.defects;
    std::string text = cells("%llu,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%.4g,%llu,%llu", wide(d.folded_faces), d.folded_area,
                             d.off_by_20, d.off_by_45, d.normals_p95, d.normals_p99, d.p999_over_rms, d.max_over_rms,
                             wide(d.folded_back_edges), wide(d.folded_back_edges_of_reference));
    if (report.levels.size() < 2) return text + ",,";
    const Defects& coarser = report.levels[1].defects;
    return text + cells(",%llu,%.4g", wide(coarser.folded_faces), coarser.folded_area);
}

std::string failed_row(const std::string& model, const Setting& setting, const TriangleMesh& mesh, Stage stage) {
    const std::string row = cells("%s,%s,%u,,,,,%zu,failed: %s", model.c_str(), setting.name, kCoderVersion,
                                  mesh.positions.size(), std::string(stage_name(stage)).c_str());
    const auto commas = [](std::string_view text) { return std::count(text.begin(), text.end(), ','); };
    return row + std::string(static_cast<size_t>(commas(kHeader) - commas(row)), ',');
}

std::string measured_row(const std::string& model, const Setting& setting, const TriangleMesh& mesh, uint32_t side) {
    EncodeOptions options;
    options.side = side;
    options.try_smaller_sides = setting.any_side;
    options.bits = setting.bits;
    options.layout = setting.layout;
    options.samples = kChartSamples;
    options.rate = setting.rate;
    options.color_side = 0;                   // the surface alone
    const std::clock_t begin = std::clock();  // processor time of all threads
    const Result<Encoded> encoded = encode(mesh, options);
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    if (!encoded.ok()) return failed_row(model, setting, mesh, encoded.error().stage);
    const EncodeReport& r = encoded.value().report;
    return cells("%s,%s,%u,%u,%u,%u,%.3f,%llu,%llu,", model.c_str(), setting.name, kCoderVersion, r.width, r.height,
                 r.charts, r.charts > 0 ? r.packing_efficiency : 1.0, wide(r.input_vertices), wide(r.file_bytes)) +
           cells("%.2f,%.4g,%.4g,%.4g,%.4f,%llu,", r.error.psnr, r.error.rms_to_test, r.error.rms_to_reference,
                 r.error.hausdorff, r.stretch_efficiency, wide(r.folds_before_fit)) +
           defect_cells(r) +
           cells(",%zu,%.2f,%.1f,%s,%u", r.levels.size(), decode_milliseconds(encoded.value().bytes), seconds,
                 name_of(r.layout), r.tiles);
}

bool is_among(std::span<const char* const> names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// The rows of the CSV file, by model and setting.
class Table {
  public:
    explicit Table(std::string path) : path_(std::move(path)) {}

    // A missing file is an empty table.
    Result<void> read() {
        const Result<Bytes> old = read_file(path_);
        if (!old.ok()) return {};
        std::istringstream lines(std::string(old.value().begin(), old.value().end()));
        std::string line;
        std::getline(lines, line);
        if (line != kHeader)
            return Error{Stage::kInput, "it has other columns than this program writes; name another file"};
        while (std::getline(lines, line)) {
            const size_t after_model = line.find(',');
            rows_[line.substr(0, line.find(',', after_model + 1))] = line;
        }
        return {};
    }

    Result<void> set(const std::string& model, const Setting& setting, const std::string& row) {
        rows_[model + "," + setting.name] = row;
        return write();
    }

  private:
    // Models in the order above; rows of other models and settings are dropped.
    Result<void> write() const {
        std::string text = std::string(kHeader) + "\n";
        const auto append = [&](std::span<const char* const> models) {
            for (const std::string model : models) {
                for (const Setting& setting : kSettings) {
                    const auto row = rows_.find(model + "," + setting.name);
                    if (row != rows_.end()) text += row->second + "\n";
                }
            }
        };
        append(kGenerated);
        append(kScanned);
        return write_file(path_, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
    }

    std::string path_;
    std::map<std::string, std::string> rows_;
};

struct Wanted {
    std::vector<std::string> models, settings;  // empty: all
    uint32_t side = kDefaultSide;
};

bool is_wanted(const Wanted& wanted, const std::string& model, const Setting& setting) {
    const auto has = [](const std::vector<std::string>& names, const std::string& name) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (!wanted.settings.empty() && !has(wanted.settings, setting.name)) return false;
    if (!wanted.models.empty()) return has(wanted.models, model);
    return setting.models.empty() || is_among(setting.models, model);
}

// One model after the other, so that a mesh is read once.
Result<void> measure(Table& table, const Wanted& wanted, const std::string& folder) {
    const auto measure_model = [&](const std::string& name, bool is_scanned) -> Result<void> {
        std::vector<const Setting*> settings;
        for (const Setting& setting : kSettings) {
            if (is_wanted(wanted, name, setting)) settings.push_back(&setting);
        }
        if (settings.empty()) return {};
        const std::optional<TriangleMesh> mesh =
            is_scanned ? scanned_mesh(name, folder) : corpus::corpus().named(name).mesh();
        if (!mesh) std::fprintf(stderr, "%s: not on this machine; its rows stay\n", name.c_str());
        for (const Setting* setting : settings) {
            if (!mesh) break;
            const std::string row = measured_row(name, *setting, *mesh, wanted.side);
            std::fprintf(stderr, "%s\n", row.c_str());
            const Result<void> written = table.set(name, *setting, row);
            if (!written.ok()) return written.error();
        }
        return {};
    };
    for (const char* name : kGenerated) {
        const Result<void> measured = measure_model(name, false);
        if (!measured.ok()) return measured.error();
    }
    for (const char* name : kScanned) {
        const Result<void> measured = measure_model(name, true);
        if (!measured.ok()) return measured.error();
    }
    return {};
}

int run(const std::string& path, const std::string& folder, const Wanted& wanted) {
    Table table(path);
    Result<void> done = table.read();
    if (done.ok()) done = measure(table, wanted, folder);
    if (done.ok()) return 0;
    std::fprintf(stderr, "gim_results: %s: %s\n", path.c_str(), done.error().message.c_str());
    return 1;
}

}  // namespace
}  // namespace gim

int main(int argc, char** argv) {
    std::string path;
    std::string models = GIM_MODELS_DIR;
    gim::Wanted wanted;
    CLI::App app("gim_results: encodes the corpus and records bytes, error and time.");
    app.footer("decode_ms and encode_cpu_s depend on the machine. All other columns must not.");
    app.add_option("CSV", path, "File to write, usually corpus/results.csv")->required();
    app.add_option("--models", models, "Folder of the development models (PLY)")->capture_default_str();
    app.add_option("--only", wanted.models, "Measure only these models, keep the other rows");
    app.add_option("--settings", wanted.settings, "Measure only these settings, keep the other rows");
    app.add_option("--size", wanted.side, "Samples per side; the most if the encoder chooses")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    return gim::run(path, models, wanted);
}
