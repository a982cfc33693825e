// The one writer of files: it owns header, level errors, planes and text. Layouts add their seams and levels as a LevelCoder.
#pragma once

#include <cstdint>
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

struct CodingParameters {
    bool lossless = true;  // the quantized image is kept exactly
    uint32_t bits = 12;    // quantizer: bits per coordinate of the largest box extent, 8..20
    double quantizer = 8;  // lossy: step of a coefficient of unit norm, in quantization steps; twice: about 6 dB less
    uint32_t base_side = 17;         // squares: side of the coarsest stored level; smaller ones cost about 7 bytes each
    std::vector<CodedPlane> planes;  // stored behind the levels
    std::string text;                // goes into a META chunk unless empty; UTF-8
    std::optional<Units> units;      // lossy: of a fit, instead of the images' own
    bool level_psnr = false;         // leaves room in the header for set_level_psnr
};

// What a layout codes. All that does not depend on the quantizer is done once, so that a search over quantizers is cheap.
class LevelCoder {
  public:
    virtual ~LevelCoder() = default;
    // Layout, coding, sizes, levels and units. Its spans point into the coder.
    virtual Header header() const = 0;
    // The payload of the SEAM chunk.
    virtual std::vector<uint8_t> seam_payload() const = 0;
    // Payloads of the levels, coarsest first. header: the file's, with its quantizer. O(samples).
    virtual std::vector<std::vector<uint8_t>> code_levels(const Header& header) const = 0;
};

class FileWriter {
  public:
    FileWriter(std::unique_ptr<LevelCoder> coder, const CodingParameters& parameters);

    // quantizer: of lossy coding; lossless coding ignores it. O(samples).
    std::vector<uint8_t> write(double quantizer) const;
    // Of the file for that quantizer, without what depends on its contents. Points into the writer.
    Header header(double quantizer) const;

  private:
    std::unique_ptr<LevelCoder> coder_;
    std::vector<uint8_t> seams_, level_psnr_;
    std::vector<CodedPlane> planes_;
    std::string text_;
};

// Images as wavelet bands, of integers or not yet quantized, base values relative to the middle of their range.
struct ImageBands {
    std::vector<Pyramid<int32_t>> lossless;
    std::vector<Pyramid<float>> lossy;

    // Integer bands of an image. seams: of a square whose mates share their details.
    Pyramid<int32_t> quantized(size_t image, const Header& header, const SeamTable* seams = nullptr) const;
};

// An Error unless the format takes so many bits.
Result<void> check_bits(uint32_t bits);
// Whether the format can hold a position.
bool is_codable(const Vec3& position);

}  // namespace gim
