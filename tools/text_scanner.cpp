#include "tools/text_scanner.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>

namespace gim {
namespace {

constexpr std::string_view kNoBreakSpace = "\xC2\xA0";

// Most characters: no blank, no line end, nothing that begins a comment or a continuation.
bool is_plain(char c) { return c > ' ' && c <= '~' && c != '#' && c != '\\'; }

// The same word with another character in place of the first `from`.
std::string with(std::string_view word, char from, char to) {
    std::string changed(word);
    const size_t at = changed.find(from);
    if (at != std::string::npos) changed[at] = to;
    return changed;
}

// The value of a word as std::from_chars reads it; `end` receives where the number ends.
std::optional<double> read_number(std::string_view word, size_t* end) {
    double value = 0;
    const std::from_chars_result read = std::from_chars(word.data(), word.data() + word.size(), value);
    if (read.ec == std::errc::invalid_argument) return std::nullopt;
    *end = static_cast<size_t>(read.ptr - word.data());
    if (read.ec == std::errc::result_out_of_range) value = std::strtod(std::string(word).c_str(), nullptr);
    return value;
}

// Old Microsoft libraries print 1.#QNAN, -1.#IND, 1.#INF00.
std::optional<double> microsoft_number(double sign, std::string_view rest) {
    if (rest.starts_with("#QNAN") || rest.starts_with("#SNAN") || rest.starts_with("#IND")) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (rest.starts_with("#INF")) return sign * std::numeric_limits<double>::infinity();
    return std::nullopt;
}

}  // namespace

std::optional<double> parse_real(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    size_t end = 0;
    const std::optional<double> value = read_number(word, &end);
    if (!value || end == word.size()) return value;
    if (word[end] == 'd' || word[end] == 'D') {
        const std::string usual = with(word, word[end], 'e');
        size_t usual_end = 0;
        const std::optional<double> fortran = read_number(usual, &usual_end);
        if (fortran && usual_end == usual.size()) return fortran;
    }
    return microsoft_number(*value, word.substr(end));
}

std::optional<int64_t> parse_integer(std::string_view word) {
    if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
    int64_t value = 0;
    const char* end = word.data() + word.size();
    const std::from_chars_result read = std::from_chars(word.data(), end, value);
    if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
    return value;
}

std::string describe_wrong_number(std::string_view word) {
    if (word.empty()) return {};
    std::string text = "'" + std::string(word.substr(0, 40)) + "'";
    if (parse_real(with(word, ',', '.'))) text += " (a decimal comma? write a point)";
    return text;
}

bool equals_ignoring_case(std::string_view word, std::string_view lower) {
    return word.size() == lower.size() && begins_ignoring_case(word, lower);
}

bool begins_ignoring_case(std::string_view word, std::string_view lower) {
    const auto to_lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
    return word.size() >= lower.size() &&
           std::equal(lower.begin(), lower.end(), word.begin(), [&](char l, char w) { return to_lower(w) == l; });
}

size_t TextScanner::blank_size(size_t position) const {
    const char c = text_[position];
    if (c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\0' || c == '\x1A') return 1;
    if (text_.substr(position).starts_with(kNoBreakSpace)) return kNoBreakSpace.size();
    // The no-break space of Latin-1. After a byte of ASCII it is no part of a letter in UTF-8.
    return c == '\xA0' && position > 0 && static_cast<unsigned char>(text_[position - 1]) < 0x80 ? 1 : 0;
}

size_t TextScanner::line_end_size(size_t position) const {
    if (text_[position] == '\n') return 1;
    if (text_[position] != '\r') return 0;
    return position + 1 < text_.size() && text_[position + 1] == '\n' ? 2 : 1;
}

size_t TextScanner::continuation_size(size_t position) const {
    if (!syntax_.continuations || text_[position] != '\\') return 0;
    size_t end = position + 1;
    while (end < text_.size() && blank_size(end) > 0) end += blank_size(end);
    return end == text_.size() ? end - position : line_end_size(end) > 0 ? end + line_end_size(end) - position : 0;
}

bool TextScanner::begins_comment(size_t position) const {
    if (!syntax_.comments || text_[position] != '#') return false;
    const bool is_in_number = position > 0 && text_[position - 1] == '.';
    return !(is_in_number && microsoft_number(1, text_.substr(position, 5)));
}

void TextScanner::skip_blanks() {
    while (position_ < text_.size()) {
        const size_t blank = blank_size(position_);
        const size_t joined = blank > 0 ? 0 : continuation_size(position_);
        if (blank + joined == 0) return;
        position_ += blank + joined;
        line_ += joined > 0 ? 1 : 0;
    }
}

void TextScanner::skip_to_line_end() {
    bool in_comment = false;
    while (position_ < text_.size() && line_end_size(position_) == 0) {
        if (is_plain(text_[position_])) {
            ++position_;
            continue;
        }
        in_comment = in_comment || begins_comment(position_);
        const size_t joined = in_comment ? 0 : continuation_size(position_);
        position_ += std::max<size_t>(joined, 1);
        line_ += joined > 0 ? 1 : 0;
    }
}

bool TextScanner::at_end() {
    for (skip_blanks(); position_ < text_.size(); skip_blanks()) {
        if (!begins_comment(position_) && line_end_size(position_) == 0) return false;
        next_line();
    }
    return true;
}

std::string_view TextScanner::word() {
    if (at_end()) return {};
    return word_on_line();
}

std::string_view TextScanner::word_on_line() {
    skip_blanks();
    const size_t begin = position_;
    const auto ends_word = [&] {
        return blank_size(position_) > 0 || line_end_size(position_) > 0 || continuation_size(position_) > 0 ||
               begins_comment(position_);
    };
    while (position_ < text_.size() && (is_plain(text_[position_]) || !ends_word())) ++position_;
    return text_.substr(begin, position_ - begin);
}

std::string TextScanner::rest_of_line() {
    skip_blanks();
    std::string rest;
    while (position_ < text_.size() && line_end_size(position_) == 0) {
        const size_t joined = continuation_size(position_);
        rest += joined > 0 ? ' ' : text_[position_];
        position_ += std::max<size_t>(joined, 1);
        line_ += joined > 0 ? 1 : 0;
    }
    next_line();
    const size_t last = rest.find_last_not_of(std::string_view(" \t\v\f\0\x1A", 6));
    rest.resize(last == std::string::npos ? 0 : last + 1);
    return rest;
}

bool TextScanner::next_line() {
    skip_to_line_end();
    if (position_ < text_.size()) {
        position_ += line_end_size(position_);
        ++line_;
    }
    return position_ < text_.size();
}

}  // namespace gim
