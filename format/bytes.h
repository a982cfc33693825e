// Little-endian fields, read and written.  spec/gim-format.md, "Notation".
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace gim {

// Every read returns false if the bytes end too early or the value is malformed.
class ByteReader {
  public:
    explicit ByteReader(std::span<const uint8_t> bytes) : bytes_(bytes) {}

    size_t position() const { return position_; }
    size_t left() const { return bytes_.size() - position_; }

    bool read_u8(uint8_t* value) {
        if (left() < 1) return false;
        *value = bytes_[position_++];
        return true;
    }
    bool read_u16(uint16_t* value) {
        if (left() < 2) return false;
        *value = static_cast<uint16_t>(bytes_[position_] | bytes_[position_ + 1] << 8);
        position_ += 2;
        return true;
    }
    bool read_u32(uint32_t* value) {
        if (left() < 4) return false;
        *value = 0;
        for (int i = 3; i >= 0; --i) *value = *value << 8 | bytes_[position_ + static_cast<size_t>(i)];
        position_ += 4;
        return true;
    }
    bool read_f32(float* value) {
        uint32_t bits = 0;
        if (!read_u32(&bits)) return false;
        *value = std::bit_cast<float>(bits);
        return true;
    }
    bool read_f64(double* value) {
        uint32_t low = 0, high = 0;
        if (!read_u32(&low) || !read_u32(&high)) return false;
        *value = std::bit_cast<double>(uint64_t{high} << 32 | low);
        return true;
    }
    // Seven bits a byte, least significant first; bit 7 is set on all bytes but the last. The value must be below 2^42
    // and must not end in a superfluous zero byte.
    bool read_leb128(uint64_t* value) {
        *value = 0;
        for (int shift = 0; shift < 42; shift += 7) {
            uint8_t byte = 0;
            if (!read_u8(&byte)) return false;
            *value |= uint64_t{byte & 0x7Fu} << shift;
            if (byte < 0x80) return byte != 0 || shift == 0;
        }
        return false;
    }
    bool skip(size_t count) {
        if (left() < count) return false;
        position_ += count;
        return true;
    }

  private:
    std::span<const uint8_t> bytes_;
    size_t position_ = 0;
};

inline void append_u16(uint16_t value, std::vector<uint8_t>* bytes) {
    bytes->push_back(static_cast<uint8_t>(value));
    bytes->push_back(static_cast<uint8_t>(value >> 8));
}
inline void append_u32(uint32_t value, std::vector<uint8_t>* bytes) {
    for (int shift = 0; shift < 32; shift += 8) bytes->push_back(static_cast<uint8_t>(value >> shift));
}
inline void append_f32(float value, std::vector<uint8_t>* bytes) { append_u32(std::bit_cast<uint32_t>(value), bytes); }
inline void append_f64(double value, std::vector<uint8_t>* bytes) {
    const auto bits = std::bit_cast<uint64_t>(value);
    append_u32(static_cast<uint32_t>(bits), bytes);
    append_u32(static_cast<uint32_t>(bits >> 32), bytes);
}
inline void append_leb128(uint64_t value, std::vector<uint8_t>* bytes) {
    for (; value >= 0x80; value >>= 7) bytes->push_back(static_cast<uint8_t>(value | 0x80));
    bytes->push_back(static_cast<uint8_t>(value));
}

}  // namespace gim
