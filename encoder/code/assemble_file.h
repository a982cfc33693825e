// Turns payloads into a complete .gim file: chunks, index, checksums.  spec/gim-format.md, "File".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "format/bounds.h"
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

// The measured error of a level, in object units. Negative: not known.
struct LevelError {
    double rms = -1, max = -1;
};

// Returns the file with the errors of its levels, finest first, in its header. The file must have room for them
// (CodingParameters::bounds), and as many levels. Its size stays the same.
std::vector<uint8_t> set_level_errors(std::span<const uint8_t> file, std::span<const LevelError> errors);

// Returns the file with the boxes of its images in its header. If one is farther from the origin than the header can
// tell, none is told. The file must have room for them, as above, and as many images. Its size stays the same.
std::vector<uint8_t> set_boxes(std::span<const uint8_t> file, std::span<const Box> boxes);

// Returns the file with its binary64 origin moved. The file must have one (CodingParameters::wide_origin). Its size stays
// the same.
std::vector<uint8_t> move_origin(std::span<const uint8_t> file, const std::array<double, 3>& by);

}  // namespace gim
