// Turns payloads into a complete .gim file: chunks, index, checksums.  spec/gim-format.md, "File".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "format/container.h"

namespace gim {

// An attribute plane, ready to be stored (format/plane_code.h).
struct CodedPlane {
    ChunkType type = ChunkType::kNormals;
    std::vector<uint8_t> payload;
};

// levels: payloads, coarsest level first.
std::vector<uint8_t> assemble_file(const Header& header, std::span<const uint8_t> seams,
                                   std::span<const std::vector<uint8_t>> levels, std::span<const CodedPlane> planes,
                                   const std::string& text);

// Returns the file with these planes in place of its own ones of the same types, or after all of its chunks.
std::vector<uint8_t> replace_planes(std::span<const uint8_t> file, std::span<const CodedPlane> planes);

// Returns the file with the measured PSNR of each level (finest first, dB) in its header. The file must have room for
// them (CodingParameters::level_psnr). Its size stays the same.
std::vector<uint8_t> set_level_psnr(std::span<const uint8_t> file, std::span<const double> psnr);

// Returns the file with its binary64 origin moved. The file must have one (CodingParameters::wide_origin). Its size stays
// the same.
std::vector<uint8_t> move_origin(std::span<const uint8_t> file, const std::array<double, 3>& by);

}  // namespace gim
