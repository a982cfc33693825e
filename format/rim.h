// The details on the rim of a square image, for one wavelet step. Mates on a cut-path are the same curve, so that one
// detail stands for both.  spec/gim-format.md, "Shared details of the rim".
//
// The rim is transformed by itself, each cut-path as a run of its own (format/lifting.h), so that the two sides of a
// cut-path have the same details.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "format/band.h"
#include "format/lifting.h"
#include "format/seam.h"

namespace gim {

struct DetailPlace {
    Orientation orientation = Orientation::kHorizontal;
    uint32_t row = 0, column = 0;
};

inline constexpr uint32_t kRunEnd = UINT32_MAX;

// Finds the source of each ring sample of an image of that side. An odd sample takes the detail of its source: its mate
// inside a cut-path if that comes earlier in the stream, else itself. An even sample has itself, or kRunEnd at
// cut-nodes and at the mates of the square's corners (corners end runs in any case). Sides up to the node grid's share
// nothing and have no cut-nodes. source.size() == ring_length(side). O(side).
void rim_sources(const SeamTable& seams, uint32_t side, std::span<uint32_t> source);

// A view of the sources of one step. An empty one shares nothing.
class SharedRim {
  public:
    SharedRim() = default;
    SharedRim(const uint32_t* source, uint32_t side) : source_(source), side_(side) {}

    explicit operator bool() const { return source_ != nullptr; }

    // Returns whether the mate stands for the detail at that place of its band.
    bool is_copy(Orientation orientation, uint32_t row, uint32_t column) const {
        if (!source_) return false;
        const GridPoint p = sample_of(orientation, row, column);
        if (orientation == Orientation::kDiagonal || !on_rim(side_, p.row, p.column)) return false;
        const uint32_t k = ring_index(side_, p.row, p.column);
        return source_[k] != k;
    }

    // Returns whether a run ends at rim sample (row, column); both are even.
    bool is_run_end(uint32_t row, uint32_t column) const {
        return source_ && source_[ring_index(side_, row, column)] == kRunEnd;
    }

    // The source of a place on the rim.
    DetailPlace source_of(Orientation orientation, uint32_t row, uint32_t column) const {
        const GridPoint p = sample_of(orientation, row, column);
        const GridPoint from = ring_point(side_, source_[ring_index(side_, p.row, p.column)]);
        return {from.row % 2 == 0 ? Orientation::kHorizontal : Orientation::kVertical, from.row / 2, from.column / 2};
    }

    // Calls f(orientation, row, column) for each copy.
    template <class F>
    void for_each_copy(const F& f) const {
        if (!source_) return;
        for (uint32_t k = 1; k < ring_length(side_); k += 2) {
            if (source_[k] == k) continue;
            const GridPoint p = ring_point(side_, k);
            f(p.row % 2 == 0 ? Orientation::kHorizontal : Orientation::kVertical, p.row / 2, p.column / 2);
        }
    }

  private:
    static GridPoint sample_of(Orientation orientation, uint32_t row, uint32_t column) {
        return {2 * row + (orientation != Orientation::kHorizontal),
                2 * column + (orientation != Orientation::kVertical)};
    }

    const uint32_t* source_ = nullptr;
    uint32_t side_ = 0;
};

// What lifting keeps of an image row. On the rim, cut-nodes end runs of their own. Inner rows keep only their ends.
struct KeepsOfRow {
    const SharedRim& rim;
    uint32_t row, rows;

    bool ends() const { return static_cast<bool>(rim); }
    bool operator()(size_t low) const {
        return (row == 0 || row + 1 == rows) && rim.is_run_end(row, static_cast<uint32_t>(2 * low));
    }
};

// When columns are lifted: the values [begin, end) of an inner row that are lifted, not kept.
inline LiftedRange lifted_part(const SharedRim& rim, uint32_t row, size_t width) {
    return {rim.is_run_end(row, 0) ? 3u : 0u,
            rim.is_run_end(row, static_cast<uint32_t>(width / 3 - 1)) ? width - 3 : width};
}

// An odd step of columns on such a row.
template <class Wavelet, Direction D>
inline void lift_low_row(int step, typename Wavelet::Sample* low, const typename Wavelet::Sample* before,
                         const typename Wavelet::Sample* behind, size_t width, const SharedRim& rim, uint32_t row) {
    const auto [begin, end] = lifted_part(rim, row, width);
    lift_row<Wavelet, D>(step, low + begin, before + begin, behind + begin, end - begin);
    lift_end<Wavelet, D>(step, low, begin);
    lift_end<Wavelet, D>(step, low + end, width - end);
}

// A SharedRim that owns its memory. seams: may be nullptr.
class OwnSharedRim {
  public:
    OwnSharedRim(const SeamTable* seams, uint32_t side) : side_(side) {
        if (!seams) return;
        source_.resize(ring_length(side));
        rim_sources(*seams, side, source_);
    }
    SharedRim view() const { return source_.empty() ? SharedRim() : SharedRim(source_.data(), side_); }

  private:
    std::vector<uint32_t> source_;
    uint32_t side_;
};

}  // namespace gim
