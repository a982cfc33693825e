// gim_rivals: runs other codecs for tools/rd/run.py. Evaluation only (GIM_BUILD_RD), never installed.
#include <time.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

#include "tools/decoded.h"
#include "tools/input.h"
#include "tools/rd/rival_codecs.h"
#include "tools/surface_write.h"

namespace gim::rd {
namespace {

int fail(const std::string& file, const std::string& message) {
    std::fprintf(stderr, "gim_rivals: %s: %s\n", file.c_str(), message.c_str());
    return 1;
}

// Reads a mesh with one vertex per position, which suits the rivals best.
Result<RivalMesh> read_rival_mesh(const std::string& path) {
    const Result<TriangleMesh> read = read_surface(path, 0);
    if (!read.ok()) return read.error();
    const TriangleMesh welded = weld_equal_positions(read.value());
    if (welded.triangles.empty()) return Error{Stage::kInput, "it has no triangles"};
    RivalMesh mesh;
    for (const auto& p : welded.positions) {
        mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
    }
    mesh.triangles = welded.triangles;
    return mesh;
}

Result<void> write_mesh(const std::string& path, const RivalMesh& mesh) {
    DecodedImage image;
    for (const auto& p : mesh.positions) image.positions.insert(image.positions.end(), p.begin(), p.end());
    for (const auto& t : mesh.triangles) image.triangles.insert(image.triangles.end(), t.begin(), t.end());
    return write_file(path, write_off({&image, 1}));
}

std::unique_ptr<RepeatedDecoder> decoder_of(const Bytes& bytes) {
    for (const auto make : {make_draco_decoder, make_meshopt_decoder, make_gim_decoder}) {
        if (auto decoder = make(bytes)) return decoder;
    }
    return nullptr;
}

struct Command {
    std::string input, output;
    std::vector<double> ratios;
    std::vector<std::string> files;
    int bits = 12;
    int rounds = 15;
};

int simplify(const Command& c) {
    const Result<RivalMesh> mesh = read_rival_mesh(c.input);
    if (!mesh.ok()) return fail(c.input, mesh.error().message);
    for (const double ratio : c.ratios) {
        char path[32];
        std::snprintf(path, sizeof(path), "%g.off", ratio);
        const Result<void> written = write_mesh(c.output + path, simplify_quadric(mesh.value(), ratio));
        if (!written.ok()) return fail(c.output + path, written.error().message);
    }
    return 0;
}

int encode_with(const Command& c, Result<Bytes> (*encode)(const RivalMesh&, int)) {
    const Result<RivalMesh> mesh = read_rival_mesh(c.input);
    if (!mesh.ok()) return fail(c.input, mesh.error().message);
    const Result<Bytes> bytes = encode(mesh.value(), c.bits);
    if (!bytes.ok()) return fail(c.input, bytes.error().message);
    const Result<void> written = write_file(c.output, bytes.value());
    return written.ok() ? 0 : fail(c.output, written.error().message);
}

int decode(const Command& c) {
    const Result<Bytes> bytes = read_file(c.input);
    if (!bytes.ok()) return fail(c.input, bytes.error().message);
    const auto decoder = decoder_of(bytes.value());
    if (!decoder || !decoder->run()) return fail(c.input, "not a file that decodes");
    const Result<void> written = write_mesh(c.output, decoder->mesh());
    return written.ok() ? 0 : fail(c.output, written.error().message);
}

// Returns the processor time of this thread. On an idle machine this is the time that passes. Other programs count
// little.
double thread_milliseconds() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

// Decodes all files in turns, so that the load of the machine hits all of them alike. Prints medians.
int time_decoders(const Command& c) {
    std::vector<Bytes> contents;
    std::vector<std::unique_ptr<RepeatedDecoder>> decoders;
    contents.reserve(c.files.size());  // the decoders keep references
    for (const std::string& file : c.files) {
        Result<Bytes> bytes = read_file(file);
        if (!bytes.ok()) return fail(file, bytes.error().message);
        contents.push_back(std::move(bytes.value()));
        decoders.push_back(decoder_of(contents.back()));
        if (!decoders.back() || !decoders.back()->run()) return fail(file, "it does not decode");
    }
    std::vector<std::vector<double>> times(decoders.size());
    for (int round = 0; round < c.rounds; ++round) {
        for (size_t i = 0; i < decoders.size(); ++i) {
            const double begin = thread_milliseconds();
            if (!decoders[i]->run()) return fail(c.files[i], "it decodes only sometimes");
            times[i].push_back(thread_milliseconds() - begin);
        }
    }
    std::puts("file,bytes,vertices,triangles,decode_ms,mtri_per_s");
    for (size_t i = 0; i < decoders.size(); ++i) {
        std::sort(times[i].begin(), times[i].end());
        const double median = times[i][times[i].size() / 2];
        const auto [vertices, triangles] = decoders[i]->counts();
        std::printf("%s,%zu,%llu,%llu,%.5f,%.2f\n", c.files[i].c_str(), contents[i].size(),
                    static_cast<unsigned long long>(vertices), static_cast<unsigned long long>(triangles), median,
                    static_cast<double>(triangles) / median / 1000);
    }
    return 0;
}

int run(int argc, const char* const* argv) {
    CLI::App app("Codecs that gim is compared with: Draco, and meshoptimizer with zstd. See tools/rd/run.py.");
    app.require_subcommand(1);
    Command c;
    CLI::App* simplify_app =
        app.add_subcommand("simplify", "Simplify with meshopt_simplify to each ratio, as PREFIX<ratio>.off");
    simplify_app->add_option("IN", c.input, "Mesh")->required();
    simplify_app->add_option("PREFIX", c.output, "Beginning of the output's paths")->required();
    simplify_app->add_option("RATIO", c.ratios, "Share of the triangles to keep")
        ->required()
        ->check(CLI::Range(0.0, 1.0));
    CLI::App* draco_app = app.add_subcommand("draco", "Encode with Draco, compression level 10");
    CLI::App* meshopt_app = app.add_subcommand("meshopt", "Encode with meshoptimizer and zstd");
    for (CLI::App* sub : {draco_app, meshopt_app}) {
        sub->add_option("IN", c.input, "Mesh")->required();
        sub->add_option("OUT", c.output, "File to write")->required();
        sub->add_option("--bits", c.bits, "Bits per coordinate")->check(CLI::Range(1, 16))->capture_default_str();
    }
    CLI::App* decode_app = app.add_subcommand("decode", "Decode a draco, meshopt or gim file to an .off");
    decode_app->add_option("IN", c.input, "File")->required();
    decode_app->add_option("OUT", c.output, "Mesh to write")->required();
    CLI::App* time_app = app.add_subcommand(
        "time", "Decode files in memory, in turns, on one thread. Print the median processor time as CSV");
    time_app->add_option("FILE", c.files, "Draco, meshopt or gim files")->required();
    time_app->add_option("--rounds", c.rounds, "How often each is decoded")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    if (simplify_app->parsed()) return simplify(c);
    if (draco_app->parsed()) return encode_with(c, encode_draco);
    if (meshopt_app->parsed()) return encode_with(c, encode_meshopt);
    if (decode_app->parsed()) return decode(c);
    return time_decoders(c);
}

}  // namespace
}  // namespace gim::rd

int main(int argc, char** argv) { return gim::rd::run(argc, argv); }
