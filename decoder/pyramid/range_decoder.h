// Binary range decoder and raw bits of one stream.  spec/gim-format.md, "Range coder".
// The range coder reads the stream from the front. Raw bits are read from the end backwards. Reading never fails; in
// the end intact() tells whether raw bits ran out. After: Martin. Range encoding. 1979; Subbotin's carryless variant.
// Renormalises 32 bits at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "format/bit_model.h"
#include "format/inline.h"

namespace gim {

class RangeDecoder {
  public:
    static constexpr bool kWrites = false;

    explicit RangeDecoder(std::span<const uint8_t> stream) : bytes_(stream), back_(stream.size()) {
        code_ = uint64_t{next_word()} << 32;
        code_ |= next_word();
    }

    GIM_ALWAYS_INLINE uint32_t code_bit(BitModel& model, uint32_t = 0) {
        const uint64_t bound = (range_ >> 16) * model.zero_probability();
        uint32_t bit = 0;
        if (code_ >= bound) {
            code_ -= bound;
            range_ -= bound;
            model.update_one();
            bit = 1;
        } else {
            range_ = bound;
            model.update_zero();
        }
        if (range_ >> 32 == 0) {
            code_ = code_ << 32 | next_word();
            range_ <<= 32;
        }
        return bit;
    }

    // count <= 25, because up to 7 bits are left over and the register holds 32.
    uint32_t code_raw(uint32_t, uint32_t count) {
        while (raw_count_ < count) {
            uint8_t byte = 0;
            if (back_ > 0) {
                byte = bytes_[--back_];
            } else {
                overrun_ = true;
            }
            raw_ |= uint32_t{byte} << raw_count_;
            raw_count_ += 8;
        }
        const uint32_t value = raw_ & ((1u << count) - 1);
        raw_ >>= count;
        raw_count_ -= count;
        return value;
    }

    bool intact() const { return !overrun_; }

  private:
    uint32_t next_word() {
        uint32_t word = 0;
        if (bytes_.size() - front_ >= 4) {
            const uint8_t* p = bytes_.data() + front_;
            word = uint32_t{p[0]} << 24 | uint32_t{p[1]} << 16 | uint32_t{p[2]} << 8 | p[3];
            front_ += 4;
            return word;
        }
        for (int i = 0; i < 4; ++i) word = word << 8 | (front_ < bytes_.size() ? bytes_[front_++] : 0u);
        return word;
    }

    std::span<const uint8_t> bytes_;
    size_t front_ = 0, back_;
    uint64_t range_ = UINT64_MAX, code_ = 0;
    uint32_t raw_ = 0, raw_count_ = 0;
    bool overrun_ = false;
};

}  // namespace gim
