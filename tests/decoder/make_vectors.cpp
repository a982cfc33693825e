// Writes the conformance vectors: make_vectors FOLDER fills FOLDER/valid and FOLDER/invalid anew.
// No test runs it: the files are committed. If they change, the format has changed.
// Positions are integers made here, so that the files do not depend on a machine's floating point.
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>

#include "encoder/charts/write_charts.h"
#include "encoder/code/assemble_file.h"
#include "encoder/code/code_bands.h"
#include "encoder/code/file_units.h"
#include "encoder/code/measure_boxes.h"
#include "encoder/code/wavelet_analysis.h"
#include "encoder/planes/labels.h"
#include "encoder/raster/write_raster.h"
#include "encoder/squares/write_squares.h"
#include "encoder/tiles/tile_plane.h"
#include "encoder/tiles/write_tiles.h"
#include "format/checksum.h"
#include "format/plane_code.h"
#include "format/raster_table.h"
#include "format/seam.h"
#include "format/sideband_code.h"
#include "format/tile_atlas.h"
#include "gim/cut.h"
#include "tests/decoder/vectors.h"
#include "tests/encoder/charts/made_charts.h"
#include "tests/encoder/raster/made_rasters.h"
#include "tests/encoder/tiles/made_tiles.h"
#include "tests/format/random_sideband.h"
#include "tests/format/raw_chart_table.h"

