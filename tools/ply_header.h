// The header of a PLY file: its elements and their properties.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "gim/encoder.h"

namespace gim::ply {

enum class Encoding { kAscii, kLittleEndian, kBigEndian };
enum class Scalar { kNone, kI8, kU8, kI16, kU16, kI32, kU32, kF32, kF64 };

struct Property {
    std::string_view name;
    Scalar type = Scalar::kNone;
    Scalar count_type = Scalar::kNone;  // kNone: a single value, else a list
};

struct Element {
    std::string_view name;
    uint64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Encoding encoding = Encoding::kAscii;
    std::vector<Element> elements;
    std::vector<std::string> textures;
    size_t size = 0;  // bytes, "end_header" line included
};

// Bytes of a value in a binary file.
size_t size_of(Scalar type);

// The names in the header are views of `text`.
Result<Header> read_header(std::string_view text);

}  // namespace gim::ply
