// The codec of squares and charts, as the fit sees it.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "encoder/fit/fit_codec.h"
#include "encoder/fit/fold_repair.h"
#include "encoder/fit/parts_basis.h"
#include "encoder/fit/parts_image.h"

namespace gim {

class PartsCodec final : public FitCodec {
  public:
    // Keeps references to gluing and reference of the setting. close: closes the seams as a decoder does.
    PartsCodec(const FitSetting& setting, std::vector<CodedPart> parts, CloseSeams close);
    PartsCodec(const PartsCodec&) = delete;
    PartsCodec& operator=(const PartsCodec&) = delete;

    std::shared_ptr<const ImageBasis> basis(const std::vector<float>& image, const DetailCoding& coding) override;
    void follow(const ImageBasis::Coordinates& change) override;
    std::vector<Vec3> decoded(const std::vector<float>& image, const Units& units, bool mends_folds) override;
    void repair(std::span<Pyramid<int32_t>> bands, const Units& units) override;

    // Puts an image into the boxes of its parts, with values where it is not defined that are cheap to code. image,
    // boxes: interleaved triples in units. Goes on from the last image. The reference holds until the next call.
    const std::vector<std::vector<float>>& extend(const std::vector<float>& image, float quantizer);

  private:
    const GridGluing& gluing_;
    std::vector<CodedPart> parts_;
    FoldRepair repair_;
    std::shared_ptr<const PartsBasis> basis_;  // the last one
    std::vector<std::vector<float>> boxes_;    // of the last image; empty before there is one
};

}  // namespace gim
