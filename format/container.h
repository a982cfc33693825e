// The container: magic number, header, chunk index.  spec/gim-format.md, "File".
// Reads and writes it. Reading allocates nothing and trusts nothing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "format/bytes.h"
#include "format/status.h"

namespace gim {

// As in PNG: the first byte stops text tools, the line ends reveal conversions, the last byte stops a listing.
inline constexpr std::array<uint8_t, 7> kMagic = {0x89, 'G', 'I', 'M', 0x0D, 0x0A, 0x1A};
inline constexpr uint8_t kFormatVersion = 1;

// The numbers are bits of the header.
enum class FileLayout : uint8_t {
    kSquares = 0,    // gim: one square image per component
    kCharts = 1,     // mcgim: one image of charts (format/chart_table.h)
    kTiles = 2,      // tiles: one complex of square tiles (format/quad_complex.h)
    kRaster = 0x41,  // mcgim: an imported image (format/raster_table.h)
};

enum class Coding : uint8_t { kLossless = 0, kLossy = 1 };

enum class ChunkType : uint32_t {
    kSeams = 0,          // SEAM, critical: the sidebands of all images, the chart table, how tiles are glued, what a
                         // raster holds
    kLevel = 1,          // LEVL, critical: one level of all images; coarsest first
    kText = 2,           // META, optional: UTF-8 text about the file
    kNormals = 3,        // NRML, optional: normals at a resolution of their own (format/plane_code.h)
    kColors = 4,         // COLR, optional: colours, likewise
    kDisplacements = 5,  // DISP, optional: displacements, likewise
    kLabels = 6,         // LABL, optional: a label for each cell (format/label_code.h)
};

struct ContainerLimits {
    uint64_t max_samples = uint64_t{1} << 26;
    uint32_t max_images = 65536;
    uint32_t max_side = 16385;
};

// For bytes of our own.
inline constexpr ContainerLimits kNoLimits = {UINT64_MAX, UINT32_MAX, UINT32_MAX};

inline constexpr uint32_t kMinBits = 8, kMaxBits = 20;
inline constexpr uint32_t kMaxImages = 65536;
inline constexpr uint32_t kMaxAtlasSide = 65536;
inline constexpr uint64_t kMaxRasterSamples = uint64_t{1} << 31;
inline constexpr uint32_t kMaxLevels = 14;
inline constexpr size_t kErrorsOfLevel = 2, kBoxSize = 7;  // bytes of a header (format/bounds.h)
inline constexpr uint64_t kMaxIndexSize = uint64_t{1} << 24;
inline constexpr float kMaxOrigin = 0x1p100f;                              // greatest absolute value, of both kinds
inline constexpr float kMinStep = 0x1p-100f, kMaxStep = 0x1p76f;           // object units per unit
inline constexpr float kMinQuantizer = 0x1p-16f, kMaxQuantizer = 0x1p20f;  // units

// The area, in units^2, that a header's code stands for: 4 .. 7 times a power of two, from 2^-18 on. Code 0: no area.
constexpr float cell_area_of(uint8_t code) {
    if (code == 0) return 0;
    float area = static_cast<float>(4 + (code & 3)) * 0x1p-20f;
    for (uint32_t k = code >> 2; k > 0; --k) area *= 2;
    return area;
}

struct Chunk {
    ChunkType type = ChunkType::kText;
    bool optional = false;  // a reader that does not know the type may skip it
    bool zstd = false;      // the payload is one zstd frame of a text of raw_size bytes
    uint64_t size = 0;
    uint64_t raw_size = 0;  // bytes after decompression; without zstd equal to size
    uint16_t crc = 0;       // of the stored payload
};

// kTiles: the complex, as far as the header tells.
struct TileShape {
    uint32_t tiles = 0, vertices = 0, rim = 0;  // rim: half the number of edges on boundaries
    uint32_t exponent = 0;                      // each side of a tile has 2^exponent intervals at full resolution
    bool is_sharp = false;                      // lossy: 5/3 in place of 9/7
    bool has_sharp_edges = false;               // the seams tell which edges are sharp

