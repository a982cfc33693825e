// Cuts the caller's scratch into arrays. Without memory it only counts, so that one function sizes and lays out.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gim {

class Arena {
  public:
    static constexpr size_t kAlignment = 64;

    // memory: nullptr to count.
    explicit Arena(void* memory) : memory_(static_cast<std::byte*>(memory)) {}

    // Returns an uninitialised array of a trivial T. Write its contents before you read them.
    template <class T>
    T* take(size_t count) {
        T* array = memory_ ? reinterpret_cast<T*>(memory_ + used_) : nullptr;
        used_ += (uint64_t{count} * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
        return array;
    }
    uint64_t used() const { return used_; }  // may be more than fits a size_t: then nobody has that much

  private:
    std::byte* memory_;
    uint64_t used_ = 0;
};

}  // namespace gim