namespace gim {
namespace {

using namespace gim::test;
namespace fs = std::filesystem;
using Bytes = std::vector<uint8_t>;

// ---- sidebands ------------------------------------------------------------------------------------------------------

Sideband open_square() { return {2, 0, {}}; }
// Every side is folded at its middle: genus 0, the corners are one point.
Sideband folded_sides() { return {3, 0, {{1, 1}, {0, 1}, {3, 1}, {2, 1}, {5, 1}, {4, 1}, {7, 1}, {6, 1}}}; }
// Opposite sides are one: genus 1.
Sideband torus() { return {3, 0, {{2, 2}, {3, 2}, {0, 2}, {1, 2}}}; }
// Two opposite sides are one, the others stay: a tube.
Sideband tube() { return {3, 0, {{2, 2}, {kNoMate, 2}, {0, 2}, {kNoMate, 2}}}; }

// ---- images ---------------------------------------------------------------------------------------------------------

// A smooth hill of integers with noise of 0 .. noise-1. Both sides of every seam are equal.
SquareImage hill(uint32_t side, Sideband sideband, uint32_t noise, uint32_t seed) {
    SquareGrid image{side, {}};
    Random random(seed);
    const uint32_t last = side - 1, cell = 1024 / last;
    for (uint32_t r = 0; r < side; ++r) {
        for (uint32_t c = 0; c < side; ++c) {
            const uint32_t u = c * cell, v = r * cell;
            const uint32_t height = u * (1024 - u) / 64 * (v * (1024 - v) / 64) / 16384;
            const auto with_noise = [&](uint32_t x) {
                return static_cast<double>(x + (noise ? random.below(noise) : 0));
            };
            const double x = with_noise(u * 3), y = with_noise(v * 2 + u * u / 2048), z = with_noise(height);
            image.positions.emplace_back(x, y, z);
        }
    }
    SeamTable seams;
    if (build_seam_table(sideband, &seams) != Status::kOk) std::abort();
    std::vector<uint32_t> class_of(ring_length(side)), first(ring_length(side), UINT32_MAX);
    ring_classes(seams, side, class_of);
    for (uint32_t k = 0; k < class_of.size(); ++k) {
        if (first[class_of[k]] == UINT32_MAX) first[class_of[k]] = k;
        const GridPoint to = ring_point(side, k), from = ring_point(side, first[class_of[k]]);
        image.at(to.row, to.column) = image.at(from.row, from.column);
    }
    return glue_square(std::move(image), std::move(sideband)).value();
}

CodingParameters lossless(uint32_t bits, uint32_t base_side) {
    CodingParameters p;
    p.bits = bits;
    p.base_side = base_side;
    return p;
}
CodingParameters lossy(uint32_t bits, uint32_t base_side, double quantizer) {
    CodingParameters p = lossless(bits, base_side);
    p.lossless = false;
    p.quantizer = quantizer;
    return p;
}

Bytes encode(const std::vector<SquareImage>& images, const CodingParameters& parameters) {
    auto file = write_squares(images, parameters);
    if (!file.ok()) {
        std::fprintf(stderr, "side %u: %s\n", images[0].side(), file.error().message.c_str());
        std::abort();
    }
    return file.value();
}

// A search with floats chooses the values of undefined samples. On another machine these bytes may differ.
Bytes encode_charts(const ChartLevels& charts, const CodingParameters& parameters) {
    auto writer = charts_writer(charts, parameters);
    if (!writer.ok()) {
        std::fprintf(stderr, "charts: %s\n", writer.error().message.c_str());
        std::abort();
    }
    return writer.value().write(parameters.quantizer);
}

// Tiles that are bilinear between integer corners, with noise of 0 .. noise-1.
TileImage tiles(const MadeQuads& made, uint32_t exponent, uint32_t noise, uint32_t seed) {
    MadeQuads integers = made;
    for (uint32_t v = 0; v < made.corners.size(); ++v)
        integers.corners[v] = 1024 * Vec3(v * 37 % 16, v * 59 % 16 + v / 4, v * 23 % 16);
    TileImage image = bilinear_tiles(integers, exponent);
    Random random(seed);
    for (Vec3& p : image.positions)
        for (int k = 0; k < 3; ++k) p[k] = std::floor(p[k]) + (noise > 0 ? random.below(noise) : 0);
    return image;
}

Bytes encode_tiles(const TileImage& image, const CodingParameters& parameters) {
    auto file = write_tiles(image, parameters);
    if (!file.ok()) {
        std::fprintf(stderr, "tiles: %s\n", file.error().message.c_str());
        std::abort();
    }
    return file.value();
}

// An attribute plane of integers: a slope in the first component, a hill and stripes in the others.
Bytes plane(const std::vector<uint32_t>& sides, float quantizer, float first) {
    Bytes exponents;
    std::vector<Bytes> streams;
    for (const uint32_t side : sides) {
        std::vector<float> values;
        for (uint32_t r = 0; r < side; ++r) {
            for (uint32_t c = 0; c < side; ++c) {
                const uint32_t last = side - 1, u = c * 256 / last, v = r * 256 / last;
                values.push_back(first + static_cast<float>(u / 4 + v / 2));
                values.push_back(static_cast<float>(u * (256 - u) / 256 * v / 128) - 32.0f);
                values.push_back(static_cast<float>(u / 32 % 2 * 24) - 12.0f);
            }
        }
        Pyramid<int32_t> bands = quantize_bands(analyse<Irreversible97>(std::move(values), side), {quantizer}).bands;
        streams.push_back(code_bands(bands, 1, CoefficientKind::kPlanes)[0]);
        uint8_t j = 0;
        while ((1u << j) + 1 < side) ++j;
        exponents.push_back(j);
    }
    return serialize_plane(quantizer, exponents, streams);
}

// The same on a rectangle.
std::vector<float> plane_values(uint32_t columns, uint32_t rows, float first) {
    std::vector<float> values;
    for (uint32_t r = 0; r < rows; ++r) {
        for (uint32_t c = 0; c < columns; ++c) {
            values.push_back(first + static_cast<float>(3 * c + 5 * r));
            values.push_back(static_cast<float>((c * c + 3 * r) % 64));
            values.push_back(static_cast<float>(r / 4 % 2 * 24) - 12.0f);
        }
    }
    return values;
}

// On charts: 2^exponent texels per sample and direction.
Bytes chart_plane(uint32_t width, uint32_t height, uint8_t exponent, float quantizer, float first) {
    const uint32_t columns = ((width - 1) << exponent) + 1, rows = ((height - 1) << exponent) + 1;
    const Pyramid<float> analysed =
        analyse<Irreversible97>(plane_values(columns, rows, first), columns, rows, halvings(columns, rows));
    Pyramid<int32_t> bands = quantize_bands(analysed, {quantizer}).bands;
    return serialize_plane(quantizer, Bytes{exponent}, code_bands(bands, 1, CoefficientKind::kPlanes));
}

// On tiles: likewise. Texels on the sides of tiles get the mean of their copies.
Bytes tile_plane(const TileImage& image, uint8_t exponent, float quantizer, float first) {
    const TileAtlas atlas(static_cast<uint32_t>(image.quads.size()), 1u << image.exponent);
    const TexelGrid grid = {((atlas.width() - 1) << exponent) + 1, ((atlas.height() - 1) << exponent) + 1, {}};
    const PlaneCoder coder = tile_plane_coder(image, grid, plane_values(grid.columns, grid.rows, first));
    return serialize_plane(quantizer, Bytes{exponent}, std::vector<Bytes>{coder(quantizer)});
}

// ---- files in parts -------------------------------------------------------------------------------------------------

struct Parts {
    Header header;
    Bytes exponents;
    std::vector<Chunk> chunks;
    std::vector<Bytes> payloads;
};

Parts take_apart(const Bytes& file) {
    Parts parts;
    if (parse_header(file, {}, &parts.header) != Status::kOk) std::abort();
    parts.exponents.assign(parts.header.side_exponents.begin(), parts.header.side_exponents.end());
    ChunkWalk walk(parts.header);
    Chunk chunk;
    for (uint64_t offset = 0; walk.next(&chunk, &offset);) {
        const auto begin = file.begin() + static_cast<ptrdiff_t>(offset);
        parts.chunks.push_back(chunk);
        parts.payloads.emplace_back(begin, begin + static_cast<ptrdiff_t>(chunk.size));
    }
    return parts;
}

// Corrects sizes and checksums.
Bytes put_together(Parts parts) {
    parts.header.side_exponents = parts.exponents;
    for (size_t i = 0; i < parts.chunks.size(); ++i) {
        parts.chunks[i].size = parts.payloads[i].size();
        parts.chunks[i].crc = crc16(parts.payloads[i]);
    }
    Bytes file = serialize_header(parts.header, parts.chunks);
    for (const Bytes& p : parts.payloads) file.insert(file.end(), p.begin(), p.end());
    return file;
}

void insert_chunk(Parts* parts, size_t at, uint32_t type, bool optional, Bytes payload) {
    Chunk chunk;
    chunk.type = static_cast<ChunkType>(type);
    chunk.optional = optional;
    parts->chunks.insert(parts->chunks.begin() + static_cast<ptrdiff_t>(at), chunk);
    parts->payloads.insert(parts->payloads.begin() + static_cast<ptrdiff_t>(at), std::move(payload));
}

void remove_chunk(Parts* parts, size_t at) {
    parts->chunks.erase(parts->chunks.begin() + static_cast<ptrdiff_t>(at));
    parts->payloads.erase(parts->payloads.begin() + static_cast<ptrdiff_t>(at));
}

Bytes with_parts(const Bytes& file, const std::function<void(Parts&)>& change) {
    Parts parts = take_apart(file);
    change(parts);
    return put_together(std::move(parts));
}

// Changes bytes of header and index by hand, then corrects the checksum. Keeps index_size.
Bytes with_index_bytes(Bytes file, const std::function<void(Bytes&)>& change) {
    const uint32_t size = take_apart(file).header.index_size;
    change(file);
    const uint32_t crc = crc32(std::span(file).first(size - 4));
    for (uint32_t i = 0; i < 4; ++i) file[size - 4 + i] = static_cast<uint8_t>(crc >> 8 * i);
    return file;
}

// Gives a file a binary64 origin that binary32 cannot hold.
Bytes far_away(const Bytes& file) {
    return with_parts(file, [](Parts& p) { p.header.wide_origin = {500000.1, -4000000.3, 0x1p100}; });
}

Bytes cut_levels(const Bytes& file, uint32_t level) {
    CutOptions options;
    options.level = level;
    auto made = cut(file, options);
    if (!made.ok()) {
        std::fprintf(stderr, "cut: %s\n", made.error().message.c_str());
        std::abort();
    }
    return made.value().bytes;
}

// Gives the cells of a file labels: rings, with lonely cells of any label.
Bytes labelled(const Bytes& file, uint32_t cells, uint32_t width) {
    Random random(cells);
    Bytes labels;
    for (uint32_t i = 0; i < cells; ++i) {
        const uint32_t r = i / width % width, c = i % width;
        const uint32_t from_side = std::min({r, c, width - 1 - r, width - 1 - c});
        labels.push_back(static_cast<uint8_t>(random.below(20) == 0 ? random.below(256) : from_side));
    }
    auto made = with_labels(file, labels);
    if (!made.ok()) {
        std::fprintf(stderr, "labels: %s\n", made.error().message.c_str());
        std::abort();
    }
    return made.value();
}

Bytes with_boxes(const Bytes& file) {
    auto boxes = measure_boxes(file);
    if (!boxes.ok()) {
        std::fprintf(stderr, "boxes: %s\n", boxes.error().message.c_str());
        std::abort();
    }
    return set_boxes(file, boxes.value());
}

// ---- output ---------------------------------------------------------------------------------------------------------

void write_bytes(const fs::path& path, const Bytes& bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

class Writer {
  public:
    explicit Writer(fs::path folder) : folder_(std::move(folder)) {}

    void valid(const std::string& name, const Bytes& file) {
        const Decoded decoded = decode_all(file);
        report(name, file, decoded.status == GIM_OK, decoded.status);
        write_bytes(folder_ / "valid" / (name + ".gim"), file);
        write_bytes(folder_ / "valid" / (name + ".f32"), to_bytes(decoded.samples));
        write_bytes(folder_ / "valid" / (name + ".tri"), to_bytes(decoded.triangles));
        write_bytes(folder_ / "valid" / (name + ".vtx"), to_bytes(decoded.vertices));
        if (!decoded.planes.empty()) write_bytes(folder_ / "valid" / (name + ".pln"), to_bytes(decoded.planes));
        if (!decoded.details.empty()) write_bytes(folder_ / "valid" / (name + ".dsp"), to_bytes(decoded.details));
        if (!decoded.labels.empty()) write_bytes(folder_ / "valid" / (name + ".lbl"), decoded.labels);
        if (!decoded.raster.empty()) write_bytes(folder_ / "valid" / (name + ".ras"), to_bytes(decoded.raster));
        if (!decoded.bounds.empty()) write_bytes(folder_ / "valid" / (name + ".bnd"), to_bytes(decoded.bounds));
    }
    void invalid(const std::string& name, const Bytes& file) {
        const gim_status status = decode_all(file).status;
        report(name, file, status == status_of_name(name), status);
        write_bytes(folder_ / "invalid" / (name + ".gim"), file);
    }
    bool fine() const { return fine_; }

  private:
    void report(const std::string& name, const Bytes& file, bool as_named, gim_status status) {
        std::printf("%-50s %6zu bytes%s\n", name.c_str(), file.size(), as_named ? "" : "  NOT AS NAMED");
        if (!as_named) std::printf("    status %d: %s\n", status, gim_status_text(status));
        fine_ = fine_ && as_named;
    }

    fs::path folder_;
    bool fine_ = true;
};

void write_valid(Writer& out) {
    out.valid("open-5-lossless", encode({hill(5, open_square(), 0, 1)}, lossless(8, 3)));
    out.valid("open-3-lossy", encode({hill(3, open_square(), 0, 1)}, lossy(12, 3, 4)));
    out.valid("sphere-17-lossless", encode({hill(17, folded_sides(), 9, 2)}, lossless(12, 5)));
    out.valid("sphere-33-lossy", encode({hill(33, folded_sides(), 5, 3)}, lossy(12, 9, 4)));
    out.valid("torus-17-lossless", encode({hill(17, torus(), 40, 4)}, lossless(12, 3)));
    out.valid("torus-33-lossy", encode({hill(33, torus(), 3, 5)}, lossy(14, 5, 20)));
    // A stream without bytes is valid: it has empty blocks only.
    out.valid("empty-finest-level", with_parts(encode({hill(17, torus(), 40, 4)}, lossless(12, 3)),
                                               [](Parts& p) { p.payloads.back().clear(); }));
    out.valid("tube-9-lossless", encode({hill(9, tube(), 3, 6)}, lossless(10, 9)));
    out.valid("tube-33-lossy-coarse", encode({hill(33, tube(), 0, 7)}, lossy(12, 9, 500)));
    out.valid("noise-17-lossless-20-bits", encode({hill(17, open_square(), 1u << 22, 8)}, lossless(20, 5)));
    out.valid("two-images-lossless",
              encode({hill(5, open_square(), 7, 9), hill(17, folded_sides(), 7, 10)}, lossless(12, 5)));
    out.valid("two-images-lossy", encode({hill(33, folded_sides(), 2, 11), hill(9, tube(), 2, 12)}, lossy(12, 5, 6)));
    Random random(13);
    for (uint32_t genus = 2; genus <= 3; ++genus) {
        Sideband s = random_sideband(random, 17, 2 * genus, 1, false);
        s.start = 3 + genus;
        out.valid("schema-33-lossy-" + std::to_string(genus), encode({hill(33, s, 6, 14)}, lossy(12, 17, 5)));
    }

    // No frames; then the same integers in frames without areas, and with steps as far apart as possible.
    const SquareImage folded = hill(33, folded_sides(), 5, 3);
    const Bytes framed = encode({folded}, lossy(12, 9, 4));
    out.valid("frames-none", with_parts(framed, [&](Parts& p) {
                  p.header.tangential = p.header.cell_area = 0;
                  Pyramid<float> pyramid =
                      analyse<Irreversible97>(to_units<float>(folded.positions, p.header), folded.side());
                  subtract_middle(&pyramid, p.header.bits);
                  Pyramid<int32_t> bands = quantize_bands(pyramid, {p.header.quantizer}).bands;
                  std::vector<Bytes> streams = code_bands(bands, p.header.level_count);
                  std::copy(streams.begin(), streams.end(), p.payloads.begin() + 1);
              }));
    const auto with_frames = [&](uint8_t tangential, uint8_t cell_area) {
        return with_parts(framed, [&](Parts& p) { p.header.tangential = tangential, p.header.cell_area = cell_area; });
    };
    out.valid("frames-without-area", with_frames(24, 0));
    out.valid("frames-wide-steps", with_frames(255, 255));
    out.valid("frames-narrow-steps", with_frames(1, 1));
    // A surface that is a line has no normals.
    SquareImage line = hill(33, open_square(), 64, 18);
    for (Vec3& p : line.positions) p.y() = p.z() = 0;
    out.valid("frames-of-a-line", encode({line}, lossy(12, 9, 4)));

    CodingParameters measured = lossy(12, 5, 6);
    measured.bounds = true;
    const std::vector<LevelError> errors = {{0.25, 3.75}, {0, 0x1p40}, {}};
    const Bytes bounded = set_level_errors(encode({hill(17, folded_sides(), 2, 15)}, measured), errors);
    out.valid("bounds", with_boxes(bounded));
    out.valid("bounds-without-boxes", bounded);
    out.valid("bounds-two-images",
              with_boxes(encode({hill(33, folded_sides(), 2, 11), hill(9, tube(), 2, 12)}, measured)));
    out.valid("bounds-wide-origin", with_boxes(far_away(bounded)));
    // Without their finest levels.
    const Bytes both = encode({hill(33, folded_sides(), 2, 11), hill(17, tube(), 2, 12)}, measured);
    out.valid("cut-two-images", cut_levels(with_boxes(both), 1));
    out.valid("cut-charts", cut_levels(encode_charts(open_sheet(2), lossy(12, 3, 25)), 1));
    out.valid("cut-tiles", cut_levels(encode_tiles(tiles(cube(), 3, 9, 3), lossless(12, 3)), 2));
    // The same samples as in the files without "wide-origin", far from 0.
    out.valid("wide-origin-lossless", far_away(encode({hill(17, folded_sides(), 9, 2)}, lossless(12, 5))));
    out.valid("wide-origin-two-images-lossy",
              far_away(encode({hill(33, folded_sides(), 2, 11), hill(9, tube(), 2, 12)}, lossy(12, 5, 6))));
    // Planes finer and coarser than the image; the text may come last.
    CodingParameters planes = lossy(12, 9, 30);
    planes.planes = {{ChunkType::kNormals, plane({33}, 48, 200)}, {ChunkType::kColors, plane({9}, 6, 20)}};
    planes.text = "with planes";
    out.valid("planes-sphere-17", encode({hill(17, folded_sides(), 0, 15)}, planes));
    planes = lossy(10, 5, 30);
    planes.planes = {{ChunkType::kColors, plane({17, 5}, 20, -100)}};
    out.valid("planes-two-images", encode({hill(9, tube(), 0, 16), hill(5, open_square(), 0, 17)}, planes));

    planes = lossy(12, 9, 30);
    planes.planes = {{ChunkType::kDisplacements, plane({33}, 4, 40)}};
    out.valid("displaced-sphere-17", encode({hill(17, folded_sides(), 0, 15)}, planes));
    // One image whose plane is too coarse to be details, and one whose plane is as fine as its samples.
    planes = lossy(10, 5, 30);
    planes.planes = {{ChunkType::kDisplacements, plane({5, 5}, 20, -100)}};
    out.valid("displaced-two-images", encode({hill(9, tube(), 0, 16), hill(5, open_square(), 0, 17)}, planes));

    CodingParameters text = lossless(8, 3);
    text.text = "a short text";
    out.valid("text-plain", encode({hill(5, open_square(), 0, 1)}, text));
    text.text.clear();
    for (int i = 0; i < 20; ++i) text.text += "the same words again and again; ";
    out.valid("text-zstd", encode({hill(5, open_square(), 0, 1)}, text));
    out.valid("unknown-optional-chunks",
              with_parts(encode({hill(5, open_square(), 0, 1)}, lossless(8, 3)), [](Parts& p) {
                  insert_chunk(&p, 0, 77, true, {1, 2, 3});
                  insert_chunk(&p, 2, (1u << 30) - 1, true, {});
                  p.chunks[0].zstd = true;  // it is skipped, whatever it holds
                  p.chunks[0].raw_size = 1u << 20;
              }));
}

// The encoder made this: gim encode --layout mcgim --charts 4 --samples 1500 of a torus of 24 x 12 quads. The bytes
// stay even if the encoder changes.
Bytes kept_vector(const fs::path& folder) { return read_bytes(folder / "valid/charts-encoder-lossy.gim"); }

void write_valid_charts(Writer& out, const Bytes& kept) {
    out.valid("charts-pillow-lossless", encode_charts(pillow(5, 5, 2), lossless(10, 3)));
    out.valid("charts-pillow-lossy", encode_charts(pillow(8, 8, 3), lossy(12, 3, 6)));
    out.valid("charts-unequal-lossless", encode_charts(pillow(8, 6, 2), lossless(12, 3)));
    out.valid("charts-unequal-lossy", encode_charts(pillow(9, 6, 2), lossy(12, 3, 40)));
    out.valid("charts-open-lossless", encode_charts(open_sheet(2), lossless(9, 3)));
    out.valid("charts-open-lossy", encode_charts(open_sheet(2), lossy(12, 3, 25)));
    out.valid("charts-torus-lossless", encode_charts(torus_of_one_chart(17, 3), lossless(12, 3)));
    out.valid("charts-torus-lossy", encode_charts(torus_of_one_chart(33, 3), lossy(12, 3, 30)));
    out.valid("wide-origin-charts-lossy", far_away(encode_charts(open_sheet(2), lossy(12, 3, 25))));
    // Boxes that no wavelet halves.
    out.valid("charts-ladder-lossless",
              encode_charts(made_images(2, 9, {rectangle_chart(2, 9, 1)}, {kNoMate}, 1), lossless(8, 3)));
    out.valid("charts-ladder-lossy",
              encode_charts(made_images(12, 3, {rectangle_chart(12, 2, 3)}, {kNoMate, kNoMate, kNoMate}, 1),
                            lossy(12, 3, 3)));
    out.valid("charts-encoder-lossy", kept);
    // As fine as the rectangle and finer.
    CodingParameters planes = lossy(10, 3, 30);
    planes.planes = {{ChunkType::kNormals, chart_plane(17, 11, 0, 20, -30)},
                     {ChunkType::kColors, chart_plane(17, 11, 1, 10, 40)}};
    out.valid("charts-open-planes", encode_charts(open_sheet(2), planes));
    planes.planes = {{ChunkType::kColors, chart_plane(2, 9, 0, 4, 40)}};
    out.valid("charts-ladder-planes",
              encode_charts(made_images(2, 9, {rectangle_chart(2, 9, 1)}, {kNoMate}, 1), planes));
}

void write_valid_tiles(Writer& out) {
    out.valid("tiles-one-lossless", encode_tiles(tiles(strip(1, 1), 2, 3, 1), lossless(10, 3)));
    out.valid("tiles-one-lossy", encode_tiles(tiles(strip(1, 1), 5, 300, 2), lossy(12, 9, 60)));
    out.valid("tiles-cube-lossless", encode_tiles(tiles(cube(), 2, 9, 3), lossless(12, 3)));
    out.valid("tiles-cube-lossy", encode_tiles(tiles(cube(), 3, 9, 3), lossy(12, 5, 6)));
    out.valid("tiles-torus-lossy", encode_tiles(tiles(test::torus(3, 3), 3, 0, 4), lossy(14, 3, 40)));
    out.valid("tiles-strip-lossy-coarse", encode_tiles(tiles(strip(3, 2), 3, 0, 5), lossy(12, 3, 500)));
    out.valid("tiles-pillow-lossless-20-bits", encode_tiles(tiles(pillow(), 3, 1u << 22, 6), lossless(20, 3)));
    out.valid("tiles-two-components-lossy",
              encode_tiles(tiles(both(pillow(), strip(2, 1)), 3, 3, 7), lossy(12, 3, 10)));
    out.valid("tiles-smallest", encode_tiles(tiles(cube(), 1, 0, 8), lossy(8, 3, 4)));
    TileImage sharp = tiles(genus_2(), 2, 3, 9);
    sharp.is_sharp = true;
    for (uint32_t h = 0; h < 4 * sharp.quads.size(); ++h) sharp.sharp.push_back(h % 3 == 0);
    out.valid("tiles-genus-2-sharp-lossy", encode_tiles(sharp, lossy(12, 3, 10)));
    // Details that are not in frames; and a wide origin.
    const TileImage noisy = tiles(cube(), 2, 60, 10);
    CodingParameters plain = lossy(12, 3, 20);
    plain.units = tile_units(noisy, 12).value();
    plain.units->tangential = plain.units->cell_area = 0;
    out.valid("tiles-frames-none", encode_tiles(noisy, plain));
    out.valid("tiles-wide-origin", far_away(encode_tiles(noisy, lossy(12, 3, 20))));

    CodingParameters planes = lossless(12, 3);
    planes.planes = {{ChunkType::kNormals, tile_plane(noisy, 0, 20, -30)},
                     {ChunkType::kColors, tile_plane(noisy, 2, 10, 40)}};
    out.valid("tiles-cube-planes", encode_tiles(noisy, planes));
    TileImage small = tiles(genus_2(), 1, 3, 9);
    small.is_sharp = true;
    planes = lossy(12, 3, 10);
    planes.planes = {{ChunkType::kNormals, tile_plane(small, 1, 30, 100)}};
    out.valid("tiles-genus-2-sharp-planes", encode_tiles(small, planes));
    const TileImage open = tiles(strip(3, 1), 2, 9, 11);
    planes.planes = {{ChunkType::kColors, tile_plane(open, 3, 4, 60)}};
    out.valid("tiles-strip-planes", encode_tiles(open, planes));
    planes.planes = {{ChunkType::kDisplacements, tile_plane(small, 2, 4, 30)}};
    out.valid("tiles-genus-2-displaced", encode_tiles(small, planes));
}

// Labels on squares, with a plane and a text beside them, and on tiles.
void write_valid_labels(Writer& out) {
    CodingParameters planes = lossy(12, 9, 30);
    planes.planes = {{ChunkType::kColors, plane({9}, 6, 20)}};
    planes.text = "with labels";
    out.valid("labels-sphere-17", labelled(encode({hill(17, folded_sides(), 0, 15)}, planes), 256, 16));
    const Bytes two =
        labelled(encode({hill(33, folded_sides(), 2, 11), hill(9, tube(), 2, 12)}, lossy(12, 5, 6)), 1024 + 64, 32);
    out.valid("labels-two-images", two);
    const Bytes of_tiles = labelled(encode_tiles(tiles(cube(), 3, 9, 3), lossless(12, 3)), 6 * 64, 8);
    out.valid("labels-tiles-cube", of_tiles);
    out.valid("labels-cut-tiles", cut_levels(of_tiles, 2));
    // A stream without bytes is valid: all labels are 0.
    out.valid("labels-empty", with_parts(of_tiles, [](Parts& p) { p.payloads.back().clear(); }));
}

void write_invalid_labels(Writer& out) {
    const Bytes two =
        labelled(encode({hill(33, folded_sides(), 2, 11), hill(9, tube(), 2, 12)}, lossy(12, 5, 6)), 1024 + 64, 32);
    const auto changed = [&](const char* name, const std::function<void(Parts&)>& change) {
        out.invalid(name, with_parts(two, change));
    };
    changed("malformed.labels-critical", [](Parts& p) { p.chunks.back().optional = false; });
    changed("malformed.labels-zstd", [](Parts& p) {
        p.chunks.back().zstd = true;
        p.chunks.back().raw_size = p.payloads.back().size();
    });
    changed("malformed.labels-twice", [](Parts& p) { insert_chunk(&p, p.chunks.size(), 6, true, p.payloads.back()); });
    changed("malformed.labels-before-a-level", [](Parts& p) {
        Bytes labels = p.payloads.back();
        remove_chunk(&p, p.chunks.size() - 1);
        insert_chunk(&p, p.chunks.size() - 1, 6, true, std::move(labels));
    });
    changed("malformed.labels-no-sizes", [](Parts& p) { p.payloads.back().clear(); });
    changed("malformed.labels-byte-left", [](Parts& p) { p.payloads.back().push_back(0); });
    changed("malformed.labels-byte-missing", [](Parts& p) { p.payloads.back().pop_back(); });
    out.invalid("malformed.labels-of-charts", with_parts(encode_charts(open_sheet(2), lossless(9, 3)), [](Parts& p) {
                    insert_chunk(&p, p.chunks.size(), 6, true, {});
                }));
    // The smallest level of a very large image: few samples, but 2^28 labels.
    CodingParameters coarse = lossless(8, 3);
    out.invalid("limit-exceeded.labels-of-a-cut-file",
                with_parts(cut_levels(encode({hill(33, open_square(), 0, 1)}, coarse), 3), [](Parts& p) {
                    const uint8_t more = 14 - p.exponents[0];
                    p.exponents[0] = 14;
                    p.header.level_count += more;
                    p.header.cut_levels += more;
                    insert_chunk(&p, p.chunks.size(), 6, true, {});
                }));
}

void write_invalid_tiles(Writer& out) {
    const Bytes file = encode_tiles(tiles(cube(), 2, 9, 3), lossless(12, 3));
    const auto header = [&](const char* name, const std::function<void(TileShape&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) { change(p.header.tiles); }));
    };
    header("malformed.tiles-none", [](TileShape& t) { t.tiles = 0; });
    header("malformed.tiles-too-many", [](TileShape& t) { t.tiles = kMostTiles + 1; });
    header("malformed.tiles-three-vertices", [](TileShape& t) { t.vertices = 3; });
    header("malformed.tiles-vertices-more-than-corners", [](TileShape& t) { t.vertices = 25; });
    header("malformed.tiles-rim-longer-than-sides", [](TileShape& t) { t.rim = 13; });
    header("malformed.tiles-fewer-steps-than-levels", [](TileShape& t) { t.exponent = 1; });
    header("malformed.tiles-exponent-11", [](TileShape& t) { t.exponent = 11; });
    header("malformed.tiles-one-vertex-less", [](TileShape& t) { t.vertices = 7; });
    header("malformed.tiles-one-vertex-more", [](TileShape& t) { t.vertices = 9; });
    header("malformed.tiles-rim-of-a-closed-surface", [](TileShape& t) { t.rim = 1; });
    header("malformed.tiles-more-than-in-the-seams", [](TileShape& t) { t.tiles = 7; });
    header("malformed.tiles-lossless-5-3", [](TileShape& t) { t.is_sharp = true; });
    header("malformed.tiles-samples", [](TileShape& t) { t.tiles = 1u << 11, t.exponent = 10; });
    header("limit-exceeded.tiles-samples", [](TileShape& t) { t.tiles = 70, t.exponent = 10; });
    header("limit-exceeded.tiles-side", [](TileShape& t) { t.tiles = 266, t.exponent = 10; });
    out.invalid("unsupported-version.tiles-reserved-flag",
                with_parts(file, [](Parts& p) { p.header.tiles.exponent |= 0x40; }));

