// Adaptive probability of one binary decision, the same for encoder and decoder.  spec/gim-format.md, "Binary models".
// It averages a quick and a slow estimate. Both learn faster while the model is young.
// After: the adaptive binary coders of LZMA and HEVC; the averaging of two rates is that of VVC.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace gim {

class BitModel {
  public:
    BitModel() : BitModel(32768, 0) {}
    // Starts as if it had learnt this probability from `age` decisions.
    constexpr BitModel(uint16_t zero_probability, uint8_t age)
        : state_(zero_probability * uint64_t{0x10001} | uint64_t{age} << 32) {}

    // Probability of a zero in 1/65536, 1 .. 65535.
    uint32_t zero_probability() const { return (quick() + slow()) >> 1; }

    // x >> shift is computed as x * 2^(16 - shift) >> 16, which is quicker. Shifts round towards the old value, so both
    // estimates stay within 1 .. 65535 and neither carries over into the other.
    void update_zero() {
        const Learning learning = kLearning[age()];
        const uint32_t change =
            ((65536 - quick()) * learning.quick >> 16) + ((65536 - slow()) * learning.slow & 0xFFFF0000);
        state_ = uint64_t{estimates() + change} | learning.next_age;
    }
    void update_one() {
        const Learning learning = kLearning[age()];
        const uint32_t change = (quick() * learning.quick >> 16) + (slow() * learning.slow & 0xFFFF0000);
        state_ = uint64_t{estimates() - change} | learning.next_age;
    }
    void update(uint32_t bit) { bit ? update_one() : update_zero(); }

  private:
    struct Learning {
        uint64_t next_age;     // shifted as in state_
        uint32_t quick, slow;  // in 1/65536
    };
    static constexpr uint8_t kOld = 112;
    static constexpr std::array<Learning, kOld + 1> kLearning = [] {
        std::array<Learning, kOld + 1> all{};
        for (uint32_t age = 0; age <= kOld; ++age) {
            uint32_t shift = 1;  // 1 + floor(log2(age + 2))
            while ((2 * age + 4) >> (shift + 1) != 0) ++shift;
            all[age] = {uint64_t{std::min<uint32_t>(age + 1, kOld)} << 32, 65536u >> std::min(shift, 4u),
                        65536u >> std::min(shift, 7u)};
        }
        return all;
    }();

    uint32_t estimates() const { return static_cast<uint32_t>(state_); }
    uint32_t quick() const { return estimates() & 0xFFFF; }
    uint32_t slow() const { return estimates() >> 16; }
    size_t age() const { return static_cast<size_t>(state_ >> 32); }

    uint64_t state_;  // from the low end: quick estimate, slow estimate (16 bits each), age
};

}  // namespace gim
