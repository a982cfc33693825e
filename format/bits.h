// Bit fields; the most significant bit comes first in each byte.  spec/gim-format.md, "Sidebands".
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gim {

class BitWriter {
  public:
    explicit BitWriter(std::vector<uint8_t>* bytes) : bytes_(bytes) {}
    void write(uint32_t value, int count) {
        while (count-- > 0) {
            if (used_ == 0) bytes_->push_back(0);
            if (value >> count & 1) bytes_->back() |= static_cast<uint8_t>(0x80 >> used_);
            used_ = (used_ + 1) & 7;
        }
    }
    // Writes a number in 0 .. most.
    void write_up_to(uint32_t value, uint32_t most) { write(value, std::bit_width(most)); }

  private:
    std::vector<uint8_t>* bytes_;
    int used_ = 0;
};

class BitReader {
  public:
    explicit BitReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}
    bool read(int count, uint32_t* value) {
        *value = 0;
        while (count-- > 0) {
            if (position_ / 8 >= bytes_.size()) return false;
            *value = *value << 1 | (bytes_[position_ / 8] >> (7 - position_ % 8) & 1u);
            ++position_;
        }
        return true;
    }
    bool read_up_to(uint32_t most, uint32_t* value) { return read(std::bit_width(most), value) && *value <= most; }
    bool rest_is_zero() {
        uint32_t rest = 0;
        return read(static_cast<int>((8 - position_ % 8) % 8), &rest) && rest == 0;
    }
    bool at_end() const { return position_ == bytes_.size() * 8; }
    size_t bytes_read() const { return position_ / 8; }

  private:
    std::span<const uint8_t> bytes_;
    size_t position_ = 0;
};

}  // namespace gim
