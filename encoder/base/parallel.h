// Loops over fixed-size blocks, so that results (ordered sums, per-block state) do not depend on the number of threads.
#pragma once

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace gim {

// Runs `work`. Parallel loops in it use at most `threads` threads. 0: keeps the limit of the caller.
template <class Work>
void with_threads(uint32_t threads, const Work& work) {
    if (threads == 0) {
        work();
    } else {
        tbb::task_arena(static_cast<int>(threads)).execute(work);
    }
}

// Calls body(block, begin, end) once for every block of `block_size` indices of [0, count), concurrently and in any
// order. `threads`: as for with_threads().
template <class Body>
void parallel_blocks(size_t count, size_t block_size, uint32_t threads, const Body& body) {
    const size_t blocks = (count + block_size - 1) / block_size;
    const auto run = [&](size_t b) { body(b, b * block_size, std::min(count, (b + 1) * block_size)); };
    if (threads == 1 || blocks <= 1) {
        for (size_t b = 0; b < blocks; ++b) run(b);
        return;
    }
    with_threads(threads, [&] { tbb::parallel_for(size_t{0}, blocks, run); });
}

// Returns the sum of term(i) over [0, count). Adds up blocks in parallel, then the block sums in order.
template <class Term>
double parallel_sum(size_t count, uint32_t threads, const Term& term) {
    constexpr size_t kBlock = 4096;
    std::vector<double> partial((count + kBlock - 1) / kBlock, 0.0);
    parallel_blocks(count, kBlock, threads, [&](size_t block, size_t begin, size_t end) {
        double sum = 0;
        for (size_t i = begin; i < end; ++i) sum += term(i);
        partial[block] = sum;
    });
    double total = 0;
    for (const double sum : partial) total += sum;
    return total;
}

}  // namespace gim
