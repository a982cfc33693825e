// All runs of one layout for one surface. A run makes images by one variant of the options and codes them. Variants are
// sides of the square and numbers of tiles.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/code/contest.h"
#include "encoder/file_run.h"
#include "encoder/layout/encode_once.h"
#include "encoder/layouts.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// The input, ready for a layout. Positions are in the frame.
struct Prepared {
    const Mesh& mesh;  // clean
    const Original original;
    const EncodeReport& report;  // of the input alone
    const AuthoredEdges& authored;
};

class LayoutRuns {
  public:
    // Keeps references to what it gets, except for the options. observer: sees the first images that are made.
    LayoutRuns(const LayoutEntry& layout, const Prepared& prepared, const EncodeOptions& options, StageClock& clock,
               const Observer& observer);

    Layout layout() const { return layout_.layout; }

    // Sets another target that needs the same images, and a quantizer that may be near to its own. Only before the first
    // estimate.
    void aim(const RateTarget& rate, double near) {
        options_.rate = rate;
        near_ = near;
    }

    // Makes the images of the first side, or of the tiles that are likely to be tried, and does not use the clock. They wait for
    // the calls below, which also tell what fails. Does nothing where the cut is chosen, or somebody looks on.
    void make_ahead();

    // Makes the images of the variant that comes first, and fits them briefly. Returns what it costs. Squares are cut the
    // usual way, without a choice. Only for targets that are searched for. Images of tiles wait for estimate() and best().
    Result<Estimate> first_estimate();

    // Makes the images of the variants and fits them briefly. Returns what the best one costs. Only for targets that are
    // searched for. The images wait for best().
    Result<Estimate> estimate();

    // Returns the best file of all variants. contest: the files of other layouts. A run that is sure to lose ends early;
    // if all do, returns an Error.
    Result<Encoded> best(const Contest& contest);

  private:
    struct Made {
        std::unique_ptr<LayoutImages> images;
        EncodeReport report;
    };
    struct Started {
        std::optional<Made> made;  // ahead; empty once it runs
        std::unique_ptr<FileRun> run;
        std::optional<Estimate> estimate;
    };
    using Variant = std::tuple<uint32_t, uint32_t, uint32_t, bool>;  // side, samples, tiles, creases
    static Variant variant_of(const EncodeOptions& now) { return {now.side, now.samples, now.tiles, now.creases}; }

    CodingRuns runs(const Contest& contest);
    Result<Encoded> best_of_variants(const EncodeOptions& now, const Contest& contest);
    Result<Started*> start(const EncodeOptions& now);
    void make_all_ahead(const std::vector<EncodeOptions>& all);
    struct Waiting {
        const EncodeOptions* options;
        Started* started;
    };
    std::vector<Waiting> waiting_for(const std::vector<EncodeOptions>& all);
    void make_quietly(const Waiting& waiting);
    Result<Made> make(const EncodeOptions& now, const Observer& observer, CutPreferences& cuts, StageClock& clock);
    std::unique_ptr<FileRun> run_of(Made made, const EncodeOptions& now);
    Result<Estimate> estimate_without_choice(const EncodeOptions& now);
    Result<Estimate> estimate_of(const EncodeOptions& now, std::optional<double> near);

    const LayoutEntry& layout_;
    const Prepared& prepared_;
    EncodeOptions options_;
    std::optional<double> near_;  // a quantizer to begin with
    StageClock& clock_;
    Observer observer_;                   // none when it has seen images
    CutPreferences cuts_;                 // chosen at the first side, then kept
    TileableSurfaces tileable_;           // serve every number of tiles
    std::map<Variant, Started> started_;  // that did not end yet
};

// Returns whether the images could not be made.
template <class T>
bool lacks_images(const Result<T>& result) {
    return !result.ok() && result.error().stage >= Stage::kCut && result.error().stage <= Stage::kFit;
}

}  // namespace gim
