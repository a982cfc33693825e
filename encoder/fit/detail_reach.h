// Which samples and cells of an image change when one wavelet detail of a part of it changes.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "encoder/code/detail_response.h"
#include "encoder/code/wavelet_analysis.h"
#include "encoder/image/gluing.h"
#include "format/seam.h"

namespace gim {

// A part of an image that is coded by itself: all of a square, or the box of a chart.
struct CodedPart {
    uint32_t columns = 0, rows = 0;
    int32_t column = 0, row = 0;       // of its first sample, in the image; a box may begin outside
    const SeamTable* seams = nullptr;  // of a square whose mates share their details
    std::vector<uint8_t> defined;      // per sample; empty: all are
};

// Returns the sample of an image of this width that a part's sample is; kNone if it is not defined.
uint32_t sample_of_part(const CodedPart& part, uint32_t width, uint32_t row, uint32_t column);

// A detail of a part.
struct PlaceInPart {
    uint32_t part, depth;  // depth: 1 for the finest
    Orientation orientation;
    uint32_t row, column;  // in the band
};

struct DetailReach {
    using Samples = std::vector<std::pair<uint32_t, float>>;  // with their weights

    Samples samples;              // those that move
    std::vector<uint32_t> cells;  // those at them that count
    Samples corners;              // those that move and are corners of the cells
};

class DetailReaches {
  public:
    // Keeps references to gluing, parts and responses. responses: of each part. bands: of each part; only their sizes
    // count. deepest: depth of the coarsest details.
    DetailReaches(const GridGluing& gluing, const std::vector<CodedPart>& parts,
                  std::vector<DetailResponses>& responses, std::span<const Pyramid<int32_t>> bands, uint32_t deepest);

    // Returns the place whose integers the coder takes: a copy's source, else the place itself.
    PlaceInPart source_of(const PlaceInPart& place) const;

    // Returns the part that the cell's samples belong to.
    uint32_t part_of(uint32_t cell) const;

    // Returns what the detail moves, together with its copies, after samples at one surface point went to their mean. The
    // cells that count are those whose margin is at most `most`. margin: per cell. The reference holds until the next
    // call. O(samples that move).
    const DetailReach& find(const PlaceInPart& place, std::span<const double> margin, double most);

  private:
    struct Copy {
        DetailPlace source, copy;
    };
    struct Depth {
        OwnSharedRim rim;
        std::vector<Copy> copies;
    };

    void find_owners();
    void add_sample(uint32_t v, float weight);
    void add_block(const CodedPart& part, const ResponseBlock& block);
    void spread_over_classes();

    const GridGluing& gluing_;
    const std::vector<CodedPart>& parts_;
    std::vector<DetailResponses>& responses_;
    std::vector<std::vector<Depth>> depths_;  // per part, finest first
    std::vector<uint32_t> owner_;             // part of each sample
    DetailReach reach_;
    // Marks of the last search, so that nothing needs clearing.
    uint32_t stamp_ = 0;
    std::vector<uint32_t> sample_stamp_, sample_slot_, corner_stamp_, cell_stamp_;
};

}  // namespace gim