    const auto seams = [&](const char* name, const Bytes& payload) {
        out.invalid(name, with_parts(file, [&](Parts& p) { p.payloads[0] = payload; }));
    };
    seams("malformed.tiles-seams-empty", {});
    seams("malformed.tiles-seams-of-ones", Bytes(16, 0xFF));
    // Two half-edges of the second tile become one edge.
    seams("malformed.tiles-folded", {0x00, 0xFF});
    const auto stream = [&](const char* name, const std::function<void(Bytes&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) { change(p.payloads[1]); }));
    };
    stream("malformed.tiles-stream-of-ones", [](Bytes& b) { b.assign(64, 0xFF); });
    stream("malformed.tiles-stream-halved", [](Bytes& b) { b.resize(b.size() / 2); });

    CodingParameters parameters = lossless(12, 3);
    const TileImage image = tiles(cube(), 2, 9, 3);
    parameters.planes = {{ChunkType::kColors, tile_plane(image, 1, 20, 10)}};
    const Bytes colored = encode_tiles(image, parameters);
    const auto changed = [&](const char* name, const Bytes& from, const std::function<void(Bytes&)>& change) {
        out.invalid(name, with_parts(from, [&](Parts& p) { change(p.payloads.back()); }));
    };
    changed("unsupported-version.tiles-plane-coding-1", colored, [](Bytes& b) { b[0] = 1; });
    changed("malformed.tiles-plane-no-exponent", colored, [](Bytes& b) { b.resize(5); });
    changed("malformed.tiles-plane-exponent-7", colored, [](Bytes& b) { b[5] = 7; });
    changed("malformed.tiles-plane-magnitude-too-large", colored, [](Bytes& b) { b.resize(6), b.resize(70, 0xFF); });
    changed("malformed.tiles-plane-raw-bits-missing", colored, [](Bytes& b) { b.resize(6), b.resize(10, 0xFF); });
    const TileImage fine = tiles(strip(1, 1), 9, 0, 3);
    parameters = lossy(8, 3, 100);
    parameters.planes = {{ChunkType::kColors, tile_plane(fine, 0, 20, 10)}};
    const Bytes large = encode_tiles(fine, parameters);
    changed("malformed.tiles-plane-finer-than-any", large, [](Bytes& b) { b.resize(6), b[5] = 6; });
    changed("limit-exceeded.tiles-plane-samples", large, [](Bytes& b) { b.resize(6), b[5] = 5; });
}

