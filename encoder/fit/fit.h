// Fits the samples of an image to the surface that they were taken from: the image's triangles come
// as near to it as their number allows.
//
// After: Sander, Wood, Gortler, Snyder, Hoppe. Multi-Chart Geometry Images. SGP 2003. Section 4.6 (geometry-image
// optimization), whose point-to-point springs we replace: both surfaces are sampled, the distances count nearly only
// along the normal, a membrane that is relaxed step by step keeps the grid regular, and no face may turn away from the
// surface.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/image/geometry_image.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

struct FitOptions {
    enum class Strength {
        kStiff,  // for coded images: samples hardly slide, so the bytes hardly grow; +3 to +4 dB
        kLoose,  // for lossless and uncompressed images: samples find the surface's creases; +8 to +11 dB
    };
    Strength strength = Strength::kLoose;
    // For starts that fold over hardly anywhere, like packed charts: the time that comparing ways to unfold them takes goes
    // into more and looser rounds.
    bool thorough = false;
    uint32_t rounds = 0;  // 0: as many as the strength needs; more approach the optimum a little further
    uint64_t seed = 1;
    uint32_t threads = 0;         // 0: all cores; the result does not depend on it
    std::vector<bool> held = {};  // empty, or per sample: stays where it is, and the faces at it are not compared
};

// Both one-way RMS distances are in the unit of the mesh.
struct FitQuality {
    double to_image = 0;      // reference -> image
    double to_reference = 0;  // image -> reference
    // Faces that look away from the reference at their centre. On scanned models most of a sampled image's folds are
    // slivers, a tenth of a spacing high and two wide, that lie flat in the surface but upside down: rows of samples that
    // cross where the map squeezes the surface. A closest point on another sheet is no noticeable part of the count: the
    // face under the centre in the parametrization gives the same answer but for 1 to 3 % of them (block: 9 %).
    uint64_t folds = 0;
};

struct Fitted {
    std::vector<Vec3> positions;  // of all samples; those of the start where undefined
    FitQuality before, after;
    uint32_t rounds = 0;
    bool improved = false;  // false: the positions are the start's
};

// In:  samples that are at (nearly) equal positions where they are glued, and the oriented surface they were taken from.
//      Samples on input boundaries stay on the reference's boundary curve.
// Out: samples whose surface is nowhere cracked, no worse than the start in either one-way distance, and with no more
//      folds; or the start itself where the fit did not manage that.
// Cost: O(samples + reference) a round; 257 x 257 loose: some seconds on two cores. The same result for any thread
// count.
Result<Fitted> fit(const GeometryImage& start, const Mesh& reference, const FitOptions& options,
                   const Progress& progress = {});

// How far an image is from a surface, and how often it folds over.
Result<FitQuality> measure_fit(const GeometryImage& image, const Mesh& reference, const std::vector<bool>& held = {},
                               uint32_t threads = 0);

}  // namespace gim
