// Attribute planes of a run: which are wanted, sampled (sample_planes.h, input_colors.h), coded, and measured when decoded.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/image/geometry_image.h"
#include "encoder/squares/write_squares.h"
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
    Result<std::vector<CodedPlane>> make(std::span<const GeometryImage> images) const;

    // Planes of a multi-chart image, as fine as `side` samples a side would be on a square of as many samples.
    Result<std::vector<CodedPlane>> make(const MultiChartImage& image) const;

    // The planes of a complete file against the input.
    Result<std::vector<PlaneReport>> measure(std::span<const uint8_t> file) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace gim
