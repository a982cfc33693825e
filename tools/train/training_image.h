// What a .gim file tells the training: its decisions, and its bands with what surrounds them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "format/band_code.h"
#include "format/status.h"

namespace gim {

// The decisions of an image with the current weights. Models have the numbers of BandModels::for_each.
struct Recording {
    std::vector<std::pair<size_t, uint8_t>> decisions;
    uint64_t raw_bits = 0;
};

// The three bands of one wavelet step: of a square, or of one tile.
struct TrainingBands {
    LevelBands bands, parents;
    uint32_t weights = 0;   // which of the kind's weights they have
    bool has_flags = true;  // of empty blocks
    // Whether a triple is coded here, not a copy of another one.
    std::function<bool(Orientation, uint32_t row, uint32_t column)> is_coded;
};

class TrainingImage {
  public:
    virtual ~TrainingImage() = default;
    virtual CoefficientKind kind() const = 0;
    virtual Recording record() = 0;
    virtual void for_each_bands(const std::function<void(const TrainingBands&)>& f) = 0;
};

using TrainingImages = std::vector<std::unique_ptr<TrainingImage>>;

// Appends the images of a file: positions of a square or of tiles, and planes. kBadArgument: the file has none.
Status read_training_images(std::span<const uint8_t> file, TrainingImages* images);

}  // namespace gim
