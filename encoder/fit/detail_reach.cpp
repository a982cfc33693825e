#include "encoder/fit/detail_reach.h"

#include <algorithm>

namespace gim {

uint32_t sample_of_part(const CodedPart& part, uint32_t width, uint32_t row, uint32_t column) {
    if (!part.defined.empty() && !part.defined[size_t{row} * part.columns + column]) return kNone;
    return static_cast<uint32_t>(part.row + static_cast<int32_t>(row)) * width +
           static_cast<uint32_t>(part.column + static_cast<int32_t>(column));
}

DetailReaches::DetailReaches(const GridGluing& gluing, const std::vector<CodedPart>& parts,
                             std::vector<DetailResponses>& responses, std::span<const Pyramid<int32_t>> bands,
                             uint32_t deepest)
    : gluing_(gluing),
      parts_(parts),
      responses_(responses),
      sample_stamp_(gluing.sample_count(), 0),
      sample_slot_(gluing.sample_count(), 0),
      corner_stamp_(gluing.sample_count(), 0),
      cell_stamp_(gluing.kind.size(), 0) {
    for (size_t p = 0; p < parts_.size(); ++p) {
        std::vector<Depth>& depths = depths_.emplace_back();
        const uint32_t steps = bands[p].steps();
        for (uint32_t depth = 1; depth <= std::min(deepest, steps); ++depth) {
            depths.push_back({OwnSharedRim(parts_[p].seams, bands[p].columns_at(steps - depth + 1)), {}});
            const SharedRim rim = depths.back().rim.view();
            rim.for_each_copy([&](Orientation orientation, uint32_t row, uint32_t column) {
                depths.back().copies.push_back({rim.source_of(orientation, row, column), {orientation, row, column}});
            });
        }
    }
    find_owners();
}

void DetailReaches::find_owners() {
    owner_.assign(gluing_.sample_count(), 0);
    if (parts_.size() == 1) return;
    for (uint32_t p = 0; p < parts_.size(); ++p) {
        const CodedPart& part = parts_[p];
        for (uint32_t row = 0; row < part.rows; ++row) {
            for (uint32_t column = 0; column < part.columns; ++column) {
                const uint32_t v = sample_of_part(part, gluing_.width, row, column);
                if (v != kNone) owner_[v] = p;
            }
        }
    }
}

PlaceInPart DetailReaches::source_of(const PlaceInPart& place) const {
    const SharedRim rim = depths_[place.part][place.depth - 1].rim.view();
    if (!rim.is_copy(place.orientation, place.row, place.column)) return place;
    const DetailPlace from = rim.source_of(place.orientation, place.row, place.column);
    return {place.part, place.depth, from.orientation, from.row, from.column};
}

uint32_t DetailReaches::part_of(uint32_t cell) const {
    for (const uint32_t v : gluing_.corners(cell)) {
        if (gluing_.is_defined(v)) return owner_[v];
    }
    return 0;
}

const DetailReach& DetailReaches::find(const PlaceInPart& place, std::span<const double> margin, double most) {
    reach_.samples.clear();
    reach_.cells.clear();
    reach_.corners.clear();
    ++stamp_;
    const CodedPart& part = parts_[place.part];
    DetailResponses& responses = responses_[place.part];
    add_block(part, responses.at(place.depth, place.orientation, place.row, place.column));
    for (const auto& [source, copy] : depths_[place.part][place.depth - 1].copies) {
        if (source.orientation == place.orientation && source.row == place.row && source.column == place.column)
            add_block(part, responses.at(place.depth, copy.orientation, copy.row, copy.column));
    }
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

void DetailReaches::add_sample(uint32_t v, float weight) {
    if (sample_stamp_[v] != stamp_) {
        sample_stamp_[v] = stamp_;
        sample_slot_[v] = static_cast<uint32_t>(reach_.samples.size());
        reach_.samples.push_back({v, 0.0f});
    }
    reach_.samples[sample_slot_[v]].second += weight;
}

void DetailReaches::add_block(const CodedPart& part, const ResponseBlock& block) {
    const float* weight = block.weights;
    for (uint32_t row = block.row; row < block.row + block.rows; ++row) {
        for (uint32_t column = block.column; column < block.column + block.columns; ++column, ++weight) {
            const uint32_t v = sample_of_part(part, gluing_.width, row, column);
            if (v != kNone) add_sample(v, *weight);
        }
    }
}

// Glued samples move by the mean over their class.
void DetailReaches::spread_over_classes() {
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
