// Guards the public functions of the library: sets the number of threads and lets no exception out.
#pragma once

#include <tbb/task_arena.h>

#include <exception>
#include <new>
#include <string>

#include "encoder/base/cancelled.h"
#include "gim/encoder.h"

namespace gim {

// Runs `body`, which returns a Result, on `threads` threads (0: all cores). Turns exceptions into an Error.
template <class Body>
auto guarded(uint32_t threads, const Body& body) -> decltype(body()) {
    try {
        tbb::task_arena arena(threads == 0 ? tbb::task_arena::automatic : static_cast<int>(threads));
        return arena.execute(body);
    } catch (const Cancelled& cancelled) {
        return Error{cancelled.stage, "cancelled", true};
    } catch (const std::bad_alloc&) {
        return Error{Stage::kInput, "out of memory; take a smaller mesh or a smaller --size"};
    } catch (const std::exception& e) {
        return Error{Stage::kInput, std::string("internal error: ") + e.what()};
    }
}

}  // namespace gim
