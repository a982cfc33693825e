// Writes range-coded and raw bits into one stream. Mirror of the decoder's range_decoder.h.
// spec/gim-format.md, "Range coder".
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

    // Returns the stream.
    std::vector<uint8_t> finish() {
        if (raw_count_ > 0) back_.push_back(static_cast<uint8_t>(raw_));
        // Appends the fewest bytes to the front that make a number inside the range. The bytes that follow are the raw
        // part, then zeros.
        uint64_t tail = 0;
        for (size_t i = 0; i < 8; ++i) tail = tail << 8 | (i < back_.size() ? back_[back_.size() - 1 - i] : 0u);
        for (uint32_t count = 0;; ++count) {
            const uint32_t shift = 8 * count;
            const uint64_t below = shift < 64 ? ~uint64_t{0} >> shift : 0;
            const uint64_t rest = shift < 64 ? tail >> shift : 0, down = low_ & ~below, over = low_ & below;
            if (rest >= over && rest - over < range_) {
                append_front(down, count);
                break;
            }
            const uint64_t up = below - over + 1;  // from low_ to the next multiple; 0 stands for 2^64
            if (up == 0 || up >= range_ || rest >= range_ - up) continue;
            if (low_ + up < low_) propagate_carry();
            append_front(low_ + up, count);
            break;
        }
        if (back_.empty()) {
            while (!front_.empty() && front_.back() == 0) front_.pop_back();
        }
        front_.insert(front_.end(), back_.rbegin(), back_.rend());
        return std::move(front_);
    }

  private:
    void append_front(uint64_t bytes, uint32_t count) {
        for (uint32_t i = 0; i < count; ++i) front_.push_back(static_cast<uint8_t>(bytes >> (56 - 8 * i)));
    }
    void add_to_low(uint64_t amount) {
        low_ += amount;
        if (low_ < amount) propagate_carry();
    }
    void propagate_carry() {
        for (size_t i = front_.size(); i-- > 0;) {
            if (++front_[i] != 0) break;
        }
    }

    std::vector<uint8_t> front_, back_;  // back_: in reading order; finish() reverses it
    uint64_t low_ = 0, range_ = UINT64_MAX;
    uint64_t raw_ = 0;
    uint32_t raw_count_ = 0;
};

}  // namespace gim
