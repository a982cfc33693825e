// The codec of squares and charts, as the fit sees it.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "encoder/fit/fit_codec.h"
#include "encoder/fit/fold_repair.h"
#include "encoder/fit/parts_basis.h"
#include "encoder/fit/parts_image.h"

namespace gim {

// How an image whose parts have rasters of their own is closed at its seams: maps of interleaved triples of the samples.
struct OpenSeams {
    CloseSeams close;       // as a decoder does
    CloseSeams transposed;  // the transpose of that map
};

class PartsCodec final : public FitCodec {
  public:
    // For squares. Keeps references to gluing and reference of the setting. close: closes the seams as a decoder does.
    PartsCodec(const FitSetting& setting, std::vector<CodedPart> parts, CloseSeams close);
    // For charts. Samples at one surface point have no common place in the rasters of their parts. So they are coded as
    // they are cheapest in each part, a sample's spacing apart at most, and closing brings them to the surface point.
    PartsCodec(const FitSetting& setting, std::vector<CodedPart> parts, OpenSeams seams);
    PartsCodec(const PartsCodec&) = delete;
    PartsCodec& operator=(const PartsCodec&) = delete;

    CodedCoordinates coordinates(const std::vector<float>& image, const DetailCoding& coding) override;
    void follow(const ImageBasis::Coordinates& change) override;
    void close(std::vector<float>& image) const override;
    void close_transposed(std::vector<float>& image) const override;
    std::vector<Vec3> decoded(const std::vector<float>& image, const Units& units, bool mends_folds) override;
    void repair(std::span<Pyramid<int32_t>> bands, const Units& units) override;

    // Puts an image into the boxes of its parts, with values where it is not defined that are cheap to code. image,
    // boxes: interleaved triples in units. Goes on from the last image. The reference holds until the next call.
    const std::vector<std::vector<float>>& extend(const std::vector<float>& image, float quantizer);

  private:
    void take(const std::vector<float>& image);

    std::vector<CodedPart> parts_;
    FoldRepair repair_;
    OpenSeams open_;                           // empty for squares
    std::shared_ptr<const PartsBasis> basis_;  // the last one
    std::vector<std::vector<float>> boxes_;    // of the last image; empty before there is one
};

}  // namespace gim
