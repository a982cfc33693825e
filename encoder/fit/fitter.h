// A fit in progress: image and reference, the sampled distances between them as a quadratic energy of the samples'
// displacements, and steps that fold nothing over.  fit.cpp: the energy; its terms besides the distances are the
// caller's choice.
//
// Everything runs in a frame where the reference's bounding box has diagonal 1.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "encoder/fit/fit.h"
#include "encoder/fit/fit_system.h"
#include "encoder/image/gluing.h"
#include "encoder/surface/closest_point.h"
#include "encoder/surface/mesh.h"

namespace gim {

// The frame, and the ways into it and out.
struct FitFrame {
    Vec3 middle = Vec3::Zero();
    double scale = 1;  // of the input's unit

    explicit FitFrame(const Mesh& mesh);
    std::vector<Vec3> into(const std::vector<Vec3>& points) const {
        std::vector<Vec3> result(points.size());
        for (size_t k = 0; k < points.size(); ++k) result[k] = (points[k] - middle) * scale;
        return result;
    }
    Vec3 out_of(const Vec3& point) const { return point / scale + middle; }
};

// What stays the same from round to round.
struct FitReference {
    Mesh mesh;
    std::vector<Vec3> normals;
    ClosestPointTree tree;
    Mesh curve;
    ClosestPointTree curve_tree;

    explicit FitReference(Mesh input);
};

struct ImageSurface;

class Fitter {
  public:
    Fitter(const std::vector<Vec3>& start, const FitReference& reference, const GridGluing& gluing,
           const FitFrame& frame, const FitOptions& options);

    const std::vector<Vec3>& positions() const { return x_; }
    const std::vector<bool>& held() const { return held_; }
    FitQuality quality() const;
    // In the frame; equal within a class.
    void place(std::vector<Vec3> positions) { x_ = std::move(positions); }

    // Where faces look away from the surface, slides the samples around them along it towards the middle of their
    // neighbours. Sampling leaves such faces where the map squeezes the surface: its rows are then nearer to each other
    // than the map of a triangle mesh is smooth. Samples stay near where they were, or those at a tip would slide off it.
    void unfold();

    // Begins a round: the sampled distances, linearised, a damping and a membrane of strength lambda. density: samples of
    // the reference per face of the image.
    FitSystem linearise(double lambda, double density, uint64_t seed);
    // Ends it. Goes as far as no sample moves more than half its spacing and, if guarded, no steep cell gets steeper.
    void take_step(const std::vector<Vec3>& step, bool guarded);
    // Both, with the least of the energy in between.
    void round(double lambda, double density, uint64_t seed, bool guarded);

  private:
    // Cells with a face that looks, at its centre, away from the reference or nearly so.
    std::vector<uint32_t> steep_cells(const ImageSurface& image);

    // The corners of cells and of the cells next to them, one sample of each class, ascending; without those that may
    // not slide.
    std::vector<uint32_t> samples_around(const std::vector<uint32_t>& cells) const;

    // The samples that are the same surface point as v.
    std::span<const uint32_t> class_around(const uint32_t& v) const;

    // Moves samples half-way to the mean of their neighbours in rows and columns, along the reference, and no further
    // than `reach` from their origin.
    void relax(const std::vector<uint32_t>& samples, const std::vector<Vec3>& origin, double reach);

    // Area and normal at the samples, over the whole fan of a class.
    void find_vertex_frames(const ImageSurface& image);

    std::vector<Pull> pulls_from_reference(const ImageSurface& image, double density, uint64_t seed) const;

    // At least one sample in every face, so that each learns which way the reference looks there.
    std::vector<Pull> pulls_from_image(const ImageSurface& image, double density, uint64_t seed);

    void add_membrane(FitSystem& system, double lambda) const;

    void add_membrane_edge(FitSystem& system, double lambda, uint32_t i, uint32_t j) const;

    // Samples on the input's boundary: free along the curve, held to it across.
    void add_boundary(FitSystem& system) const;

    Vec3 moved(uint32_t v, const Vec3& step) const;

    std::vector<uint32_t> cells_around(const std::vector<uint32_t>& samples) const;

    // Of the given cells, in order, those that would be steep and steeper than now, split as they would then be split.
    std::vector<uint32_t> cells_that_turn_away(const std::vector<Vec3>& target,
                                               const std::vector<uint32_t>& cells) const;

    // The smaller cosine between the faces of a cell and the reference at their centres. The reference's face that was
    // near the cell at the beginning of the round tells when there is no need to look.
    double facing(const std::vector<Vec3>& positions, const std::array<Triangle, 2>& faces, uint32_t cell) const;

    // Cosine above which a face is believed without looking twice.
    static constexpr double kUnsuspicious = 0.7;

    const GridGluing& gluing_;
    const FitReference& reference_;
    std::vector<Vec3> x_;
    std::vector<bool> held_, fixed_;
    std::vector<uint32_t> on_boundary_;
    bool has_curve_ = false;
    double front_ = 1;
    double samples_ = 0;  // defined ones

    // Of the round.
    std::vector<double> vertex_area_;
    std::vector<Vec3> vertex_normal_;
    double mean_area_ = 0;
    std::vector<uint32_t> nearest_reference_face_, face_hint_;
};

// How far an image is from the reference, by fresh samples; folds at the centres of its faces. front: the sign that makes
// the image face outwards.
FitQuality measure(const std::vector<Vec3>& positions, const GridGluing& gluing, const FitReference& reference,
                   const std::vector<bool>& held, double front);
// +1 if most of the image's area looks the way the reference does, else -1.
double front_side(const std::vector<Vec3>& positions, const GridGluing& gluing, const FitReference& reference);

}  // namespace gim
