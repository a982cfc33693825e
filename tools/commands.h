// The subcommands of the gim program. Each takes its parsed options and returns the exit status, 0 or 1. Results go to
// stdout, errors to stderr. A file name may be "-": standard input or output (named_file.h).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gim/cut.h"
#include "gim/emboss.h"
#include "gim/encoder.h"
#include "tools/input.h"
#include "tools/memory_budget.h"
#include "tools/named_file.h"

namespace gim {

struct EncodeCommand {
    std::string input, output;
    EncodeOptions options;
    std::string format;        // of the mesh: an extension; empty: what its content or name tells
    std::string json;          // file for the report; empty: none
    std::string debug_folder;  // empty: no pictures
    bool quiet = false;
    bool fallback = false;                       // GLB: also plain arrays, in a file of their own
    uint64_t max_memory = default_max_memory();  // for the mesh as read
    RasterOptions raster;                        // of an image
    std::string refit;                           // mesh to fit the samples of an image to; empty: they stay
};
int run_encode(const EncodeCommand& command);
// Encodes what was read, whatever kind it is.
Result<Encoded> encode_input(const Input& input, const EncodeOptions& options, const Progress& progress = {},
                             const Observer& observer = {});
// Encodes an image, with its samples fitted to the mesh.
Result<Encoded> refit_input(const Input& input, const TriangleMesh& mesh, const EncodeOptions& options,
                            const Progress& progress = {});
// If OUT is a GLB.
int run_encode_glb(const EncodeCommand& command);

struct BatchCommand {
    std::string inputs;    // list of paths, or folder
    std::string folder;    // takes the files, the manifest and the report
    EncodeCommand encode;  // without names of files
    std::string options;   // as the user gave them, without those that do not change the bytes
    uint32_t jobs = 1;     // files at a time
    uint32_t shard = 1, shards = 1;
    std::string log;          // file for the JSON lines; empty: stdout
    uint32_t thumbnail = 96;  // pixels per side; 0: none
    bool report_only = false;
    bool quiet = false;
};
// Returns 0: all done, 1: something failed, 128 + N: signal N asked to stop.
int run_batch(const BatchCommand& command);

struct DecodeCommand {
    std::string input, output;
    std::string format;  // an extension; empty: that of the output
    uint32_t level = 0;
    bool fused = false, split_sharp = false;
    bool plain = false;                 // without displacements
    std::string normal_map, color_map;  // .png or .exr to write; empty: none
};
int run_decode(const DecodeCommand& command);

struct CutCommand {
    std::string input, output;
    CutOptions options;
};
int run_cut(const CutCommand& command);

struct EmbossCommand {
    std::string input, output;
    std::string picture;
    EmbossOptions options;
    bool invert = false;  // dark is high
    bool json = false;
};
int run_emboss(const EmbossCommand& command);

struct BenchSceneCommand {
    std::string scene;
    std::string json;    // file for the figures; empty: none
    std::string frames;  // folder for pictures; empty: none
    bool draws = true, compares = true;
};
int run_bench_scene(const BenchSceneCommand& command);

struct InfoCommand {
    std::string input;
    bool json = false, clusters = false;
};
int run_info(const InfoCommand& command);

struct CompareCommand {
    std::string reference, test;
    std::string format;  // an extension, for surfaces whose names have none that gim knows; empty: their content tells
    CompareOptions options;
    uint32_t level = 0;
    bool json = false;
    uint64_t max_memory = default_max_memory();  // for each mesh as read
};
int run_compare(const CompareCommand& command);

struct RenderCommand {
    std::string input, output;
    std::string format;   // as in CompareCommand
    std::string gim;      // .gim file to draw beside the input; empty: only the input
    std::string defects;  // reference; defects of the surface against it are painted; empty: none
    uint32_t level = 0;
    uint32_t size = 512;  // pixels per side of a panel
    std::string up = "auto";
    double azimuth = 35, elevation = 20;  // degrees
    bool flat = false;
    bool wire = false;
    uint64_t max_memory = default_max_memory();  // for each mesh as read
};
int run_render(const RenderCommand& command);

struct ViewCommand {
    std::string input;     // .gim file; empty: none
    std::string original;  // mesh; empty: none
    std::string page;      // folder; empty: where it is installed or built
    uint16_t port = 0;     // 0: any
};
int run_view(const ViewCommand& command);

// Prints "gim: FILE: STAGE: message" on stderr; returns 1.
int report_error(const std::string& file, const Error& error);
// Prints "gim: FILE: warning: text" on stderr for each.
void print_warnings(const std::string& file, const std::vector<std::string>& warnings);
// Reads a surface as in tools/input.h. Prints its warnings.
Result<TriangleMesh> read_surface_aloud(const std::string& path, uint32_t level, const ReadOptions& options);
int report_error(const FileError& failure);

// Checks all files of a command before its work: no file has two names, each output can be written and is no companion
// of an input.
std::optional<FileError> check_files(std::span<const NamedFile> files);

// Flushes stdout. Returns the failure if anything printed so far is lost, as on a full disk.
std::optional<FileError> results_failure();

std::string with_thousands(uint64_t number);           // 34835 -> "34,835"
void print_line(const std::string& text);              // on stdout
std::string describe_folds(const Defects& defects);    // "12 triangles, 0.0123% of the area"
std::string describe_fold(const Defects::Fold& fold);  // "3 triangles near (x, y, z)"

// Runs the whole command line. Returns the exit status. 0: done, 1: the work failed, 2: wrong usage.
int run_gim(int argc, const char* const* argv);

}  // namespace gim
