// Reads words and numbers from a text in memory. Counts lines, so that messages can name one. Numbers do not depend on
// the locale. "nan" and "inf" in their usual spellings are numbers: a later stage refuses them with a better message.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace gim {

std::optional<double> parse_real(std::string_view word);
std::optional<int64_t> parse_integer(std::string_view word);

class TextScanner {
  public:
    explicit TextScanner(std::string_view text) : text_(text) {}

    // The next word, on any line. Empty at the end of the text.
    std::string_view word();
    // The next word of the current line. Empty at the end of the line; next_line() goes on.
    std::string_view word_on_line();
    // The rest of the current line, without its end. Goes on to the next line.
    std::string_view rest_of_line();
    // Skips the rest of the current line. Returns false at the end of the text.
    bool next_line();
    // Skips blanks and empty lines. True if nothing is left.
    bool at_end();

    size_t offset() const { return position_; }
    size_t line() const { return line_; }  // 1-based

  private:
    std::string_view text_;
    size_t position_ = 0;
    size_t line_ = 1;
};

}  // namespace gim
