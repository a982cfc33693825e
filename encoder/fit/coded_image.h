// A coded image as the repair of folds sees it: integers that can be changed one by one, the samples that a decoder makes
// of them, and what each detail moves. Each way to lay out details has one.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/fit/fitter.h"
#include "encoder/surface/mesh.h"
#include "format/band.h"
#include "format/container.h"
#include "format/detail_frame.h"

namespace gim {

// A detail of a part of an image. Parts are boxes of samples with bands of their own.
struct PlaceInPart {
    uint32_t part, depth;  // depth: 1 for the finest
    Orientation orientation;
    uint32_t row, column;  // in the band

    bool operator==(const PlaceInPart&) const = default;
};

// The middle of a cell, in samples from the first one of a part. It may lie outside of the part.
struct CellInPart {
    uint32_t part;
    double row, column;
};

// Samples of an image, with their weights.
using WeightedSamples = std::vector<std::pair<uint32_t, float>>;

class CodedImage {
  public:
    // The images that a decoder has on its way. Their order is the layout's own.
    using Levels = std::vector<std::vector<std::vector<float>>>;

    virtual ~CodedImage() = default;

    virtual const Units& units() const = 0;
    // Decodes the integers as they are.
    virtual Levels decode() const = 0;
    // Decodes them as if the component of a detail had changed by `by`. Costs a copy of the integers more.
    virtual Levels decode_changed(const PlaceInPart& place, uint32_t component, int32_t by) const = 0;
    // Returns the samples of the whole image with closed seams: interleaved triples, in units.
    virtual std::vector<float> samples(const Levels& levels) const = 0;
    virtual DetailFrame frame(const Levels& levels, const PlaceInPart& place) const = 0;

    virtual uint32_t depths(uint32_t part) const = 0;
    virtual DetailSteps steps_at(uint32_t depth) const = 0;
    virtual Band band(const PlaceInPart& place) = 0;
    // Returns the bands of all parts and depths.
    virtual std::vector<Band> bands() = 0;

    // Returns the cell in the part that has it, and in those beside it whose details may reach it.
    virtual std::vector<CellInPart> parts_at(uint32_t cell) const = 0;
    // Returns the place whose integers the coder takes: a copy's source, else the place itself.
    virtual PlaceInPart source_of(const PlaceInPart& place) const = 0;
    // Returns which samples move if the detail changes, together with its copies, and how far. Weights of a sample that
    // is named twice add up. Several threads may call it at once.
    virtual WeightedSamples moved_by(const PlaceInPart& source) const = 0;
};

// Returns samples in units as positions in the frame.
std::vector<Vec3> positions_of(const std::vector<float>& samples, const Units& units, const FitFrame& frame);

}  // namespace gim
