// Reads words and numbers from a text in memory. Counts lines, so that messages can name one. Numbers do not depend on
// the locale. "nan" and "inf" in their usual spellings are numbers: a later stage refuses them with a better message.
//
// A line ends with LF, CR LF or CR. Blanks are tab, form feed, the no-break space (UTF-8, Latin-1), and what ends some files: NUL and
// control-Z.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gim {

// Knows the exponents 1e5, 1d5 and 1D5.
std::optional<double> parse_real(std::string_view word);
std::optional<int64_t> parse_integer(std::string_view word);

// What stands where a number should: "'abc'", with advice if it is a decimal comma. Empty for an empty word.
std::string describe_wrong_number(std::string_view word);

bool equals_ignoring_case(std::string_view word, std::string_view lower);
bool begins_ignoring_case(std::string_view word, std::string_view lower);

class TextScanner {
  public:
    struct Syntax {
        bool comments = false;       // "#" ends a line
        bool continuations = false;  // "\" at the end of a line joins it with the next one; not in a comment
    };

    explicit TextScanner(std::string_view text) : text_(text) {}
    TextScanner(std::string_view text, Syntax syntax) : text_(text), syntax_(syntax) {}

    // The next word, on any line. Empty at the end of the text.
    std::string_view word();
    // The next word of the current line. Empty at the end of the line; next_line() goes on.
    std::string_view word_on_line();
    // The rest of the current line without blanks around it, comments included. Lines that a "\" joins become one,
    // with a blank between. Goes on to the next line.
    std::string rest_of_line();
    // Skips the rest of the current line. Returns false at the end of the text.
    bool next_line();
    // True if nothing is left, not even a line end.
    bool is_all_read() const { return position_ == text_.size(); }
    // Skips blanks, comments and empty lines. True if nothing is left.
    bool at_end();

    size_t offset() const { return position_; }
    size_t line() const { return line_; }  // 1-based

  private:
    // Bytes of a blank, a line end or a continuation at the position. 0: there is none.
    size_t blank_size(size_t position) const;
    size_t line_end_size(size_t position) const;
    size_t continuation_size(size_t position) const;
    bool begins_comment(size_t position) const;
    void skip_blanks();
    // Goes to the end of the line, after its continuations.
    void skip_to_line_end();

    std::string_view text_;
    Syntax syntax_;
    size_t position_ = 0;
    size_t line_ = 1;
};

}  // namespace gim
