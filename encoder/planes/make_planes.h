// Attribute planes of a run: which are wanted, sampled (sample_planes.h, input_colors.h), coded, and measured when decoded.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/code/assemble_file.h"
#include "encoder/planes/plane_images.h"
#include "gim/encoder.h"

namespace gim {

class PlaneMaker {
  public:
    // Keeps references to all. `clean`: the cleaned mesh; `input`: the mesh as read, whose appearance counts. Costs nothing
    // when the options want no plane.
    PlaneMaker(const Mesh& clean, const TriangleMesh& input, const EncodeOptions& options);
    ~PlaneMaker();

    bool wants_any() const;

    // Planes of all images, one chunk per kind. A --bytes target gets planes of half of its bytes at most, in lower quality
    // if need be. O(texels log F).
    std::vector<CodedPlane> make(const PlaneImages& images) const;

    // The planes of a complete file against the input.
    Result<std::vector<PlaneReport>> measure(std::span<const uint8_t> file) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gim