void write_invalid_container(Writer& out, const Bytes& plain, const Bytes& fine) {
    const auto changed = [&](const Bytes& from, size_t at, uint8_t value) {
        Bytes b = from;
        b[at] = value;
        return b;
    };
    out.invalid("not-gim.magic", changed(plain, 3, 'F'));
    out.invalid("not-gim.line-ends", [&] {
        Bytes b = plain;
        b.erase(b.begin() + 4);
        return b;
    }());
    out.invalid("not-gim.raw-floats", to_bytes(std::vector<float>(75, 1.0f)));
    out.invalid("unsupported-version.version-2", changed(plain, 7, 2));
    out.invalid("unsupported-version.layout-3", with_parts(plain, [](Parts& p) { p.header.layout = FileLayout{3}; }));
    out.invalid("unsupported-version.reserved-flag",
                with_parts(plain, [](Parts& p) { p.header.layout = FileLayout{0x40}; }));
    out.invalid("unsupported-version.critical-chunk",
                with_parts(plain, [](Parts& p) { insert_chunk(&p, 0, 77, false, {1}); }));
    out.invalid("checksum.index", changed(plain, 12, static_cast<uint8_t>(plain[12] ^ 1)));
    out.invalid("checksum.last-byte", changed(plain, plain.size() - 1, static_cast<uint8_t>(plain.back() ^ 0x80)));
    out.invalid("need-more-input.empty", {});
    const uint32_t index = take_apart(fine).header.index_size;
    out.invalid("need-more-input.magic-only", {fine.begin(), fine.begin() + 7});
    out.invalid("need-more-input.in-index", {fine.begin(), fine.begin() + index - 1});
    out.invalid("need-more-input.no-payload", {fine.begin(), fine.begin() + index});
    out.invalid("need-more-input.last-byte", {fine.begin(), fine.end() - 1});

    const auto header = [&](const char* name, const std::function<void(Parts&)>& change) {
        out.invalid(name, with_parts(fine, change));
    };
    header("malformed.bits-7", [](Parts& p) { p.header.bits = 7; });
    header("malformed.bits-21", [](Parts& p) { p.header.bits = 21; });
    header("malformed.no-level", [](Parts& p) { p.header.level_count = 0; });
    header("malformed.levels-15", [](Parts& p) { p.header.level_count = 15; });
    header("malformed.no-image", [](Parts& p) { p.exponents.clear(); });
    header("malformed.side-2", [](Parts& p) { p.exponents[0] = 0; });
    header("malformed.side-32769", [](Parts& p) { p.exponents[0] = 15; });
    header("malformed.more-levels-than-sides", [](Parts& p) { p.exponents[0] = 1; });
    header("malformed.origin-nan", [](Parts& p) { p.header.origin[1] = std::numeric_limits<float>::quiet_NaN(); });
    header("malformed.origin-huge", [](Parts& p) { p.header.origin[2] = 0x1p101f; });
    const auto far = [&](const char* name, size_t axis, double origin) {
        out.invalid(name, with_parts(far_away(fine), [&](Parts& p) { (*p.header.wide_origin)[axis] = origin; }));
    };
    far("malformed.wide-origin-nan", 0, std::numeric_limits<double>::quiet_NaN());
    far("malformed.wide-origin-infinite", 2, -std::numeric_limits<double>::infinity());
    far("malformed.wide-origin-huge", 1, -0x1.0000000000001p100);
    header("malformed.step-zero", [](Parts& p) { p.header.step = 0; });
    header("malformed.step-negative", [](Parts& p) { p.header.step = -1; });
    header("malformed.step-infinite", [](Parts& p) { p.header.step = std::numeric_limits<float>::infinity(); });
    header("malformed.quantizer-zero", [](Parts& p) { p.header.quantizer = 0; });
    header("malformed.quantizer-nan", [](Parts& p) { p.header.quantizer = std::numeric_limits<float>::quiet_NaN(); });
    header("malformed.cell-area-without-frames", [](Parts& p) { p.header.tangential = 0; });
    header("malformed.cut-all-levels", [](Parts& p) { p.header.cut_levels = p.header.level_count; });
    header("malformed.cut-whole-image", [](Parts& p) { p.header.cut_levels = p.exponents[1]; });
    header("malformed.cut-but-there", [](Parts& p) { p.header.cut_levels = 1; });
    // The seams need a side of 17; the finest level left has 9.
    Random random(21);
    const Sideband fine_nodes = random_sideband(random, 17, 4, 1, false);
    out.invalid("malformed.cut-to-an-open-level",
                with_parts(encode({hill(33, fine_nodes, 6, 14)}, lossy(12, 17, 5)),
                           [](Parts& p) { p.header.level_count += p.header.cut_levels = 2; }));
    const Bytes errors(kErrorsOfLevel * take_apart(fine).header.level_count, 1);
    const auto boxed = [&](const char* name, const Bytes& box) {
        Bytes boxes(2 * kBoxSize, 0);
        std::copy(box.begin(), box.end(), boxes.begin() + kBoxSize);
        header(name, [&](Parts& p) { p.header.level_errors = errors, p.header.boxes = boxes; });
    };
    boxed("malformed.box-low-above-high", {0x00, 0x00, 0x00, 0x20, 0x00, 0x00, 0x00});
    boxed("malformed.box-padding", {0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x01});
    header("malformed.no-seams", [](Parts& p) { remove_chunk(&p, 0); });
    header("malformed.seams-twice", [](Parts& p) { insert_chunk(&p, 1, 0, false, p.payloads[0]); });
    header("malformed.seams-optional", [](Parts& p) { p.chunks[0].optional = true; });
    header("malformed.seams-zstd", [](Parts& p) { p.chunks[0].zstd = true; });
    header("malformed.seams-after-a-level", [](Parts& p) {
        std::swap(p.chunks[0], p.chunks[1]);
        std::swap(p.payloads[0], p.payloads[1]);
    });
    header("malformed.level-missing", [](Parts& p) { remove_chunk(&p, 1); });
    header("malformed.level-too-many", [](Parts& p) { insert_chunk(&p, 1, 1, false, {}); });
    header("malformed.level-optional", [](Parts& p) { p.chunks[1].optional = true; });
    header("malformed.level-zstd", [](Parts& p) { p.chunks[1].zstd = true; });
    header("malformed.text-twice", [](Parts& p) {
        insert_chunk(&p, 0, 2, true, {'a'});
        insert_chunk(&p, 0, 2, true, {'b'});
    });
    header("malformed.text-critical", [](Parts& p) { insert_chunk(&p, 0, 2, false, {'a'}); });
    header("limit-exceeded.samples", [](Parts& p) { p.exponents.assign(1, 14); });
    header("malformed.size-table-short", [](Parts& p) { p.payloads.back().pop_back(); });
    header("malformed.size-table-long", [](Parts& p) { p.payloads.back().push_back(0); });

    // The index by hand: 8 Index_Size, 9 Kind, 10 Bits, 11 Level_Count, 12 Image_Count, ...
    out.invalid("malformed.index-size-tiny", changed(plain, 8, 5));
    out.invalid("malformed.index-size-superfluous-byte", [&] {
        Bytes b = {plain.begin(), plain.begin() + 8};
        b.insert(b.end(), {0xC0, 0x00, 0x00});
        return b;
    }());
    out.invalid("malformed.index-size-huge", [&] {
        Bytes b = {plain.begin(), plain.begin() + 8};
        b.insert(b.end(), {0x81, 0x80, 0x80, 0x08});
        return b;
    }());
    out.invalid("need-more-input.index-size-16-mib", [&] {
        Bytes b = {plain.begin(), plain.begin() + 8};
        b.insert(b.end(), {0x80, 0x80, 0x80, 0x08});
        return b;
    }());
    out.invalid("malformed.images-beyond-the-index", with_index_bytes(plain, [](Bytes& b) { b[12] = 100; }));
    // The index ends in Size and CRC of the last chunk. A continuation bit in Size makes a field go missing.
    const uint32_t plain_index = take_apart(plain).header.index_size;
    out.invalid("malformed.chunk-cut-off", with_index_bytes(plain, [&](Bytes& b) { b[plain_index - 4 - 3] |= 0x80; }));
    out.invalid("need-more-input.chunk-of-a-tebibyte", [&] {
        Parts parts = take_apart(plain);
        parts.header.side_exponents = parts.exponents;
        parts.chunks.back().size = uint64_t{1} << 40;
        Bytes b = serialize_header(parts.header, parts.chunks);
        b.insert(b.end(), parts.payloads[0].begin(), parts.payloads[0].end());
        b.insert(b.end(), parts.payloads[1].begin(), parts.payloads[1].end());
        return b;
    }());
}

