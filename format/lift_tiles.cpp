#include "format/lift_tiles.h"

namespace gim {

template <class Lift>
void lift_tile_rows(const LiftStep& step, void* samples, const RowBlock& block) {
    using Sample = typename Lift::Sample;
    const Lift lift(step);
    auto* s = static_cast<Sample*>(samples);
    const auto gapless = static_cast<ptrdiff_t>(block.count);
    const bool is_one = block.target.stride == gapless && block.a.stride == gapless && block.b.stride == gapless;
    const uint32_t rows = is_one ? 1 : block.rows;
    const size_t count = is_one ? block.count * block.rows : block.count;
    for (uint32_t row = 0; row < rows; ++row) {
        const Sample *a = s + block.a.at(row), *b = s + block.b.at(row);
        lift_numbers(lift, s + block.target.at(row), a, b, count);
    }
}

template <class Lift>
void lift_edge(const LiftStep& step, void* samples, const EdgeRun& run) {
    const Lift lift(step);
    auto* s = static_cast<typename Lift::Sample*>(samples);
    for (uint32_t i = 0; i < run.count; ++i) {
        auto *own = s + run.target.at(i), *copy = s + run.copy.at(i);
        const auto *a = s + run.a.at(i), *b = s + run.b.at(i);
        for (size_t k = 0; k < 3; ++k) {
            own[k] = lift(own[k], a[k], b[k]);
            if (run.has_copy) copy[k] = own[k];
        }
    }
}

template void lift_tile_rows<LiftInteger>(const LiftStep&, void*, const RowBlock&);
template void lift_tile_rows<LiftFloat>(const LiftStep&, void*, const RowBlock&);
template void lift_edge<LiftInteger>(const LiftStep&, void*, const EdgeRun&);
template void lift_edge<LiftFloat>(const LiftStep&, void*, const EdgeRun&);

}  // namespace gim
