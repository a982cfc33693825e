// Reads words and numbers from a text in memory, counting lines so that messages can name one.
// Numbers are independent of the locale; "nan" and "inf" in their usual spellings are numbers (a later stage refuses
// them with a better message than "not a number here" would be).
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

    // Next word, on whichever line; empty at the end of the text.
    std::string_view word();
    // Next word of the current line; empty where the line ends (call next_line to go on).
    std::string_view word_on_line();
    // The rest of the current line without its end; goes on to the next line.
    std::string_view rest_of_line();
    // Skips the rest of the current line. False at the end of the text.
    bool next_line();
    // Peeks: nothing but blanks is left.
    bool at_end();

    size_t offset() const { return position_; }
    size_t line() const { return line_; }  // 1-based

  private:
    std::string_view text_;
    size_t position_ = 0;
    size_t line_ = 1;
};

}  // namespace gim
