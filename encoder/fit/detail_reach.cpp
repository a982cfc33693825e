#include "encoder/fit/detail_reach.h"

#include <algorithm>

namespace gim {

ReachFinder::ReachFinder(const GridGluing& gluing)
    : gluing_(gluing),
      sample_stamp_(gluing.sample_count(), 0),
      sample_slot_(gluing.sample_count(), 0),
      corner_stamp_(gluing.sample_count(), 0),
      cell_stamp_(gluing.kind.size(), 0) {}

const DetailReach& ReachFinder::find(const WeightedSamples& moved, std::span<const double> margin, double most) {
    reach_.samples.clear();
    reach_.cells.clear();
    reach_.corners.clear();
    ++stamp_;
    for (const auto& [v, weight] : moved) add_sample(v, weight);
    spread_over_classes();
    for (const auto& [v, weight] : reach_.samples) {
        for_each_cell_at(gluing_, v, [&](uint32_t cell) {
            if (cell_stamp_[cell] == stamp_ || gluing_.kind[cell] == CellKind::kEmpty) return;
            cell_stamp_[cell] = stamp_;
            if (margin[cell] <= most) reach_.cells.push_back(cell);
        });
    }
    for (const uint32_t cell : reach_.cells) {
        for (const uint32_t v : gluing_.corners(cell)) {
            if (sample_stamp_[v] != stamp_ || corner_stamp_[v] == stamp_) continue;
            corner_stamp_[v] = stamp_;
            reach_.corners.push_back(reach_.samples[sample_slot_[v]]);
        }
    }
    return reach_;
}

void ReachFinder::add_sample(uint32_t v, float weight) {
    if (sample_stamp_[v] != stamp_) {
        sample_stamp_[v] = stamp_;
        sample_slot_[v] = static_cast<uint32_t>(reach_.samples.size());
        reach_.samples.push_back({v, 0.0f});
    }
    reach_.samples[sample_slot_[v]].second += weight;
}

// Glued samples move by the mean over their class.
void ReachFinder::spread_over_classes() {
    const size_t count = reach_.samples.size();
    std::vector<uint32_t> classes;
    for (size_t i = 0; i < count; ++i) {
        const uint32_t c = gluing_.class_of[reach_.samples[i].first];
        if (c != kNone) classes.push_back(c);
    }
    std::sort(classes.begin(), classes.end());
    classes.erase(std::unique(classes.begin(), classes.end()), classes.end());
    for (const uint32_t c : classes) {
        const auto& members = gluing_.shared[c];
        for (const uint32_t v : members) add_sample(v, 0);
        float sum = 0;
        for (const uint32_t v : members) sum += reach_.samples[sample_slot_[v]].second;
        for (const uint32_t v : members)
            reach_.samples[sample_slot_[v]].second = sum / static_cast<float>(members.size());
    }
}

}  // namespace gim
