// Charts -> a complete .gim file of layout mcgim: extension, quantization, wavelet, entropy coding, container.
// spec/gim-format.md, "Charts".
#pragma once

#include <vector>

#include "encoder/base/result.h"
#include "encoder/charts/chart_levels.h"
#include "encoder/squares/write_squares.h"

namespace gim {

class ChartFileWriter final : public FileWriter {
  public:
    // parameters.base_side does not matter: the levels are those of the charts.
    static Result<ChartFileWriter> create(const ChartImages& images, const CodingParameters& parameters);

    std::vector<uint8_t> write(double quantizer) const override;

  private:
    ChartFileWriter() = default;

    Header header_;
    std::vector<ChartBox> charts_;
    std::vector<uint32_t> mates_;
    std::vector<LevelBorders> borders_;
    std::vector<uint8_t> level_psnr_, table_;
    std::vector<CodedPlane> planes_;
    std::string text_;
    std::vector<Pyramid<int32_t>> lossless_;  // per chart
    std::vector<Pyramid<float>> lossy_;
};

}  // namespace gim
