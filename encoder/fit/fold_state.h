// A coded image in the middle of a pass of the repair of folds (fold_passes.h): where its samples are, and what its cells
// cost.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/code/coefficient_prices.h"
#include "encoder/fit/coded_image.h"
#include "encoder/fit/fitter.h"
#include "encoder/image/gluing.h"

namespace gim {

// What folds are worth, and the most passes.
struct RepairEffort {
    int passes;
    double fold;  // bits that a folded face is worth at least
    double turn;  // bits for each unit of its cosine
};

// The surface that an image shows. front: the sign that makes the image face outwards.
struct ShownSurface {
    const GridGluing& gluing;
    const FitReference& reference;
    const FitFrame& frame;
    double front;
};

class FoldState {
  public:
    // Decodes the image, and finds the steep cells. nearest: per slot, a face of the reference that was near. Keeps references
    // to all of them; shown's own references too.
    FoldState(const ShownSurface& shown, CodedImage& image, const RepairEffort& effort, std::vector<uint32_t>& nearest);

    const GridGluing& gluing() const { return shown_.gluing; }
    const FitReference& reference() const { return shown_.reference; }
    CodedImage& image() const { return image_; }
    const CodedImage::Levels& levels() const { return levels_; }
    // By how many bits a band grows if the component of a detail becomes greater by `by`.
    double bits_of(const PlaceInPart& place, uint32_t component, int32_t by) const {
        return prices_.bits_of_change(image_.band(place), place.row, place.column, component, by);
    }
    double unit() const { return unit_; }               // length of a unit in the frame
    double step() const { return unit_ * quantizer_; }  // of the quantizer, in the frame

    // In the frame: the samples as they are, and as they were when the pass began.
    const std::vector<Vec3>& x() const { return x_; }
    const std::vector<Vec3>& x_before() const { return x_before_; }
    // All samples that have moved since, in order.
    const std::vector<uint32_t>& moved() const { return moved_; }

    // Cells with a face that looks away from the reference. Changes leave it as it is.
    const std::vector<uint32_t>& steep_cells() const { return steep_; }
    // Per cell: how far a corner may move against the others before a face can turn steep, when the pass began.
    const std::vector<double>& margin() const { return margin_; }
    // What the folds of a cell are worth, in bits.
    double cost(uint32_t cell) const { return cost_[cell]; }
    // The same if its samples were at x. Uses the reference faces that were nearest when the pass began.
    double cost_at(const std::vector<Vec3>& x, uint32_t cell) const;

    // A face of the reference near a sample; kNone if none is known.
    uint32_t face_near(uint32_t v) const;

    // Moves samples, each by its weight. Returns the cells at them.
    std::vector<uint32_t> move(const WeightedSamples& samples, const Vec3& shift);

    // Another image in place of this one.
    struct Move {
        CodedImage::Levels levels;
        std::vector<Vec3> x;
        std::vector<uint32_t> samples, cells;          // that move
        std::vector<std::array<uint32_t, 2>> nearest;  // of these cells
        std::vector<uint32_t> refolded;                // the cells whose folds cost clearly more or less than now
        double fold_cost = 0;                          // how much more, in bits
    };
    Move move_to(CodedImage::Levels levels) const;
    void take(Move move);

  private:
    std::vector<Vec3> positions(const CodedImage::Levels& levels) const;
    Vec3 normal_of(const std::vector<Vec3>& x, const Triangle& t) const;
    double cosine(const std::vector<Vec3>& x, const Triangle& t, uint32_t& near) const;
    double margin_of(const std::array<Triangle, 2>& faces, double least_cosine) const;
    double cost_with(const std::vector<Vec3>& x, uint32_t cell, const std::array<uint32_t, 2>& near) const;
    std::array<uint32_t, 2> nearest_of(uint32_t cell) const { return {nearest_[2 * cell], nearest_[2 * cell + 1]}; }
    void find_steep_cells();
    std::vector<uint32_t> cells_at(std::span<const uint32_t> samples) const;

    ShownSurface shown_;
    CodedImage& image_;
    RepairEffort effort_;
    std::vector<uint32_t>& nearest_;
    double unit_, quantizer_;
    CoefficientPrices prices_;
    CodedImage::Levels levels_;
    std::vector<Vec3> x_, x_before_;
    std::vector<uint32_t> moved_, steep_;
    std::vector<double> margin_, cost_;
};

}  // namespace gim
