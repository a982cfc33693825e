#include "encoder/fit/fold_passes.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <utility>

#include "encoder/fit/fold_changes.h"

namespace gim {

namespace {

constexpr uint32_t kDeepest = 3;       // depth of the coarsest details that are changed without decoding again
constexpr uint32_t kDeepestTried = 5;  // depth of the coarsest details that are tried
constexpr uint32_t kApart = 4;         // of cells that are mended at once
constexpr uint32_t kCluster = 3;       // reach of a cluster of folded cells
constexpr size_t kFewest = 2;          // folded cells of a cluster that is worth a coarser detail
constexpr size_t kTrials = 8;          // changes tried for a cluster
constexpr size_t kTrialsAtOnce = 2;
constexpr double kMostFolded = 0.03;  // part of the cells; where more seem folded, sheets lie on each other

}  // namespace

class FoldPass {
  public:
    FoldPass(FoldPasses& passes, CodedImage& image, const RepairEffort& effort)
        : r_(passes),
          image_(image),
          state_({passes.gluing_, passes.reference_, passes.frame_, passes.front_}, image, effort, passes.nearest_),
          finders_([this] { return FoldChanges(state_); }) {}

    // Changes fine details. Returns the number of changes.
    size_t run() {
        if (are_too_many()) return 0;
        size_t changes = 0;
        std::vector<uint32_t> waiting = state_.steep_cells();
        while (true) {
            std::erase_if(waiting, [&](uint32_t cell) { return r_.is_stuck_[cell] || state_.cost(cell) == 0; });
            if (waiting.empty()) return changes;
            const std::vector<uint32_t> cells = cells_apart(waiting);
            const auto found = best_around(cells, 1, kDeepest, 1);
            std::vector<uint8_t> is_done(r_.gluing_.kind.size(), 0);
            for (size_t i = 0; i < cells.size(); ++i) {
                is_done[cells[i]] = found[i].empty() || apply_if_it_still_pays(found[i][0]);
                r_.is_stuck_[cells[i]] = found[i].empty();
                changes += is_done[cells[i]] && !found[i].empty();
            }
            std::erase_if(waiting, [&](uint32_t cell) { return is_done[cell]; });
        }
    }

    // Tries coarser details where several neighbours are folded. Decodes for each trial, because the frames of finer
    // details turn with a coarser one. Returns the number of changes.
    size_t run_coarse() {
        if (are_too_many()) return 0;
        const std::vector<uint32_t> cells = clusters();
        const auto found = best_around(cells, kDeepest + 1, kDeepestTried, kTrials);
        std::vector<Waiting> waiting;
        for (size_t i = 0; i < cells.size(); ++i) waiting.push_back({cells[i], found[i]});
        size_t changes = 0;
        while (true) {
            std::erase_if(waiting, [&](const Waiting& w) { return w.changes.empty() || state_.cost(w.cell) == 0; });
            if (waiting.empty()) return changes;
            changes += apply_those_that_pay(waiting);
        }
    }

  private:
    bool are_too_many() const {
        return static_cast<double>(state_.steep_cells().size()) >
               kMostFolded * static_cast<double>(r_.gluing_.kind.size());
    }

    template <class Body>
    void for_each_cell_near(uint32_t cell, uint32_t reach, const Body& body) const {
        const uint32_t columns = r_.gluing_.width - 1, row = cell / columns, column = cell % columns;
        for (uint32_t r = row - std::min(row, reach); r <= std::min(row + reach, r_.gluing_.height - 2); ++r) {
            for (uint32_t c = column - std::min(column, reach); c <= std::min(column + reach, columns - 1); ++c)
                body(r * columns + c);
        }
    }

    // Returns cells none of which is near another one.
    std::vector<uint32_t> cells_apart(const std::vector<uint32_t>& cells) const {
        std::vector<uint8_t> is_near(r_.gluing_.kind.size(), 0);
        std::vector<uint32_t> apart;
        for (const uint32_t cell : cells) {
            if (is_near[cell]) continue;
            apart.push_back(cell);
            for_each_cell_near(cell, kApart, [&](uint32_t other) { is_near[other] = 1; });
        }
        return apart;
    }

    // Returns a cell of each cluster of folded cells.
    std::vector<uint32_t> clusters() const {
        std::vector<uint8_t> is_done(r_.gluing_.kind.size(), 0), is_steep(is_done.size(), 0);
        for (const uint32_t cell : state_.steep_cells()) is_steep[cell] = 1;
        std::vector<uint32_t> cells;
        for (const uint32_t cell : state_.steep_cells()) {
            if (is_done[cell] || state_.cost(cell) == 0) continue;
            size_t folded = 0;
            for_each_cell_near(cell, kCluster, [&](uint32_t other) { folded += is_steep[other]; });
            if (folded < kFewest) continue;
            for_each_cell_near(cell, 2 * kCluster, [&](uint32_t other) { is_done[other] = 1; });
            cells.push_back(cell);
        }
        return cells;
    }

