// gim info: describes a .gim file and checks its bytes.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <set>

#include "gim/decoder.hpp"
#include "tools/cluster_report.h"
#include "tools/commands.h"
#include "tools/decoded.h"
#include "tools/file.h"
#include "tools/raster_file.h"
#include "tools/report_json.h"

namespace gim {
namespace {

using nlohmann::ordered_json;

struct Image {
    std::vector<DecoderLevel> levels;
    uint32_t paths = 0;
    std::vector<DecoderPlane> planes;
    uint32_t seam_points = 0;              // surface points on the ring of level 0, mates counted once
    std::vector<ClusterFigures> clusters;  // empty unless they are asked for and the layout has them
};

struct Description {
    gim_info info = {};
    uint64_t actual_size = 0;
    std::vector<Image> images;
    std::vector<gim_chunk> chunks;
    bool is_raster = false;             // the file holds an image of another program: it has no paths
    std::string imported;               // the type of its array
    uint32_t channels = 0;              // of that, besides the mask
    bool has_mask = false;              // not all samples are defined
    std::string text;                   // the file's note about itself; usually empty
    std::vector<std::string> problems;  // empty: the file is in order
};

const char* layout_name(uint32_t layout) {
    switch (layout) {
        case GIM_LAYOUT_GIM:
            return "gim";
        case GIM_LAYOUT_MCGIM:
            return "mcgim";
        case GIM_LAYOUT_TILES:
            return "tiles";
        default:
            return "unknown";
    }
}

// What the paths of a layout's seams are.
const char* paths_name(uint32_t layout) {
    switch (layout) {
        case GIM_LAYOUT_TILES:
            return "sides of tiles";
        case GIM_LAYOUT_MCGIM:
            return "paths on borders of charts";
        default:
            return "cut paths";
    }
}

const char* coding_name(uint32_t coding) { return coding == GIM_CODING_LOSSLESS ? "lossless" : "lossy"; }

const char* plane_name(uint32_t kind) {
    constexpr const char* kNames[] = {"normals", "colors", "displacements"};
    return kNames[kind];
}

void add_raster(const Bytes& file, Description& d) {
    constexpr const char* kTypes[] = {"float32", "float64", "float16", "uint8", "int8",
                                      "uint16",  "int16",   "uint32",  "int32"};
    const Result<RasterImage> image = decode_raster_image(file);
    if (!image.ok()) {
        d.problems.push_back("decoding fails: " + image.error().message);
        return;
    }
    d.imported = kTypes[static_cast<size_t>(image.value().type)];
    d.channels = image.value().channels;
    d.has_mask = std::count(image.value().defined.begin(), image.value().defined.end(), 0) > 0;
}

void add_image(const Decoder& decoder, uint32_t index, Description& d) {
    const std::string name = "image " + std::to_string(index);
    Image image;
    DecoderLevel shape;
    gim_status status = GIM_OK;
    for (uint32_t level = 0; level < d.info.level_count; ++level) {
        status = decoder.read_level(index, level, &shape);
        if (status != GIM_OK) break;
        image.levels.push_back(shape);
    }
    if (status != GIM_OK && status != GIM_NO_SUCH_LEVEL) d.problems.push_back(name + ": " + describe_status(status));
    if (!image.levels.empty()) {
        const DecoderLevel& full = image.levels[0];
        // Charts have no ring.
        std::vector<uint32_t> class_of(full.side > 0 ? size_t{4} * (full.side - 1) : 0);
        status = decoder.seams(full, class_of, &image.paths);
        if (status != GIM_OK) d.problems.push_back(name + ", seams: " + describe_status(status));
        image.seam_points = static_cast<uint32_t>(std::set<uint32_t>(class_of.begin(), class_of.end()).size());
    }
    for (const uint32_t kind : {GIM_PLANE_NORMALS, GIM_PLANE_COLORS, GIM_PLANE_DISPLACEMENTS}) {
        DecoderPlane plane;
        status = decoder.read_plane(index, kind, 0, &plane);
        if (status == GIM_NO_SUCH_PLANE) continue;
        if (status != GIM_OK) d.problems.push_back(name + ", " + plane_name(kind) + ": " + describe_status(status));
        if (status == GIM_OK) image.planes.push_back(plane);
    }
    d.images.push_back(std::move(image));
}

constexpr uint64_t kMostText = 1 << 20;

void add_text(Decoder& decoder, Description& d) {
    uint64_t size = 0;
    gim_status status = decoder.read_text_size(&size);
    if (status == GIM_OK && size > kMostText) {
        d.problems.push_back("its text claims " + std::to_string(size) + " bytes; gim reads at most 1 MiB of text");
        return;
    }
    if (status == GIM_OK && size > 0) {
        d.text.resize(size);
        status = decoder.text(d.text);
    }
    // The text comes from strangers. It must not control the terminal.
    for (char& c : d.text) {
        if ((static_cast<unsigned char>(c) < 0x20 && c != '\n') || c == 0x7F) c = '?';
    }
    if (status != GIM_OK) {
        d.text.clear();
        d.problems.push_back("its text: " + describe_status(status));
    }
}

Result<Description> describe(const Bytes& file) {
    Description d;
    Decoder decoder;
    const gim_status status = decoder.open(file);
    if (status != GIM_OK) return Error{Stage::kInput, describe_status(status)};
    d.info = decoder.info();
    d.actual_size = file.size();
    for (uint32_t i = 0; i < d.info.image_count; ++i) add_image(decoder, i, d);

    uint32_t damaged = 0;
    gim_chunk chunk;
    for (uint32_t i = 0; decoder.read_chunk(i, &chunk) == GIM_OK; ++i) {
        damaged += chunk.intact == 0 ? 1 : 0;
        d.chunks.push_back(chunk);
    }
    if (damaged > 0) {
        d.problems.push_back(std::to_string(damaged) + " of " + std::to_string(d.chunks.size()) +
                             " chunks are damaged or missing; get a fresh copy");
    }
    if (d.actual_size != d.info.file_size) {
        d.problems.push_back("the index counts " + std::to_string(d.info.file_size) + " bytes, but the file has " +
                             std::to_string(d.actual_size));
    }
    if (damaged == 0) add_text(decoder, d);
    if (d.problems.empty()) {
        const Result<std::vector<DecodedImage>> decoded = decode_images(file, 0);
        if (!decoded.ok()) d.problems.push_back("decoding fails: " + decoded.error().message);
    }
    d.is_raster = holds_raster(file);
    if (d.problems.empty() && d.is_raster) add_raster(file, d);
    return d;
}

void add_clusters(const Bytes& file, Description& d) {
    for (uint32_t i = 0; i < d.info.image_count && d.info.layout != GIM_LAYOUT_MCGIM; ++i) {
        std::vector<ClusterFigures>& figures = d.images[i].clusters;
        const gim_status status = measure_clusters(d.info, file, i, &figures);
        if (status == GIM_OK || status == GIM_NO_SUCH_LEVEL) continue;
        figures.clear();
        d.problems.push_back("clusters of image " + std::to_string(i) + ": " + describe_status(status));
    }
}

// Levels whose errors the file tells; they are the finest ones.
uint32_t told_levels(const gim_info& info) {
    uint32_t count = 0;
    while (count < info.level_count && info.level_rms_error[count] > 0) ++count;
    return count;
}

// PSNR against the diagonal of the box. The input's own diagonal is not in the file; the two differ by about 1 %.
double psnr_of(const gim_info& info, uint32_t level) {
    double sum = 0;
    for (size_t k = 0; k < 3; ++k) sum += std::pow(double{info.box.high[k]} - double{info.box.low[k]}, 2);
    return 20 * std::log10(std::sqrt(sum) / double{info.level_rms_error[level]});
}

ordered_json to_json(const gim_box& box) { return {{"low", box.low}, {"high", box.high}}; }

// The memory that a program needs to decode a level into positions, normals and triangles: output and scratch.
uint64_t decode_bytes(const DecoderLevel& level) {
    return level.scratch_size + uint64_t{level.vertex_count} * 6 * sizeof(float) +
           uint64_t{level.triangle_count} * 3 * sizeof(uint32_t);
}

double bits_per_sample(const gim_info& info) {
    return info.sample_count == 0 ? 0
                                  : 8.0 * static_cast<double>(info.file_size) / static_cast<double>(info.sample_count);
}

void print_json(const std::string& path, const Description& d) {
    ordered_json images = ordered_json::array();
    for (const Image& image : d.images) {
        ordered_json levels = ordered_json::array();
        for (const DecoderLevel& level : image.levels) {
            levels.push_back({{"level", level.level},
                              {"width", level.width},
                              {"height", level.height},
                              {"vertices", level.vertex_count},
                              {"triangles", level.triangle_count},
                              {"prefix_bytes", level.prefix_size},
                              {"scratch_bytes", level.scratch_size},
                              {"decode_bytes", decode_bytes(level)}});
        }
        ordered_json planes = ordered_json::array();
        for (const DecoderPlane& plane : image.planes) {
            planes.push_back({{"kind", plane_name(plane.kind)},
                              {"width", plane.width},
                              {"height", plane.height},
                              {"bytes", plane.stream_size},
                              {"quantizer", plane.quantizer}});
        }
        ordered_json entry;
        if (!d.is_raster) entry = {{"paths", image.paths}, {"seam_points", image.seam_points}};
        entry["levels"] = levels;
        entry["planes"] = planes;
        if (d.info.has_boxes != 0 && !image.levels.empty()) entry["box"] = to_json(image.levels[0].box);
        if (!image.clusters.empty()) entry["clusters"] = to_json(image.clusters);
        images.push_back(entry);
    }
    ordered_json chunks = ordered_json::array();
    for (const gim_chunk& chunk : d.chunks) {
        ordered_json entry = {{"name", chunk.name},
                              {"offset", chunk.offset},
                              {"bytes", chunk.size},
                              {"raw_bytes", chunk.raw_size},
                              {"intact", chunk.intact != 0}};
        if (chunk.level >= 0) entry["level"] = chunk.level;
        chunks.push_back(entry);
    }
    ordered_json rms = ordered_json::array(), largest = ordered_json::array(), psnr = ordered_json::array();
    for (uint32_t level = 0; level < told_levels(d.info); ++level) {
        rms.push_back(d.info.level_rms_error[level]);
        largest.push_back(d.info.level_max_error[level]);
        if (d.info.has_boxes != 0) psnr.push_back(psnr_of(d.info, level));
    }
    ordered_json document = {{"file", path},
                             {"version", d.info.version},
                             {"layout", layout_name(d.info.layout)},
                             {"coding", coding_name(d.info.coding)},
                             {"bits", d.info.bits},
                             {"step", d.info.step},
                             {"quantizer", d.info.quantizer},
                             {"origin", {d.info.origin[0], d.info.origin[1], d.info.origin[2]}},
                             {"relative", d.info.is_relative != 0},
                             {"bytes", d.actual_size},
                             {"index_bytes", d.info.index_size},
                             {"samples", d.info.sample_count},
                             {"bits_per_sample", bits_per_sample(d.info)},
                             {"level_count", d.info.level_count},
                             {"level_rms_error", rms},
                             {"level_max_error", largest},
                             {"level_psnr", psnr},
                             {"images", images},
                             {"chunks", chunks},
                             {"text", d.text},
                             {"problems", d.problems},
                             {"intact", d.problems.empty()}};
    if (!d.imported.empty()) document["imported"] = {{"type", d.imported}, {"channels", d.channels}};
    if (d.info.has_boxes != 0) document["box"] = to_json(d.info.box);
    std::fputs(json_text(document).c_str(), stdout);
}

void print_bounds(const gim_info& info) {
    if (info.has_boxes != 0) {
        const auto& [low, high] = info.box;
        std::printf("  box %.6g, %.6g, %.6g to %.6g, %.6g, %.6g\n", double{low[0]}, double{low[1]}, double{low[2]},
                    double{high[0]}, double{high[1]}, double{high[2]});
    }
    if (told_levels(info) == 0) return;
    std::printf("  errors in object units, measured by the encoder\n  level          RMS      largest   about\n");
    for (uint32_t level = 0; level < told_levels(info); ++level) {
        std::printf("  %5u  %11.5g  %11.5g", level, double{info.level_rms_error[level]},
                    double{info.level_max_error[level]});
        std::printf(info.has_boxes != 0 ? "  %5.1f dB\n" : "\n", info.has_boxes != 0 ? psnr_of(info, level) : 0.0);
    }
}

void print_text(const std::string& path, const Description& d) {
    const gim_info& info = d.info;
    std::printf("%s\n", path.c_str());
    std::printf("  layout %s, %s, %u bits per coordinate, step %.6g, format version %u\n", layout_name(info.layout),
                coding_name(info.coding), info.bits, static_cast<double>(info.step), info.version);
    std::printf("  %s bytes, %u image%s, %s samples, %.3f bits per sample\n", with_thousands(d.actual_size).c_str(),
                info.image_count, info.image_count == 1 ? "" : "s", with_thousands(info.sample_count).c_str(),
                bits_per_sample(info));
    std::printf("  origin %.17g, %.17g, %.17g (%s)\n", info.origin[0], info.origin[1], info.origin[2],
                info.is_relative != 0 ? "binary64; decoded positions are relative to it" : "binary32");
    print_bounds(info);
    if (!d.imported.empty())
        std::printf("  imported image: %s, %u channels%s\n", d.imported.c_str(), d.channels,
                    d.has_mask ? " and a mask" : "");
    for (size_t i = 0; i < d.images.size(); ++i) {
        const Image& image = d.images[i];
        std::printf("image %zu", i);
        if (!d.is_raster) std::printf(": %u %s", image.paths, paths_name(info.layout));
        if (image.seam_points > 0) std::printf(", %u surface points on the ring", image.seam_points);
        std::printf("\n  level         size   vertices  triangles   bytes needed  memory to decode\n");
        for (const DecoderLevel& level : image.levels) {
            std::printf("  %5u  %5u x %4u  %9u  %9u  %13llu  %16s\n", level.level, level.width, level.height,
                        level.vertex_count, level.triangle_count, static_cast<unsigned long long>(level.prefix_size),
                        with_thousands(decode_bytes(level)).c_str());
        }
    }
    for (size_t i = 0; i < d.images.size(); ++i) {
        for (const DecoderPlane& plane : d.images[i].planes) {
            std::printf("image %zu, %s: %u x %u, %llu bytes, quantizer %g\n", i, plane_name(plane.kind), plane.width,
                        plane.height, static_cast<unsigned long long>(plane.stream_size),
                        static_cast<double>(plane.quantizer));
        }
    }
    for (uint32_t i = 0; i < d.images.size(); ++i) {
        if (!d.images[i].clusters.empty()) print_clusters(i, d.images[i].clusters);
    }
    std::printf("chunks\n");
    for (const gim_chunk& chunk : d.chunks) {
        std::printf("  %-8s", chunk.name);
        if (chunk.level >= 0) {
            std::printf("  level %2d", chunk.level);
        } else {
            std::printf("          ");
        }
        std::printf("  offset %10llu  bytes %9llu  %s\n", static_cast<unsigned long long>(chunk.offset),
                    static_cast<unsigned long long>(chunk.size), chunk.intact != 0 ? "intact" : "DAMAGED OR MISSING");
    }
    if (!d.text.empty()) std::printf("text\n  %s\n", d.text.c_str());
    std::printf("checks: %s\n",
                d.problems.empty() ? "all chunks intact, decodes at full resolution" : "FAILED, see stderr");
}

}  // namespace

int run_info(const InfoCommand& command) {
    const std::string name = shown_name(command.input, Direction::kRead);
    const Result<Bytes> file = read_named(command.input);
    if (!file.ok()) return report_error(name, file.error());
    Result<Description> described = describe(file.value());
    if (!described.ok()) return report_error(name, described.error());
    Description& description = described.value();
    if (command.clusters && description.problems.empty()) add_clusters(file.value(), description);
    command.json ? print_json(command.input, description) : print_text(name, description);

    int exit_status = 0;
    for (const std::string& problem : description.problems) {
        exit_status = report_error(name, {Stage::kInput, problem});
    }
    return exit_status;
}

}  // namespace gim
