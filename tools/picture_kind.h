// What kind of picture a file is, by its first bytes.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace gim {

struct PictureKind {
    std::string_view name;        // as people call it; empty: none that gim knows
    std::string_view media_type;  // as glTF names it; empty: glTF has none
    bool is_read = false;         // whether gim can decode it
};

PictureKind picture_kind(std::span<const uint8_t> bytes);

}  // namespace gim
