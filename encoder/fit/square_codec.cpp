#include "encoder/fit/square_codec.h"

#include <algorithm>
#include <utility>

#include "encoder/code/code_bands.h"
#include "encoder/fit/detail_basis.h"
#include "format/fuse.h"
#include "format/ring.h"

namespace gim {

namespace {

std::vector<uint32_t> classes_of(const SeamTable& seams, uint32_t side) {
    std::vector<uint32_t> classes(ring_length(side));
    ring_classes(seams, side, classes);
    return classes;
}

}  // namespace

SquareCodec::SquareCodec(uint32_t side, const SeamTable& seams, const GridGluing& gluing, const FitReference& reference,
                         const FitFrame& frame, double front)
    : side_(side),
      seams_(seams),
      ring_classes_(classes_of(seams_, side)),
      repair_(gluing, reference, frame, front, {CodedPart{side, side, 0, 0, &seams_, {}}},
              [this](std::vector<float>& image) { fuse_seams(image); }) {}

std::unique_ptr<ImageBasis> SquareCodec::basis(const std::vector<float>& image, const DetailCoding& coding) const {
    return std::make_unique<DetailBasis>(image, side_, coding, &seams_);
}

std::vector<Vec3> SquareCodec::decoded(const std::vector<float>& image, const Units& units, bool mends_folds) {
    Pyramid<float> pyramid = analyse<Irreversible97>(image, side_, &seams_);
    subtract_middle(&pyramid, units.bits);
    Pyramid<int32_t> bands = quantize_bands(pyramid, detail_coding_of(units), &seams_).bands;
    if (mends_folds) repair_.repair({&bands, 1}, units, kRepairBetween);
    return repair_.decode({&bands, 1}, units);
}

void SquareCodec::repair(Pyramid<int32_t>& bands, const Units& units) {
    repair_.repair({&bands, 1}, units, kLastRepair);
}

void SquareCodec::fuse_seams(std::vector<float>& image) const {
    const size_t ring = ring_classes_.size();
    const uint32_t classes = 1 + *std::max_element(ring_classes_.begin(), ring_classes_.end());
    std::vector<float> sums(3 * ring), outer(3 * ring), inner(3 * ring);
    std::vector<uint32_t> first(ring), members(ring);
    fuse(side_, ring_classes_.data(), classes, image.data(),
         {sums.data(), first.data(), members.data(), outer.data(), inner.data()});
}

}  // namespace gim
