// Text for HTML.
#pragma once

#include <string>
#include <string_view>

namespace gim {

// With < > & " as entities. What is not UTF-8, and control characters, which HTML forbids, become U+FFFD.
std::string html_text(std::string_view text);

// A number with that many digits after the point.
std::string decimal(double value, int digits);

}  // namespace gim
