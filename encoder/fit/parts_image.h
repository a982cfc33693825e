// The coded image of squares and charts (coded_image.h): parts that are coded one by one, each with a wavelet of its own.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "encoder/code/coefficient_prices.h"
#include "encoder/code/detail_response.h"
#include "encoder/code/wavelet_analysis.h"
#include "encoder/fit/coded_image.h"
#include "encoder/fit/coded_part.h"
#include "encoder/image/gluing.h"
#include "format/container.h"

namespace gim {

// Closes the seams of a whole image as the decoder does. image: interleaved triples, in units.
using CloseSeams = std::function<void(std::vector<float>& image)>;

// The parts of an image, and how they make one surface. Does not depend on what is coded.
struct ImageParts {
    const GridGluing& gluing;
    std::vector<CodedPart> parts;
    CloseSeams close;

    // Returns the images of each part, coarsest first, in units around the middle.
    CodedImage::Levels decode(std::span<const Pyramid<int32_t>> bands, const Units& units) const;
    std::vector<float> samples(const CodedImage::Levels& levels, const Units& units) const;
};

class PartsImage final : public CodedImage {
  public:
    // Keeps references to parts, responses and the bands of each part. responses: of each part.
    PartsImage(const ImageParts& parts, std::vector<DetailResponses>& responses, std::span<Pyramid<int32_t>> bands,
               const Units& units);

    const Units& units() const override { return units_; }
    Levels decode() const override { return parts_.decode(bands_, units_); }
    Levels decode_changed(const PlaceInPart& place, uint32_t component, int32_t by) const override;
    std::vector<float> samples(const Levels& levels) const override { return parts_.samples(levels, units_); }
    DetailFrame frame(const Levels& levels, const PlaceInPart& place) const override;
    uint32_t depths(uint32_t part) const override { return bands_[part].steps(); }
    DetailSteps steps_at(uint32_t depth) const override { return detail_coding_of(units_).steps_at(depth); }
    Band band(const PlaceInPart& place) override;
    std::vector<Band> bands() override { return all_bands(bands_); }
    std::vector<CellInPart> parts_at(uint32_t cell) const override;
    PlaceInPart source_of(const PlaceInPart& place) const override;
    WeightedSamples moved_by(const PlaceInPart& source) const override;

  private:
    struct Copy {
        DetailPlace source, copy;
    };
    struct Depth {
        OwnSharedRim rim;
        std::vector<Copy> copies;
    };

    void find_owners();
    void add_block(const CodedPart& part, const ResponseBlock& block, WeightedSamples& moved) const;

    const ImageParts& parts_;
    std::vector<DetailResponses>& responses_;
    std::span<Pyramid<int32_t>> bands_;
    Units units_;
    std::vector<std::vector<Depth>> depths_;  // per part, finest first
    std::vector<uint32_t> owner_;             // part of each sample
};

}  // namespace gim
