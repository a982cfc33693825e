// Binary range encoder and raw bits of one stream: the mirror of decoder/range_decoder.h.  spec/gim-format.md, "Range
// coder".
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "format/bit_model.h"

namespace gim {

class RangeEncoder {
  public:
    static constexpr bool kWrites = true;

    uint32_t code_bit(BitModel& model, uint32_t bit) {
        const uint64_t bound = (range_ >> 16) * model.zero_probability();
        if (bit) {
            add_to_low(bound);
            range_ -= bound;
        } else {
            range_ = bound;
        }
        model.update(bit);
        if (range_ >> 32 == 0) {
            for (int shift = 56; shift >= 32; shift -= 8) front_.push_back(static_cast<uint8_t>(low_ >> shift));
            low_ <<= 32;
            range_ <<= 32;
        }
        return bit;
    }

    uint32_t code_raw(uint32_t value, uint32_t count) {
        raw_ |= uint64_t{value} << raw_count_;
        raw_count_ += count;
        for (; raw_count_ >= 8; raw_count_ -= 8) {
            back_.push_back(static_cast<uint8_t>(raw_));
            raw_ >>= 8;
        }
        return value;
    }

    // The stream. Its front part decodes the same whatever bytes follow, so the raw part can.
    std::vector<uint8_t> finish() {
        // As few bytes as name a span of values inside the range.
        for (int bytes = 1;; ++bytes) {
            const uint64_t unit = uint64_t{1} << (64 - 8 * bytes);
            const uint64_t rounded = (low_ + (unit - 1)) & ~(unit - 1);
            const uint64_t offset = rounded - low_;  // modulo 2^64, below unit
            if (offset > range_ - unit || range_ < unit) continue;
            if (rounded < low_) propagate_carry();
            for (int i = 0; i < bytes; ++i) front_.push_back(static_cast<uint8_t>(rounded >> (56 - 8 * i)));
            break;
        }
        if (raw_count_ > 0) back_.push_back(static_cast<uint8_t>(raw_));
        front_.insert(front_.end(), back_.rbegin(), back_.rend());
        return std::move(front_);
    }

  private:
    void add_to_low(uint64_t amount) {
        low_ += amount;
        if (low_ < amount) propagate_carry();
    }
    void propagate_carry() {
        for (size_t i = front_.size(); i-- > 0;) {
            if (++front_[i] != 0) break;
        }
    }

    std::vector<uint8_t> front_, back_;  // back_ in the order of reading
    uint64_t low_ = 0, range_ = UINT64_MAX;
    uint64_t raw_ = 0;
    uint32_t raw_count_ = 0;
};

}  // namespace gim
