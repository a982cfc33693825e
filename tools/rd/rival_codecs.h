// What gim is measured against: Draco, and meshoptimizer's codecs followed by zstd. Positions and connectivity only.
//
// Evaluation only: built with GIM_BUILD_RD, never installed, linked to nothing of the product. Encoders are called at their
// smallest (Draco: compression level 10; meshoptimizer: vertex cache and fetch order first, zstd level 19). Decoders work in
// memory, on one thread. Each gives what a program would draw: float positions and triangle indices.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "tools/file.h"

namespace gim::rd {

struct RivalMesh {
    std::vector<std::array<float, 3>> positions;
    std::vector<std::array<uint32_t, 3>> triangles;
};

// The codec writes what it can: Draco drops degenerate triangles. Errors are the library's words.
Result<Bytes> encode_draco(const RivalMesh& mesh, int bits);
Result<Bytes> encode_meshopt(const RivalMesh& mesh, int bits);  // at most 16 bits per coordinate

// Decodes the same bytes over and over; memory is kept between the runs wherever the library allows.
class RepeatedDecoder {
  public:
    virtual ~RepeatedDecoder() = default;
    virtual bool run() = 0;                              // false: the bytes are damaged
    virtual std::array<uint64_t, 2> counts() const = 0;  // vertices and triangles of the last run
    virtual RivalMesh mesh() const = 0;                  // of the last run
};
// Keep a reference to the bytes. nullptr: not a file of that kind.
std::unique_ptr<RepeatedDecoder> make_draco_decoder(const Bytes& bytes);
std::unique_ptr<RepeatedDecoder> make_meshopt_decoder(const Bytes& bytes);
std::unique_ptr<RepeatedDecoder> make_gim_decoder(
    const Bytes& bytes);  // all images at full resolution, without normals

// meshoptimizer's quadric edge collapse towards that share of the triangles, however large the error.
RivalMesh simplify_quadric(const RivalMesh& mesh, double ratio);

}  // namespace gim::rd
