// The codecs that gim is measured against: Draco, and meshoptimizer followed by zstd. Positions and connectivity only.
//
// Evaluation only: built with GIM_BUILD_RD, never installed, never linked to the product. Encoders run at their
// smallest setting (Draco: compression level 10; meshoptimizer: vertex cache and fetch order first, zstd level 19).
// Decoders work in memory, on one thread. Each gives what a program would draw: float positions and triangle indices.
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

// Draco drops degenerate triangles. Errors are the library's words.
Result<Bytes> encode_draco(const RivalMesh& mesh, int bits);
Result<Bytes> encode_meshopt(const RivalMesh& mesh, int bits);  // at most 16 bits per coordinate

// Decodes the same bytes over and over. Keeps memory between the runs if the library allows it.
class RepeatedDecoder {
  public:
    virtual ~RepeatedDecoder() = default;
    virtual bool run() = 0;                              // false if the bytes are damaged
    virtual std::array<uint64_t, 2> counts() const = 0;  // vertices and triangles of the last run
    virtual RivalMesh mesh() const = 0;                  // of the last run
};
// These keep a reference to the bytes. They return nullptr if the file is of another kind.
std::unique_ptr<RepeatedDecoder> make_draco_decoder(const Bytes& bytes);
std::unique_ptr<RepeatedDecoder> make_meshopt_decoder(const Bytes& bytes);
std::unique_ptr<RepeatedDecoder> make_gim_decoder(
    const Bytes& bytes);  // all images at full resolution, without normals

// Runs meshoptimizer's quadric edge collapse towards `ratio` of the triangles, however large the error.
RivalMesh simplify_quadric(const RivalMesh& mesh, double ratio);

}  // namespace gim::rd