void write_invalid_planes(Writer& out) {
    CodingParameters parameters = lossy(12, 9, 30);
    parameters.planes = {{ChunkType::kNormals, plane({17}, 48, 200)}};
    const Bytes file = encode({hill(17, torus(), 0, 15)}, parameters);
    const auto changed = [&](const char* name, const std::function<void(Chunk&, Bytes&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) { change(p.chunks.back(), p.payloads.back()); }));
    };
    changed("malformed.plane-critical", [](Chunk& c, Bytes&) { c.optional = false; });
    changed("malformed.plane-zstd", [](Chunk& c, Bytes&) { c.zstd = true; });
    changed("malformed.plane-empty", [](Chunk&, Bytes& b) { b.clear(); });
    changed("unsupported-version.plane-coding-1", [](Chunk&, Bytes& b) { b[0] = 1; });
    changed("malformed.plane-quantizer-nan", [](Chunk&, Bytes& b) { b[3] = b[4] = 0xFF; });
    changed("malformed.plane-quantizer-negative", [](Chunk&, Bytes& b) { b[4] |= 0x80; });
    changed("malformed.plane-no-sides", [](Chunk&, Bytes& b) { b.resize(5); });
    changed("malformed.plane-side-2", [](Chunk&, Bytes& b) { b[5] = 0; });
    changed("malformed.plane-side-32769", [](Chunk&, Bytes& b) { b[5] = 15; });
    changed("limit-exceeded.plane-samples", [](Chunk&, Bytes& b) { b[5] = 14; });
    changed("malformed.plane-magnitude-too-large", [](Chunk&, Bytes& b) { b.resize(6), b.resize(70, 0xFF); });
    changed("malformed.plane-raw-bits-missing", [](Chunk&, Bytes& b) { b.resize(6), b.resize(10, 0xFF); });
    out.invalid("malformed.plane-twice",
                with_parts(file, [](Parts& p) { insert_chunk(&p, p.chunks.size(), 3, true, p.payloads.back()); }));
    out.invalid("malformed.plane-before-a-level",
                with_parts(file, [](Parts& p) { insert_chunk(&p, p.chunks.size() - 2, 4, true, p.payloads.back()); }));
    out.invalid("malformed.plane-finer-seams", [&] {
        Random random(13);
        Sideband s = random_sideband(random, 17, 4, 1, false);
        CodingParameters coarse = lossy(12, 17, 30);
        coarse.planes = {{ChunkType::kNormals, plane({9}, 48, 200)}};
        return encode({hill(33, s, 0, 14)}, coarse);
    }());
    out.invalid("malformed.plane-displacements-twice", with_parts(file, [](Parts& p) {
                    insert_chunk(&p, p.chunks.size(), 5, true, p.payloads.back());
                    insert_chunk(&p, p.chunks.size(), 5, true, p.payloads.back());
                }));
    out.invalid("checksum.plane", [&] {
        Bytes b = file;
        b.back() ^= 1;
        return b;
    }());
    out.invalid("need-more-input.plane", {file.begin(), file.end() - 1});
    parameters = lossy(12, 9, 30);
    parameters.planes = {{ChunkType::kColors, plane({17, 5}, 20, -100)}};
    const Bytes two = encode({hill(9, tube(), 0, 16), hill(5, open_square(), 0, 17)}, parameters);
    out.invalid("malformed.plane-size-table-long", with_parts(two, [](Parts& p) { p.payloads.back().push_back(0); }));
    out.invalid("malformed.plane-size-table-short", with_parts(two, [](Parts& p) { p.payloads.back().pop_back(); }));
    out.invalid("malformed.plane-size-table-cut-off", with_parts(two, [](Parts& p) { p.payloads.back().resize(8); }));
}

