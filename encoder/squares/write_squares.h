// Geometry images -> a complete .gim file: quantization, wavelet, entropy coding, container.  spec/gim-format.md.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/assemble_file.h"
#include "encoder/code/wavelet_analysis.h"
#include "encoder/image/geometry_image.h"
#include "format/container.h"

namespace gim {

struct CodingParameters {
    bool lossless = true;  // the quantized image is kept exactly
    uint32_t bits = 12;    // quantizer: bits per coordinate of the largest box extent, 8..20
    double quantizer = 8;  // lossy: step of a coefficient of unit norm, in quantization steps; twice: about 6 dB less
    uint32_t base_side = 17;         // side of the coarsest stored level; smaller ones cost about 7 bytes each
    std::vector<CodedPlane> planes;  // stored behind the levels
    std::string text;                // goes into a META chunk unless empty; UTF-8
    std::optional<Header> units;     // lossy: units_of() other images, instead of these images' own
    bool level_psnr = false;         // leaves room in the header for set_level_psnr
};

// All that does not depend on the quantizer, so that a search over quantizers does it once.
class GimWriter final : public FileWriter {
  public:
    // Images: at least one, sides 2^j+1, finite positions, sidebands that close the finest level.
    static Result<GimWriter> create(std::span<const GeometryImage> images, const CodingParameters& parameters);

    std::vector<uint8_t> write(double quantizer) const override;
    // Of the file for that quantizer, without what depends on its contents. Points into the writer.
    Header header(double quantizer) const;

  private:
    GimWriter() = default;
    void drop_levels_of_no_use();

    Header header_;
    std::vector<uint8_t> side_exponents_, level_psnr_, seams_;
    std::vector<CodedPlane> planes_;
    std::string text_;
    std::vector<Pyramid<int32_t>> lossless_;
    std::vector<Pyramid<float>> lossy_;
    std::vector<SeamTable> seam_tables_;
    // Of an image whose mates share their details; else null.
    const SeamTable* shared_seams(size_t image) const {
        return header_.tangential > 0 ? &seam_tables_[image] : nullptr;
    }
};

// What positions and steps of a file of these images are counted in: a header with bits, origin, step, tangential steps and
// cell area only.
Header units_of(std::span<const GeometryImage> images, uint32_t bits);

// Writes the measured PSNR of each level (finest first, dB) into the header of a file of ours that has room for them.
// The size stays.
std::vector<uint8_t> set_level_psnr(std::span<const uint8_t> file, std::span<const double> psnr);

Result<std::vector<uint8_t>> write_gim(std::span<const GeometryImage> images, const CodingParameters& parameters);

}  // namespace gim
