// The encoder's view of its own output: a .gim file decoded through the public interface into one mesh.
#pragma once

#include <cstdint>
#include <span>

#include "encoder/base/result.h"
#include "encoder/surface/compare_meshes.h"
#include "encoder/surface/mesh.h"
#include "gim/decoder.hpp"
#include "gim/encoder.h"

namespace gim {

// Opens a file of ours, of any size.
gim_status open_own_file(std::span<const uint8_t> bytes, Decoder* decoder);

// What a failure to decode our own file is called.
Error decoding_error(Stage stage, gim_status status);

// Header and index of a file of ours. Fails with the decoder's status text.
Result<gim_info> read_own_info(std::span<const uint8_t> bytes);

// All images of the file at one level, side by side in one mesh. Images whose seams cannot be closed at that level are decoded
// at their coarsest one. Fails with the decoder's status text.
Result<Mesh> decode_surface(std::span<const uint8_t> bytes, uint32_t level);

// The surface of a file at full resolution against the reference.
Result<Comparison> compare_file(std::span<const uint8_t> bytes, const ReferenceSurface& reference,
                                const CompareOptions& options);

// The coarsest level that every image of the file can close.
Result<uint32_t> coarsest_level(std::span<const uint8_t> bytes);

}  // namespace gim
