// Fits the samples of an image to their surface: brings the image's triangles as near to it as their number allows.
//
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.6 (geometry-image
// optimization). We replace their point-to-point springs: we sample both surfaces, and distances count almost only
// along the normal. A membrane that is relaxed step by step keeps the grid regular. No face may turn away from the
// surface.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/image/geometry_image.h"
#include "encoder/image/rails.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct FitOptions {
    enum class Strength {
        kStiff,  // for coded images: samples hardly slide, so the bytes hardly grow; +3 to +4 dB
        kLoose,  // for lossless and uncompressed images: samples find the surface's creases; +8 to +11 dB
    };
    Strength strength = Strength::kLoose;
    // For starts with few folds, like packed charts: runs more and looser rounds instead of comparing ways to unfold.
    bool thorough = false;
    uint32_t rounds = 0;  // 0: as many as the strength needs; more come a little nearer to the optimum
    uint64_t seed = 1;
    uint32_t threads = 0;          // 0: all cores; the result does not depend on it
    Rails rails = {};              // that samples stay on
    std::vector<bool> held = {};   // empty, or per sample: the sample does not move, and its faces are not compared
    std::vector<bool> still = {};  // empty, or per sample, the same for all at one point: the sample does not move
};

// One-way RMS distances are in the unit of the mesh.
struct FitQuality {
    double to_image = 0;      // reference -> image
    double to_reference = 0;  // image -> reference
    // Faces that look away from the reference at their centre. On scanned models most folds of a sampled image are
    // slivers, a tenth of a spacing high and two wide. They lie flat in the surface, upside down, where the map
    // squeezes the surface and rows of samples cross. Closest points on another sheet hardly count: the face under the
    // centre in the parametrization gives the same answer for all but 1 to 3 % of the folds (block: 9 %).
    uint64_t folds = 0;
};

struct Fitted {
    std::vector<Vec3> positions;  // of all samples; undefined ones keep the start's
    FitQuality before, after;
    uint32_t rounds = 0;
    bool improved = false;  // false: the positions are those of the start
};

// In:  samples with (nearly) equal positions where they are glued, and the oriented surface they were taken from.
//      Samples on input boundaries stay on the reference's boundary curve.
// Out: samples whose surface has no cracks, no larger one-way distances than the start, and no more folds, or one in
//      some thousands of faces. The start itself if the fit finds no such samples.
// Cost: O(samples + reference) a round; 257 x 257 loose: some seconds on two cores. The result does not depend on the
//       number of threads.
Result<Fitted> fit(const GeometryImage& start, const Mesh& reference, const FitOptions& options,
                   const Progress& progress = {});

// Measures how far an image is from a surface, and how often it folds over.
Result<FitQuality> measure_fit(const GeometryImage& image, const Mesh& reference, const std::vector<bool>& held = {},
                               uint32_t threads = 0);

}  // namespace gim