    uint32_t edges() const { return 2 * tiles + rim; }
    uint32_t intervals(uint32_t level) const { return 1u << (exponent - level); }
};

// The units of a file's positions and details. A position is origin + step * number of units.
struct Units {
    uint32_t bits = 12;             // of a coordinate along the largest extent of the bounding box
    std::array<float, 3> origin{};  // object space
    float step = 1;                 // object units per unit
    float quantizer = 0;            // kLossy only, like the next two: step of a coefficient of unit norm, in units
    uint8_t tangential = 0;  // step of tangential components over that of normal ones, in eighths; 0: details are
                             // not in frames
    uint8_t cell_area = 0;   // code of the area that steps refer to (cell_area_of)
};

// Header fields as stored. The spans point into the parsed bytes.
struct Header : Units {
    FileLayout layout = FileLayout::kSquares;
    Coding coding = Coding::kLossless;
    // Where the units' origin lies in object space, if the file has a binary64 origin. Such a file stores no other
    // origin: that of the units is 0, and decoded positions are relative to this one.
    std::optional<std::array<double, 3>> wide_origin;
    uint32_t level_count = 0;                 // of the file before it was cut
    uint32_t cut_levels = 0;                  // so many of them, the finest ones, are cut off
    std::span<const uint8_t> side_exponents;  // kSquares: one per image; side = 2^j + 1
    uint32_t width = 0, height = 0;           // kCharts, kRaster: of the rectangle
    TileShape tiles;                          // kTiles
    // Both are empty, or both are there (format/bounds.h).
    std::span<const uint8_t> level_errors;  // codes of the RMS and the maximum error of each level kept, coarsest first
    std::span<const uint8_t> boxes;         // kBoxSize bytes per image

    // Derived from the file.
    std::span<const uint8_t> index;
    uint32_t chunk_count = 0;
    uint32_t index_size = 0;    // bytes from the start of the file to the first chunk
    uint64_t sample_count = 0;  // of all images or of the atlas of tiles, at the finest level kept; or of the rectangle
    uint64_t file_size = 0;

    bool is_rectangle() const { return layout == FileLayout::kCharts || layout == FileLayout::kRaster; }
    uint32_t image_count() const {
        return layout == FileLayout::kSquares ? static_cast<uint32_t>(side_exponents.size()) : 1;
    }
    // Only if there are boxes.
    std::span<const uint8_t, kBoxSize> box_bytes(uint32_t image) const {
        return boxes.subspan(image * kBoxSize).first<kBoxSize>();
    }
    uint32_t kept_levels() const { return level_count - cut_levels; }
    uint32_t side(uint32_t image) const { return (1u << side_exponents[image]) + 1; }
    // Levels 0 .. level_count_of(image)-1 are stored; the coarsest of them has at least 3 samples a side.
    uint32_t level_count_of(uint32_t image) const {
        return side_exponents[image] < level_count ? side_exponents[image] : level_count;
    }
};

// Reads and checks header and index at the start of `file`. Returns kNeedMoreInput only if the index is incomplete.
Status parse_header(std::span<const uint8_t> file, const ContainerLimits& limits, Header* header);

// Walks the index of a parsed header.
class ChunkWalk {
  public:
    explicit ChunkWalk(const Header& header) : reader_(header.index), offset_(header.index_size) {}
    // Returns false past the last chunk. *offset receives where its payload begins in the file.
    bool next(Chunk* chunk, uint64_t* offset);

  private:
    ByteReader reader_;
    uint64_t offset_;
};

// Checks the payload of a chunk. Returns kNeedMoreInput if the file ends within it, kChecksum if it is damaged.
Status read_payload(std::span<const uint8_t> file, const Chunk& chunk, uint64_t offset,
                    std::span<const uint8_t>* payload);

// Returns the bytes from the magic number to the index's checksum. Ignores derived header fields.
std::vector<uint8_t> serialize_header(const Header& header, std::span<const Chunk> chunks);

// Finds the first chunk of a type. Returns false if there is none.
bool find_chunk(const Header& header, ChunkType type, Chunk* chunk, uint64_t* offset);

// Finds and checks the payload of the SEAM chunk.
Status read_seam_payload(const Header& header, std::span<const uint8_t> file, std::span<const uint8_t>* payload);

// Finds the chunk that holds a level of all images.
Status find_level_chunk(const Header& header, uint32_t level, Chunk* chunk, uint64_t* offset);

}  // namespace gim
