// Adaptive probability of one binary decision, the same in both directions.  spec/gim-format.md, "Binary models".
// Two estimates, a quick and a slow one, are averaged; both learn faster while the model is young.
// After: the adaptive binary coders of LZMA and HEVC; the averaging of two rates is that of VVC.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace gim {

class BitModel {
  public:
    BitModel() = default;
    // That starts as if it had learnt this much.
    constexpr BitModel(uint16_t zero_probability, uint8_t age)
        : quick_(zero_probability), slow_(zero_probability), age_(age) {}

    // Probability of a zero in 1/65536, 1 .. 65535.
    uint32_t zero_probability() const { return (uint32_t{quick_} + slow_) >> 1; }

    void update(uint32_t bit) {
        const Rate rate = kRates[age_];
        const uint32_t target = bit ? 0 : 65536;  // never reached: the shifts round towards the old value
        if (bit) {
            quick_ = static_cast<uint16_t>(quick_ - (quick_ >> rate.quick));
            slow_ = static_cast<uint16_t>(slow_ - (slow_ >> rate.slow));
        } else {
            quick_ = static_cast<uint16_t>(quick_ + ((target - quick_) >> rate.quick));
            slow_ = static_cast<uint16_t>(slow_ + ((target - slow_) >> rate.slow));
        }
        age_ = rate.next_age;
    }

  private:
    struct Rate {
        uint8_t quick, slow, next_age;
    };
    static constexpr uint8_t kOld = 112;
    static constexpr std::array<Rate, kOld + 1> kRates = [] {
        std::array<Rate, kOld + 1> rates{};
        for (uint8_t age = 0; age <= kOld; ++age) {
            uint8_t shift = 1;  // 1 + the rounded down log2 of age + 2
            while ((2 * age + 4) >> (shift + 1) != 0) ++shift;
            rates[age] = {std::min<uint8_t>(shift, 4), std::min<uint8_t>(shift, 7),
                          static_cast<uint8_t>(std::min<int>(age + 1, kOld))};
        }
        return rates;
    }();

    uint16_t quick_ = 32768, slow_ = 32768;
    uint16_t age_ = 0;  // not a byte: stores of bytes would make the compiler reload the coder's state
};

}  // namespace gim
