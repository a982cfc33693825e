// Does several independent pieces of work at once, each of which may be a few stages.
#pragma once

#include <tbb/parallel_for.h>

#include <cstddef>
#include <mutex>

#include "encoder/base/stage_clock.h"

namespace gim {

// Calls body(i) for every i below count, in any order, several at once. Reports what part of them is done; throws Cancelled if
// the caller wants to stop. The bodies must not use the clock.
template <class Body>
void for_each_at_once(size_t count, const StageClock& clock, const Body& body) {
    std::mutex reporting;
    size_t done = 0;
    tbb::parallel_for(size_t{0}, count, [&](size_t i) {
        body(i);
        const std::lock_guard lock(reporting);
        clock.report(double(++done) / double(count));
    });
}

}  // namespace gim
