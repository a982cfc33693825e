// Loads and stores of fixed-width values in files.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <vector>

namespace gim {

static_assert(std::endian::native == std::endian::little, "the tools copy little-endian file values as they are");

template <class T>
T load(const char* bytes) {
    T value;
    std::memcpy(&value, bytes, sizeof(T));
    return value;
}
inline uint32_t load_u32(const char* bytes) { return load<uint32_t>(bytes); }
inline float load_f32(const char* bytes) { return load<float>(bytes); }

template <class T>
void append(std::vector<uint8_t>& out, const T& value) {
    const auto* bytes = reinterpret_cast<const uint8_t*>(&value);
    out.insert(out.end(), bytes, bytes + sizeof(T));
}

}  // namespace gim
