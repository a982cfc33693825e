// The basis of squares and charts (image_basis.h): the wavelet of each part of an image.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "encoder/code/wavelet_analysis.h"
#include "encoder/fit/coded_part.h"
#include "encoder/fit/image_basis.h"
#include "format/detail_frame.h"

namespace gim {

class PartsBasis final : public ImageBasis {
  public:
    // boxes: of each part, all samples as interleaved triples in units, also of those that are not defined. parts: not
    // copied. width, samples: of the image. coding: in frames.
    PartsBasis(std::span<const CodedPart> parts, std::vector<std::vector<float>> boxes, uint32_t width, size_t samples,
               const DetailCoding& coding);

    // Returns the coordinates of the boxes.
    Coordinates coordinates() const;
    // Undefined samples have the values of the boxes.
    Coordinates analyse(const std::vector<float>& image) const override;
    // Undefined samples are 0.
    std::vector<float> synthesize(const Coordinates& coordinates) const override;
    // Returns all samples of each part.
    std::vector<std::vector<float>> boxes_of(const Coordinates& coordinates) const;
    Coordinates transposed(std::vector<float> image) const override;

  private:
    // Where a part's triples are.
    struct Place {
        size_t base, details;
    };

    void add_details(const CodedPart& part, std::vector<float> box, const DetailCoding& coding);
    // Calls body(part number) for all parts, on all cores.
    template <class Body>
    void for_each_part(const Body& body) const;
    Pyramid<float> pyramid_of(size_t part, const Coordinates& coordinates) const;
    Coordinates coordinates_of(std::vector<std::vector<float>> boxes) const;
    void store(size_t part, const Pyramid<float>& pyramid, Coordinates& coordinates) const;
    // Sets source = weight * (source + copy), copy = 0. The coordinates must be out of frames.
    void gather_copies(Coordinates& coordinates, float weight) const;

    std::span<const CodedPart> parts_;
    std::vector<std::vector<float>> boxes_;
    uint32_t width_;
    size_t samples_;
    std::vector<Place> places_;
    std::vector<std::pair<uint32_t, uint32_t>> copies_;  // triples: copy and source
};

}  // namespace gim
