// The codec of squares, as the fit sees it.
#pragma once

#include "encoder/fit/fit_codec.h"
#include "encoder/fit/fold_repair.h"
#include "format/seam.h"

namespace gim {

class SquareCodec final : public FitCodec {
  public:
    // side: of the image. seams: of the file; mates share their details. Keeps references to gluing and reference.
    SquareCodec(uint32_t side, const SeamTable& seams, const GridGluing& gluing, const FitReference& reference,
                const FitFrame& frame, double front);
    SquareCodec(const SquareCodec&) = delete;
    SquareCodec& operator=(const SquareCodec&) = delete;

    std::unique_ptr<ImageBasis> basis(const std::vector<float>& image, const DetailCoding& coding) const override;
    std::vector<Vec3> decoded(const std::vector<float>& image, const Units& units, bool mends_folds) override;
    void repair(Pyramid<int32_t>& bands, const Units& units) override;

  private:
    void fuse_seams(std::vector<float>& image) const;

    uint32_t side_;
    SeamTable seams_;
    std::vector<uint32_t> ring_classes_;
    FoldRepair repair_;
};

}  // namespace gim