// One chart of 4 x 3 samples in a rectangle of that size, its border one path.
RawTable one_chart() {
    RawTable table;
    table.sizes = {{12, 12}};
    table.charts = {{4, 3, 0, 0, 0, "-"}};
    return table;
}
constexpr const char* kRoundTheBox = "0002244466";

void write_invalid_chart_tables(Writer& out, const Bytes& file) {
    const auto header = [&](const char* name, const std::function<void(Header&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) { change(p.header); }));
    };
    header("malformed.charts-width-1", [](Header& h) { h.width = 1; });
    header("malformed.charts-height-65537", [](Header& h) { h.height = 65537; });
    header("limit-exceeded.charts-side", [](Header& h) { h.width = 16386; });
    header("limit-exceeded.charts-samples", [](Header& h) { h.width = h.height = 8193; });

    const auto table = [&](const char* name, const std::function<void(RawTable&, Header&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) {
                        RawTable t = one_chart();
                        change(t, p.header);
                        p.payloads[0] = table_bytes(t, p.header.width, p.header.height);
                        while (p.payloads.size() <= p.header.level_count) insert_chunk(&p, 1, 1, false, {});
                    }));
    };
    table("malformed.charts-none", [](RawTable& t, Header&) { t.charts.clear(); });
    table("malformed.charts-8193", [](RawTable& t, Header&) { t.charts.resize(kMaxCharts + 1, t.charts[0]); });
    table("malformed.charts-margin-4097", [](RawTable& t, Header&) { t.margin = 4097; });
    table("malformed.charts-box-bits-0", [](RawTable& t, Header&) { t.box_bits = 0; });
    table("malformed.charts-box-bits-16", [](RawTable& t, Header&) { t.box_bits = 16; });
    table("malformed.charts-vertices-2", [](RawTable& t, Header&) { t.sizes[0][0] = 2; });
    table("malformed.charts-vertices-more-than-samples", [](RawTable& t, Header&) { t.sizes[0][0] = 13; });
    table("malformed.charts-vertices-one-less", [](RawTable& t, Header&) { t.sizes[0][0] = 11; });
    table("malformed.charts-triangles-0", [](RawTable& t, Header&) { t.sizes[0][1] = 0; });
    table("malformed.charts-triangles-more-than-cells", [](RawTable& t, Header&) { t.sizes[0][1] = 25; });
    table("malformed.charts-triangles-one-less", [](RawTable& t, Header&) { t.sizes[0][1] = 11; });
    table("malformed.charts-triangles-one-more", [](RawTable& t, Header&) { t.sizes[0][1] = 13; });
    table("malformed.charts-one-column", [](RawTable& t, Header&) { t.charts[0].columns = 1; });
    table("malformed.charts-column-too-far", [](RawTable& t, Header&) { t.margin = 3, t.charts[0].column = 7; });
    table("malformed.charts-outside-the-rectangle", [](RawTable& t, Header&) { t.charts[0].column = 1; });
    table("malformed.charts-outside-on-the-left", [](RawTable& t, Header&) { t.margin = 1; });
    table("malformed.charts-mate-of-nothing", [](RawTable& t, Header&) { t.charts[0].paths = "0"; });
    table("malformed.charts-far-mate-of-nothing", [](RawTable& t, Header&) { t.charts[0].paths = "<<<3"; });
    table("malformed.charts-open-path-left", [](RawTable& t, Header&) { t.charts[0].paths = "<"; });
    table("malformed.charts-paths-16385", [](RawTable& t, Header&) { t.charts[0].paths.assign(16385, '-'); });
    table("malformed.charts-fewer-steps-than-levels", [](RawTable& t, Header& h) {
        h.level_count = 3;
        t.sizes.resize(3, {4, 2});
    });
    table("limit-exceeded.charts-boxes", [](RawTable& t, Header&) {
        t.box_bits = 15;
        t.charts[0].columns = 1u << 15;
        t.charts[0].rows = (1u << 11) + 1;
    });
    const auto payload = [&](const char* name, const std::function<void(Bytes&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) { change(p.payloads[0]); }));
    };
    payload("malformed.charts-table-empty", [](Bytes& b) { b.clear(); });
    payload("malformed.charts-table-cut-off", [](Bytes& b) { b.pop_back(); });
    payload("malformed.charts-table-trailing-byte", [](Bytes& b) { b.push_back(0); });
    payload("malformed.charts-table-padding", [](Bytes& b) { b.back() |= 1; });
    payload("malformed.charts-paths-number-too-long",
            [](Bytes& b) { b.resize(7), b.resize(11, 0), b.push_back(0xFF); });
}

