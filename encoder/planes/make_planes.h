// Attribute planes of a run: decides which are wanted, samples them (sample_planes.h, input_colors.h), codes them, and
// measures the decoded ones.
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
    // Keeps references to its arguments. `clean`: the cleaned mesh; `input`: the mesh as read, for its appearance.
    // Costs nothing if the options want no plane.
    PlaneMaker(const Mesh& clean, const TriangleMesh& input, const EncodeOptions& options);
    ~PlaneMaker();

    bool wants_any() const;

    // Returns the planes of all images, one chunk per kind. For a --bytes target planes take at most half of the bytes;
    // their quality is lowered if necessary. O(texels log F).
    std::vector<CodedPlane> make(const PlaneImages& images) const;

    // Returns a finished file of the images with its planes made again: the fit has moved samples since they were made.
    // Keeps to a --bytes target. O(texels log F).
    std::vector<uint8_t> renew(std::vector<uint8_t> file, const PlaneImages& images) const;

    // Compares the planes of a complete file with the input.
    Result<std::vector<PlaneReport>> measure(std::span<const uint8_t> file) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gim
