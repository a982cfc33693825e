// The encoder's view of its own output: decodes a .gim file through the public interface into one mesh.
#pragma once

#include <cstdint>
#include <span>

#include "encoder/base/result.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/mesh.h"
#include "gim/decoder.hpp"
#include "gim/encoder.h"

namespace gim {

// Opens a file that this encoder wrote, of any size.
gim_status open_own_file(std::span<const uint8_t> bytes, Decoder* decoder);

// The Error for a failure to decode our own file.
Error decoding_error(Stage stage, gim_status status);

// Reads header and index of our own file. Fails with the decoder's status text.
Result<gim_info> read_own_info(std::span<const uint8_t> bytes);

// Appends decoded positions of a file to a mesh, in object space.
void append_positions(const gim_info& info, std::span<const float> positions, Mesh& mesh);

// Decodes all images of the file at one level into one mesh. Images whose seams do not close at that level are decoded
// at their coarsest closed level. Fails with the decoder's status text.
Result<Mesh> decode_surface(std::span<const uint8_t> bytes, uint32_t level);

// Compares the surface of a file at full resolution with the reference.
Result<Comparison> compare_file(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                const CompareOptions& options);

// Returns the coarsest level at which the seams of every image close.
Result<uint32_t> coarsest_level(std::span<const uint8_t> bytes);

}  // namespace gim
