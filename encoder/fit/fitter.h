// A fit in progress: image and reference, their sampled distances as a quadratic energy of the samples' displacements,
// and steps that fold nothing over. fit.cpp explains the energy. The caller chooses its terms other than the distances.
//
// Everything runs in a frame where the reference's bounding box has diagonal 1.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "encoder/fit/fit.h"
#include "encoder/fit/fit_system.h"
#include "encoder/fit/rail_guide.h"
#include "encoder/image/gluing.h"
#include "encoder/surface/closest_point.h"
#include "encoder/surface/mesh.h"

namespace gim {

// The frame, with maps into it and out of it.
struct FitFrame {
    Vec3 middle = Vec3::Zero();
    double scale = 1;  // frame units per input unit

    explicit FitFrame(const Mesh& mesh);
    std::vector<Vec3> into(const std::vector<Vec3>& points) const {
        std::vector<Vec3> result(points.size());
        for (size_t k = 0; k < points.size(); ++k) result[k] = (points[k] - middle) * scale;
        return result;
    }
    Rails into(Rails rails) const {
        for (std::vector<Vec3>& curve : rails.curves) curve = into(curve);
        return rails;
    }
    Vec3 out_of(const Vec3& point) const { return point / scale + middle; }
};

// Returns the boundary edges of a mesh, as triangles without area.
Mesh boundary_curve(const Mesh& mesh);

// The reference, prepared once for all rounds.
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
    // The sign that makes the image face outwards.
    double front() const { return front_; }
    // Whether it has so many samples that few of their distances tell where a round should go.
    bool is_large() const { return samples_ >= kManySamples; }
    FitQuality quality();
    uint64_t folds() const;  // the same number as in quality()
    // positions: in the frame; equal within a class.
    void place(std::vector<Vec3> positions) { x_ = std::move(positions); }
    // The same, and forgets what earlier rounds told of the reference.
    void begin_at(std::vector<Vec3> positions);

    // Slides the samples around faces that look away from the surface. They move along the surface, towards the middle
    // of their neighbours. Sampling leaves such faces where the map squeezes the surface: rows are then too near to
    // each other for the map of a triangle mesh to be smooth. Samples stay near their place; else those at a tip would
    // slide off it: a quarter of the mean spacing away at most, and no more than `most`.
    void unfold(double most = std::numeric_limits<double>::infinity());

    // Begins a round. Returns the linearised sampled distances, a damping, and a membrane of strength lambda. density:
    // samples of the reference per face of the image.
    FitSystem linearise(double lambda, double density, uint64_t seed);
    // Ends a round. Moves no sample more than half its spacing. If guarded, makes no steep cell steeper.
    void take_step(const std::vector<Vec3>& step, bool guarded);
    // Does both, and minimises the energy in between.
    void round(double lambda, double density, uint64_t seed, bool guarded);

  private:
    // Returns cells with a face that looks away, or almost away, from the reference at its centre.
    std::vector<uint32_t> steep_cells(const ImageSurface& image);

    // Returns the corners of the cells and of their neighbours that may slide: one sample of each class, ascending.
    std::vector<uint32_t> samples_around(const std::vector<uint32_t>& cells) const;

    // Returns the samples at the same surface point as v.
    std::span<const uint32_t> class_around(const uint32_t& v) const;

    // Moves samples half-way to the mean of their row and column neighbours, along the reference, at most `reach` away
    // from their origin.
    void relax(const std::vector<uint32_t>& samples, const std::vector<Vec3>& origin, double reach);

    // Finds area and normal at the samples, over the whole fan of a class.
    void find_vertex_frames(const ImageSurface& image);

    std::vector<Pull> pulls_from_reference(const ImageSurface& image, double density, uint64_t seed);

    // Takes at least one sample in every face, so that each face learns which way the reference looks there.
    std::vector<Pull> pulls_from_image(const ImageSurface& image, double density, uint64_t seed);

    void add_membrane(FitSystem& system, double lambda) const;

    void add_membrane_edge(FitSystem& system, double lambda, uint32_t i, uint32_t j) const;

    // Holds samples on the input's boundary to its curve, and those on rails to them. They may slide along.
    void add_boundary(FitSystem& system) const;
    void add_rails(FitSystem& system) const;

    Vec3 moved(uint32_t v, const Vec3& step) const;

    std::vector<uint32_t> cells_around(const std::vector<uint32_t>& samples) const;

    // Returns, in order, the given cells that would be steep and steeper than now. Cells are split as at the target.
    std::vector<uint32_t> cells_that_turn_away(const std::vector<Vec3>& target,
                                               const std::vector<uint32_t>& cells) const;

    // Returns the smaller cosine between the faces of a cell and the reference at their centres. Skips the search if
    // the reference face that was nearest at the beginning of the round is clear enough.
    double facing(const std::vector<Vec3>& positions, const std::array<Triangle, 2>& faces, uint32_t cell) const;

    // Cosine above which no search is needed.
    static constexpr double kUnsuspicious = 0.7;
    static constexpr double kManySamples = 16000;

    const GridGluing& gluing_;
    const FitReference& reference_;
    RailGuide rails_;
    std::vector<Vec3> x_;
    std::vector<bool> held_, fixed_;
    std::vector<uint32_t> on_boundary_;
    bool has_curve_ = false;
    double front_ = 1;
    double samples_ = 0;  // number of defined samples

    // State of the round.
    std::vector<double> vertex_area_;
    std::vector<Vec3> vertex_normal_;
    double mean_area_ = 0;
    std::vector<uint32_t> nearest_reference_face_, face_hint_;

    // Kept from round to round for its shape, which decides the time alone.
    ClosestPointTree image_tree_{Mesh{}};
};

// Measures how far an image is from the reference, by fresh samples, and its folds at the centres of its faces. front:
// the sign that makes the image face outwards. tree: of an earlier state of the image, or of nothing; becomes that of this one.
FitQuality measure(const std::vector<Vec3>& positions, const GridGluing& gluing, const FitReference& reference,
                   const std::vector<bool>& held, double front, ClosestPointTree& tree);
// Returns +1 if most of the image's area looks the same way as the reference, else -1.
double front_side(const std::vector<Vec3>& positions, const GridGluing& gluing, const FitReference& reference);

}  // namespace gim
