#include "tools/text_scanner.h"

#include <charconv>
#include <cstdlib>
#include <limits>
#include <string>

namespace gim {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

}  // namespace

std::optional<double> parse_real(std::string_view word) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    double value = 0;
    const char* end = word.data() + word.size();
    const std::from_chars_result read = std::from_chars(word.data(), end, value);
    if (read.ec == std::errc::invalid_argument) return std::nullopt;
    if (read.ec == std::errc::result_out_of_range) value = std::strtod(std::string(word).c_str(), nullptr);
    if (read.ptr == end) return value;

    // Old Microsoft libraries print 1.#QNAN, -1.#IND, 1.#INF00.
    const std::string_view rest(read.ptr, static_cast<size_t>(end - read.ptr));
    if (rest.starts_with("#QNAN") || rest.starts_with("#SNAN") || rest.starts_with("#IND")) {
        return std::numeric_limits<double>::quiet_NaN();
    }
    if (rest.starts_with("#INF")) return value * std::numeric_limits<double>::infinity();
    return std::nullopt;
}

std::optional<int64_t> parse_integer(std::string_view word) {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    int64_t value = 0;
    const char* end = word.data() + word.size();
    const std::from_chars_result read = std::from_chars(word.data(), end, value);
    if (read.ec != std::errc() || read.ptr != end) return std::nullopt;
    return value;
}

bool TextScanner::at_end() {
    while (position_ < text_.size() && (is_blank(text_[position_]) || text_[position_] == '\n')) {
        line_ += text_[position_] == '\n' ? 1 : 0;
        ++position_;
    }
    return position_ == text_.size();
}

std::string_view TextScanner::word() {
    if (at_end()) return {};
    return word_on_line();
}

std::string_view TextScanner::word_on_line() {
    while (position_ < text_.size() && is_blank(text_[position_])) ++position_;
    const size_t begin = position_;
    while (position_ < text_.size() && !is_blank(text_[position_]) && text_[position_] != '\n') ++position_;
    return text_.substr(begin, position_ - begin);
}

std::string_view TextScanner::rest_of_line() {
    const size_t begin = position_;
    const size_t newline = text_.find('\n', begin);
    size_t end = newline;
    if (newline == std::string_view::npos) {
        end = position_ = text_.size();
    } else {
        position_ = newline + 1;
        ++line_;
    }
    while (end > begin && is_blank(text_[end - 1])) --end;
    return text_.substr(begin, end - begin);
}

bool TextScanner::next_line() {
    rest_of_line();
    return position_ < text_.size();
}

}  // namespace gim