    // A thread has a finder of its own. A search runs nothing in parallel, so a finder serves one search at a time.
    std::vector<std::vector<DetailChange>> best_around(const std::vector<uint32_t>& cells, uint32_t from_depth,
                                                       uint32_t to_depth, size_t most) {
        std::vector<std::vector<DetailChange>> found(cells.size());
        tbb::parallel_for(size_t{0}, cells.size(), [&](size_t i) {
            found[i] = finders_.local().best_around(cells[i], from_depth, to_depth, most);
        });
        return found;
    }

    // Returns whether it does. It may not, if another change came first.
    bool apply_if_it_still_pays(const DetailChange& change) {
        if (finders_.local().cost_of(change) > -kLeastFoldGain) return false;
        change_integer(change);
        const WeightedSamples samples = finders_.local().reach_of(change.place).samples;
        for (const uint32_t cell : state_.move(samples, change.shift)) r_.is_stuck_[cell] = 0;
        return true;
    }

    void change_integer(const DetailChange& change) {
        const PlaceInPart& p = change.place;
        image_.band(p).row(p.row)[3 * p.column + change.component] += change.by;
    }

    // A cell whose cluster waits for a change, and the changes to try, best first.
    struct Waiting {
        uint32_t cell;
        std::span<const DetailChange> changes;
    };
    struct Trial {
        FoldState::Move move;
        double cost = 0;
    };

    Trial trial_of(const DetailChange& change) {
        const PlaceInPart& p = change.place;
        Trial trial{state_.move_to(image_.decode_changed(p, change.component, change.by)), 0};
        trial.cost = state_.bits_of(p, change.component, change.by) + trial.move.fold_cost +
                     finders_.local().distance_cost_of(trial.move.x, trial.move.samples);
        return trial;
    }

    // Tries the next change of the first ones that wait, at once. Applies those that pay, but of two that mend or fold the same
    // cells only the first; the other one is tried again. Returns how many it applies.
    size_t apply_those_that_pay(std::vector<Waiting>& waiting) {
        std::array<Trial, kTrialsAtOnce> trials;
        const size_t count = std::min(kTrialsAtOnce, waiting.size());
        tbb::parallel_for(size_t{0}, count, [&](size_t i) { trials[i] = trial_of(waiting[i].changes[0]); });
        std::vector<bool> is_taken(r_.gluing_.kind.size(), false);
        std::vector<Trial*> applied;
        for (size_t i = 0; i < count; ++i) {
            Trial& trial = trials[i];
            const std::vector<uint32_t>& cells = trial.move.refolded;
            const bool pays = trial.cost < -kLeastFoldGain;
            if (pays && std::any_of(cells.begin(), cells.end(), [&](uint32_t cell) { return is_taken[cell]; }))
                continue;
            if (pays) {
                change_integer(waiting[i].changes[0]);
                applied.push_back(&trial);
                for (const uint32_t cell : cells) is_taken[cell] = true;
            }
            waiting[i].changes = pays ? std::span<const DetailChange>{} : waiting[i].changes.subspan(1);
        }
        if (applied.size() == 1) take(std::move(applied[0]->move));
        if (applied.size() > 1) take(state_.move_to(image_.decode()));
        return applied.size();
    }

    void take(FoldState::Move move) {
        for (const uint32_t cell : move.cells) r_.is_stuck_[cell] = 0;
        state_.take(std::move(move));
    }

    FoldPasses& r_;
    CodedImage& image_;
    FoldState state_;
    tbb::enumerable_thread_specific<FoldChanges> finders_;
};

FoldPasses::FoldPasses(const GridGluing& gluing, const FitReference& reference, const FitFrame& frame, double front)
    : gluing_(gluing),
      frame_(frame),
      reference_(reference),
      front_(front),
      nearest_(2 * gluing.kind.size(), kNone),
      is_stuck_(gluing.kind.size(), 0) {}

void FoldPasses::repair(CodedImage& image, const RepairEffort& effort) {
    // What an earlier call found must not change the result.
    std::fill(nearest_.begin(), nearest_.end(), kNone);
    std::fill(is_stuck_.begin(), is_stuck_.end(), uint8_t{0});
    for (int pass = 0; pass < effort.passes; ++pass) {
        std::optional<FoldPass> state(std::in_place, *this, image, effort);
        const size_t coarse = pass == effort.passes / 2 ? state->run_coarse() : 0;
        if (coarse > 0) state.emplace(*this, image, effort);
        if (coarse + state->run() == 0) break;
    }
}

}  // namespace gim