void write_invalid_chart_planes(Writer& out) {
    CodingParameters parameters = lossless(9, 3);
    parameters.planes = {{ChunkType::kColors, chart_plane(17, 11, 0, 10, 40)}};
    const Bytes file = encode_charts(open_sheet(2), parameters);
    const auto changed = [&](const char* name, const std::function<void(Bytes&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) { change(p.payloads.back()); }));
    };
    changed("unsupported-version.charts-plane-coding-1", [](Bytes& b) { b[0] = 1; });
    changed("malformed.charts-plane-exponent-7", [](Bytes& b) { b[5] = 7; });
    changed("malformed.charts-plane-no-exponent", [](Bytes& b) { b.resize(5); });
    changed("malformed.charts-plane-magnitude-too-large", [](Bytes& b) { b.resize(6), b.resize(70, 0xFF); });
    parameters.planes = {{ChunkType::kColors, chart_plane(600, 3, 0, 10, 40)}};
    out.invalid("limit-exceeded.charts-plane-side",
                with_parts(encode_charts(made_images(600, 3, {rectangle_chart(4, 3, 1)}, {kNoMate}, 1), parameters),
                           [](Parts& p) { p.payloads.back()[5] = 5; }));
}

void write_invalid_borders(Writer& out, const Bytes& file) {
    const auto border = [&](const char* name, const std::function<void(RawBorderWriter&)>& write,
                            const char* paths = "-") {
        out.invalid(name, with_parts(file, [&](Parts& p) {
                        RawTable t = one_chart();
                        t.charts[0].paths = paths;
                        p.payloads[0] = table_bytes(t, p.header.width, p.header.height);
                        RangeEncoder coder;
                        RawBorderWriter writer(&coder);
                        write(writer);
                        p.payloads[1] = coder.finish();
                    }));
    };
    const auto walk = [&](const char* name, uint32_t column, uint32_t row, const std::string& directions) {
        border(name, [&](RawBorderWriter& w) {
            w.begin_chart(4, 3, column, row);
            w.length(static_cast<uint32_t>(directions.size()));
            w.steps(directions);
        });
    };
    walk("malformed.charts-border-begins-outside", 0, 3, "036");
    walk("malformed.charts-border-leaves-the-box", 1, 0, kRoundTheBox);
    walk("malformed.charts-border-leaves-on-the-left", 1, 0, "2444400066");
    walk("malformed.charts-border-not-closed", 0, 0, "000224446");
    walk("malformed.charts-border-twice-round", 0, 0, "024602460246");
    walk("malformed.charts-border-longer-than-the-box", 0, 0, "0246024602460246");
    border("malformed.charts-border-no-length", [](RawBorderWriter& w) {
        w.begin_chart(4, 3, 0, 0);
        w.length((1u << 25) - 1);
    });
    const auto second = [&](const char* name, uint32_t coded) {
        border(
            name,
            [&](RawBorderWriter& w) {
                w.begin_chart(4, 3, 0, 0);
                w.length(5);
                w.steps("00022");
                w.number_of_second(coded);
                w.steps("44466");
                w.zipper(5, 5, "00000");
            },
            "<0");
    };
    second("malformed.charts-mate-of-length-0", 10);
    second("malformed.charts-mate-too-long", 5);
    const auto stream = [&](const char* name, const std::function<void(Bytes&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) { change(p.payloads[1]); }));
    };
    stream("malformed.charts-stream-empty", [](Bytes& b) { b.clear(); });
    stream("malformed.charts-stream-of-ones", [](Bytes& b) { b.assign(64, 0xFF); });
    stream("malformed.charts-stream-halved", [](Bytes& b) { b.resize(b.size() / 2); });
}

void write_invalid_payloads(Writer& out, const Bytes& plain, const Bytes& sphere, const Bytes& torus_file) {
    const auto seams = [&](const char* name, const Bytes& from, Bytes payload) {
        out.invalid(name, with_parts(from, [&](Parts& p) { p.payloads[0] = std::move(payload); }));
    };
    seams("malformed.sideband-empty", plain, {});
    seams("malformed.sideband-trailing-byte", plain, {0x00, 0x00});
    seams("malformed.sideband-padding", plain, {0x01});
    seams("malformed.sideband-node-grid-15", plain, {0xF0, 0, 0, 0});
    // 0001: node side 3, ring 8; start in 3 bits.
    seams("malformed.sideband-mate-of-nothing", sphere, {0x11, 0, 0, 0});      // 0001 000 1
    seams("malformed.sideband-far-mate-of-nothing", sphere, {0x10, 0, 0, 0});  // 0001 000 000
    seams("malformed.sideband-cut-off", sphere, [&] {
        Bytes b = take_apart(sphere).payloads[0];
        b.pop_back();
        return b;
    }());
    // 0010: node side 5, ring 16; start 0000; 001 a boundary of 1 + 0000; 01 a path of 1 + 111, room for 15 / 2 only.
    seams("malformed.sideband-path-too-long", torus_file, {0x20, 0x20, 0xF0, 0, 0});
    {
        // A boundary of one edge joins the two ends of a seam. Both its ends are one point, at the finest level too.
        Sideband s = {17, 0, {{2, 31}, {kNoMate, 1}, {0, 31}, {kNoMate, 1}}};
        Bytes b;
        append_sideband(s, &b);
        seams("malformed.sideband-never-closed", torus_file, b);
        s = {33, 0, {{2, 32}, {3, 32}, {0, 32}, {1, 32}}};
        b.clear();
        append_sideband(s, &b);
        seams("malformed.sideband-finer-than-image", torus_file, b);
    }

    const auto level = [&](const char* name, const Bytes& from, Bytes payload) {
        out.invalid(name, with_parts(from, [&](Parts& p) { p.payloads.back() = std::move(payload); }));
    };
    level("malformed.raw-bits-missing", torus_file, Bytes(4, 0xFF));
    level("malformed.magnitude-too-large", plain, Bytes(64, 0xFF));
    level("malformed.stream-halved", torus_file, [&] {
        Bytes b = take_apart(torus_file).payloads.back();
        b.resize(b.size() / 2);
        return b;
    }());
}

