// The values of a PLY file behind its header, one by one.
#pragma once

#include <string_view>

#include "tools/ply_header.h"
#include "tools/text_scanner.h"

namespace gim::ply {

// How an ascii body is cut into records.
enum class Records {
    kWords,  // lines have no meaning
    kLines,  // each record begins on a new line; what is left of its last line is dropped
};

// Reads the values of the body one by one. Reading past the end sets `failed`.
class Body {
  public:
    Body(std::string_view text, Encoding encoding, Records records)
        : text_(text), scanner_(text, {.comments = true}), encoding_(encoding), records_(records) {}

    double next(Scalar type);

    void end_record();

    // True if words are left, which no record took.
    bool has_more_words() { return encoding_ == Encoding::kAscii && !scanner_.at_end(); }

    // Reads the length of a list. Fails before anything is stored if the rest of the file cannot hold the list.
    size_t next_length(const Property& list);

    bool failed = false;
    std::string_view wrong_word;  // that made it fail; empty at the end
    uint64_t dropped_lines = 0;   // that had more words than their record

  private:
    std::string_view text_;
    TextScanner scanner_;
    Encoding encoding_;
    Records records_;
    size_t position_ = 0;
};

// Returns the least number of bytes of one record. Its lists count as empty.
size_t least_size(const Element& element, Encoding encoding);

}  // namespace gim::ply
