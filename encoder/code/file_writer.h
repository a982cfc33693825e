// The only writer of files. Owns header, level errors, planes and text. A layout adds seams and levels as a LevelCoder.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/assemble_file.h"
#include "encoder/code/wavelet_analysis.h"
#include "encoder/surface/mesh.h"
#include "format/container.h"
#include "format/seam.h"

namespace gim {

// Changes the integer bands of some images before a lossy file codes them. first: number of the first of the images.
using RepairBands = std::function<void(size_t first, std::span<Pyramid<int32_t>> bands, const Units& units)>;

struct CodingParameters {
    bool lossless = true;  // keeps the quantized image exactly
    uint32_t bits = 12;    // quantizer: bits per coordinate of the largest box extent, 8..20
    double quantizer = 8;  // lossy: step of a coefficient of unit norm, in quantization steps; twice: about 6 dB less
    uint32_t base_side = 17;  // squares: side of the coarsest stored level; each smaller level adds about 7 bytes
    std::vector<CodedPlane> planes;  // stored behind the levels
    std::string text;                // UTF-8; goes into a META chunk unless empty
    std::optional<Units> units;      // lossy: units of a fit, used instead of those of the images
    RepairBands repair;              // lossy: mends what the quantizer spoils; empty: nothing does
    bool bounds = false;             // leaves room in the header for set_level_errors and set_boxes
    bool wide_origin = false;        // gives the file a binary64 origin, for move_origin
};

// Codes the images of a layout. Work that does not depend on the quantizer is done once, to make searches cheap.
class LevelCoder {
  public:
    virtual ~LevelCoder() = default;
    // Returns layout, coding, sizes, levels and units. The spans of the header point into the coder.
    virtual Header header() const = 0;
    // Returns the payload of the SEAM chunk.
    virtual std::vector<uint8_t> seam_payload() const = 0;
    // Returns the payloads of the levels, coarsest first. header: that of the file, with its quantizer. O(samples).
    virtual std::vector<std::vector<uint8_t>> code_levels(const Header& header) const = 0;
};

class FileWriter {
  public:
    FileWriter(std::unique_ptr<LevelCoder> coder, const CodingParameters& parameters);

    // Returns the file. Lossless coding ignores the quantizer. O(samples).
    std::vector<uint8_t> write(double quantizer) const;
    // Returns the header of that file, without fields that depend on its contents. Its spans point into the writer. Its
    // units are those of the images: they have a binary32 origin, which the file may hold in binary64.
    Header header(double quantizer) const;

  private:
    std::unique_ptr<LevelCoder> coder_;
    std::vector<uint8_t> seams_, level_errors_, boxes_;
    bool has_wide_origin_;
    std::vector<CodedPlane> planes_;
    std::string text_;
};

// Images as wavelet bands: integers, or floats not yet quantized. The base is relative to the middle of its range.
struct ImageBands {
    std::vector<Pyramid<int32_t>> lossless;
    std::vector<Pyramid<float>> lossy;

    // Returns the integer bands of an image. seams: of a square whose mates share their details.
    Pyramid<int32_t> quantized(size_t image, const Header& header, const SeamTable* seams = nullptr) const;
};

// An Error unless the format takes so many bits.
Result<void> check_bits(uint32_t bits);
// Whether the format can hold a position.
bool is_codable(const Vec3& position);

}  // namespace gim