// ---- rasters --------------------------------------------------------------------------------------------------------

Bytes encode_raster_as(const RasterImage& image, double tolerance, double quantizer) {
    auto scale = scale_raster(image, 12);
    if (!scale.ok()) std::abort();
    return write_raster(image, scale.value(), glue_raster(image, raster_positions(image), tolerance), quantizer);
}

void write_valid_rasters(Writer& out) {
    out.valid("raster-full", encode_raster_as(raster_of(9, 7, all_defined, 3), 0, 0));
    out.valid("raster-holes", encode_raster_as(raster_of(19, 17, with_holes, 3), 0, 0));
    out.valid("raster-seams", encode_raster_as(folded_raster(24, 10, 0), 0, 0));
    out.valid("raster-seams-lossy", encode_raster_as(folded_raster(24, 10, 0), 0, 5.5));
    out.valid("raster-seams-inexact", encode_raster_as(folded_raster(24, 10, 2), 6, 0));
    RasterImage other = raster_of(12, 11, with_holes, 7);
    other.is_channels_first = true;
    other.mask = RasterImage::Mask::kChannel;
    other.mask_channel = 5;
    other.mask_value = 255;
    out.valid("raster-channels", encode_raster_as(other, 0, 0));
    RasterImage noise = raster_of(16, 16, with_holes, 4);
    Random random(5);
    for (double& v : noise.values) v = random.below(1u << 20);
    noise.type = SampleType::kInt32;
    out.valid("raster-noise-20-bits", encode_raster_as(noise, 0, 0));
    out.valid("raster-wide-origin", far_away(encode_raster_as(folded_raster(24, 10, 0), 0, 0)));
}

void write_invalid_rasters(Writer& out) {
    const RasterImage image = raster_of(8, 6, with_holes, 5);
    const Bytes file = encode_raster_as(image, 0, 0), lossy_file = encode_raster_as(image, 0, 4);
    const auto header = [&](const char* name, const std::function<void(Header&)>& change) {
        out.invalid(name, with_parts(name[0] == 'm' ? lossy_file : file, [&](Parts& p) { change(p.header); }));
    };
    out.invalid("malformed.raster-levels-2", with_parts(file, [](Parts& p) {
                    p.header.level_count = 2;
                    insert_chunk(&p, 1, 1, false, {});
                }));
    header("malformed.raster-width-1", [](Header& h) { h.width = 1; });
    header("malformed.raster-too-many-samples", [](Header& h) { h.width = h.height = 65536; });
    header("malformed.raster-bits-too-few", [](Header& h) { h.bits = 8; });
    header("malformed.raster-tangential", [](Header& h) { h.tangential = 8; });
    header("limit-exceeded.raster-side", [](Header& h) { h.width = 16386; });
    for (const auto& [name, type] : {std::pair("malformed.raster-labels", 6), std::pair("malformed.raster-normals", 3)})
        out.invalid(name,
                    with_parts(file, [&](Parts& p) { insert_chunk(&p, 2, static_cast<uint32_t>(type), true, {0}); }));

    const auto table = [&](const char* name,
                           const std::function<void(RasterTable&, std::vector<RasterChannel>&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) {
                        RasterTable t;
                        if (parse_raster_table(p.payloads[0], p.header, {}, &t) != Status::kOk) std::abort();
                        std::vector<RasterChannel> others = {t.channel(3), t.channel(4)};
                        change(t, others);
                        p.payloads[0] = serialize_raster_table(t, others);
                    }));
    };
    using Others = std::vector<RasterChannel>;
    table("malformed.raster-vertices-2", [](RasterTable& t, Others&) { t.vertices = 2; });
    table("malformed.raster-vertices-more-than-samples", [](RasterTable& t, Others&) { t.vertices = 49; });
    table("malformed.raster-vertices-wrong", [](RasterTable& t, Others&) { --t.vertices; });
    table("malformed.raster-triangles-0", [](RasterTable& t, Others&) { t.triangles = 0; });
    table("malformed.raster-triangles-more-than-cells", [](RasterTable& t, Others&) { t.triangles = 97; });
    table("malformed.raster-triangles-wrong", [](RasterTable& t, Others&) { ++t.triangles; });
    table("unsupported-version.raster-type-9", [](RasterTable& t, Others&) { t.sample_type = 9; });
    table("unsupported-version.raster-type-bit-5", [](RasterTable& t, Others&) { t.sample_type |= 0x20; });
    table("malformed.raster-mask-too-far", [](RasterTable& t, Others&) { t.mask = 8; });
    table("malformed.raster-channels-2", [](RasterTable& t, Others& o) { t.channels = 2, o.clear(); });
    table("malformed.raster-channels-4097", [](RasterTable& t, Others& o) { t.channels = 4097, o.resize(4094, o[0]); });
    table("malformed.raster-channel-missing", [](RasterTable&, Others& o) { o.pop_back(); });
    table("malformed.raster-channel-left-over", [](RasterTable&, Others& o) { o.push_back(o[0]); });
    table("malformed.raster-channel-bits-0", [](RasterTable&, Others& o) { o[1].bits = 0; });
    table("malformed.raster-channel-bits-21", [](RasterTable&, Others& o) { o[1].bits = 21; });
    table("malformed.raster-channel-origin", [](RasterTable&, Others& o) { o[0].origin = 0x1p101f; });
    table("malformed.raster-channel-step", [](RasterTable&, Others& o) { o[0].step = 0; });

    out.invalid("limit-exceeded.raster-channels",
                with_parts(file, [](Parts& p) { p.header.width = p.header.height = 8192; }));
    const auto stream = [&](const char* name, const std::function<void(Bytes&)>& change) {
        out.invalid(name, with_parts(file, [&](Parts& p) { change(p.payloads[1]); }));
    };
    stream("malformed.raster-stream-empty", [](Bytes& b) { b.clear(); });
    stream("malformed.raster-stream-of-ones", [](Bytes& b) { b.assign(64, 0xFF); });
    stream("malformed.raster-stream-halved", [](Bytes& b) { b.resize(b.size() / 2); });
}

}  // namespace
}  // namespace gim

int main(int argc, char** argv) {
    using namespace gim;
    if (argc != 2) return 2;
    const fs::path folder = argv[1];
    const Bytes kept = kept_vector(folder);
    for (const char* sub : {"valid", "invalid"}) {
        fs::remove_all(folder / sub);
        fs::create_directories(folder / sub);
    }
    Writer out(folder);
    write_valid(out);
    write_valid_charts(out, kept);
    write_valid_tiles(out);
    write_valid_labels(out);
    write_valid_rasters(out);
    const Bytes plain = encode({hill(5, open_square(), 0, 1)}, lossless(8, 5));
    const Bytes sphere = encode({hill(17, folded_sides(), 9, 2)}, lossless(12, 5));
    const Bytes torus_file = encode({hill(17, torus(), 40, 4)}, lossless(12, 3));
    const Bytes fine = encode({hill(17, folded_sides(), 2, 11), hill(9, tube(), 2, 12)}, lossy(12, 5, 6));
    write_invalid_container(out, plain, fine);
    write_invalid_planes(out);
    write_invalid_payloads(out, plain, sphere, torus_file);
    const Bytes chart = encode_charts(made_images(4, 3, {rectangle_chart(4, 3, 1)}, {kNoMate}, 1), lossless(12, 3));
    write_invalid_chart_tables(out, chart);
    write_invalid_borders(out, chart);
    write_invalid_chart_planes(out);
    write_invalid_tiles(out);
    write_invalid_labels(out);
    write_invalid_rasters(out);
    return out.fine() ? 0 : 1;
}
