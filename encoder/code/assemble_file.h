// The parts of a .gim file that all layouts have in common: quantizer, chunks, container.  spec/gim-format.md, "File".
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "encoder/surface/mesh.h"
#include "format/container.h"

namespace gim {

// An attribute plane, ready to be stored (format/plane_code.h).
struct CodedPlane {
    ChunkType type = ChunkType::kNormals;
    std::vector<uint8_t> payload;
};

// Sets bits, origin and step: one isotropic step for the bounding box of all positions.
void set_quantizer(std::span<const std::span<const Vec3>> positions, uint32_t bits, Header* header);

// How the details of lossy files are coded: in frames, tangential steps this many times the normal ones. The reference
// area is the mean over the cells of all grids; cells with a sample that is not defined do not count.
inline constexpr double kTangentialRatio = 3;
class CellArea {
  public:
    // defined: empty, or per sample.
    void add(std::span<const Vec3> positions, std::span<const uint8_t> defined, uint32_t columns, uint32_t rows);
    // To be called after set_quantizer.
    void set_details(Header* header) const;

  private:
    double sum_ = 0;
    uint64_t cells_ = 0;
};

// As near to a lossy header's quantizer as the format takes.
float quantizer_in_range(double quantizer);

// Positions in units of the header's quantizer, as interleaved triples.
template <class Sample>
std::vector<Sample> to_units(std::span<const Vec3> positions, const Header& header) {
    std::vector<Sample> units;
    units.reserve(positions.size() * 3);
    const double most = std::exp2(header.bits) - 1;
    for (const Vec3& p : positions) {
        for (int k = 0; k < 3; ++k) {
            const double unit = (p[k] - double{header.origin[static_cast<size_t>(k)]}) / double{header.step};
            if constexpr (std::is_integral_v<Sample>) {
                units.push_back(static_cast<Sample>(std::clamp(std::floor(unit + 0.5), 0.0, most)));
            } else {
                units.push_back(static_cast<Sample>(unit));
            }
        }
    }
    return units;
}

// levels: payloads, coarsest first.
std::vector<uint8_t> assemble_file(const Header& header, std::span<const uint8_t> seams,
                                   std::span<const std::vector<uint8_t>> levels, std::span<const CodedPlane> planes,
                                   const std::string& text);

// Something that files of any quantizer can be made of.
class FileWriter {
  public:
    virtual ~FileWriter() = default;
    // quantizer: lossy: step of a coefficient of unit norm, in quantization steps; ignored by lossless coding. O(samples).
    virtual std::vector<uint8_t> write(double quantizer) const = 0;
};

}  // namespace gim
