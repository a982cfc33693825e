// The layouts that the encoder knows, in one table.
#pragma once

#include <memory>
#include <span>

#include "encoder/base/result.h"
#include "encoder/base/stage_clock.h"
#include "encoder/layout/layout_images.h"
#include "encoder/squares/make_squares.h"
#include "encoder/surface/mesh.h"
#include "encoder/tiles/make_tiles.h"
#include "gim/encoder.h"

namespace gim {

struct MakeImages {
    const Mesh& mesh;  // clean
    const EncodeOptions& options;
    StageClock& clock;
    const Observer& observer;
    EncodeReport& report;        // gets the figures of the stages
    CutPreferences& cuts;        // squares: empty, usual_cuts(), or the choice of an earlier call
    TileableSurfaces& tileable;  // tiles: with what earlier calls made
    bool may_grow = true;        // takes more samples than the options say rather than fail
};

struct LayoutEntry {
    Layout layout;
    // Runs all stages from the clean mesh to images that are ready to be coded.
    Result<std::unique_ptr<LayoutImages>> (*make)(const MakeImages&);
    // Returns the effective samples of a lossless file (choose_layout.h); 0 if the layout cannot take the mesh.
    double (*effective_samples)(const Mesh&, const EncodeOptions&, StageClock&);
    bool races = false;  // lossy files: worth a trial
};

// Returns the layouts in the order that --layout auto prefers where nothing else tells them apart.
std::span<const LayoutEntry> all_layouts();

// Returns null if the encoder does not know the layout. layout: not kAuto.
const LayoutEntry* find_layout(Layout layout);

}  // namespace gim
