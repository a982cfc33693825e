// Bounds the memory that a file may expand to. A few bytes can claim billions of elements.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "gim/encoder.h"

namespace gim {

// Half of the machine's memory, in bytes. 2 GiB if the system does not tell.
uint64_t default_max_memory();

// Adds up what a file's contents take. Ask it before memory is taken.
class MemoryBudget {
  public:
    MemoryBudget() = default;
    explicit MemoryBudget(uint64_t limit) : limit_(limit) {}

    // Counts `count` things of `bytes_each`, and for ever. If they go over the limit, counts nothing and returns an
    // error that says "`what` take ... of memory", as in "its 12 vertices".
    Result<void> take(uint64_t count, uint64_t bytes_each, std::string_view what);
    // The same for things that come one by one. The caller makes the error with over_limit().
    bool try_take(uint64_t bytes) {
        if (bytes > limit_ - taken_) return false;
        taken_ += bytes;
        return true;
    }
    // "`what` ..., more than the ... that --max-memory allows": begin with a subject and a verb.
    Error over_limit(const std::string& what) const;
    uint64_t left() const { return limit_ - taken_; }

  private:
    uint64_t limit_ = default_max_memory();
    uint64_t taken_ = 0;
};

}  // namespace gim
