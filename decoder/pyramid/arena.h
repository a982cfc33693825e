// Cuts the caller's scratch into arrays. Without memory it only counts, so that one function both sizes and lays out.
#pragma once

#include <cstddef>
#include <cstdint>

namespace gim {

class Arena {
  public:
    static constexpr size_t kAlignment = 64;

    // memory: nullptr to count.
    explicit Arena(void* memory) : memory_(static_cast<std::byte*>(memory)) {}

    // Uninitialised; T is trivial. Contents are written before they are read.
    template <class T>
    T* take(size_t count) {
        T* array = memory_ ? reinterpret_cast<T*>(memory_ + used_) : nullptr;
        used_ += (uint64_t{count} * sizeof(T) + kAlignment - 1) / kAlignment * kAlignment;
        return array;
    }
    uint64_t used() const { return used_; }  // may be more than a size_t can tell: nobody has that much, then

  private:
    std::byte* memory_;
    uint64_t used_ = 0;
};

}  // namespace gim
