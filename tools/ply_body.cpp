#include "tools/ply_body.h"

#include <algorithm>
#include <array>

#include "tools/little_endian.h"

namespace gim::ply {

double Body::next(Scalar type) {
    if (encoding_ == Encoding::kAscii) {
        const std::string_view word = scanner_.word();
        const std::optional<double> value = parse_real(word);
        if (!value && !failed) wrong_word = word;
        if (!value) failed = true;
        return value.value_or(0);
    }
    const size_t size = size_of(type);
    if (size > text_.size() - position_) {
        failed = true;
        return 0;
    }
    std::array<char, 8> bytes = {};
    std::copy_n(text_.data() + position_, size, bytes.begin());
    if (encoding_ == Encoding::kBigEndian) {
        std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    }
    position_ += size;
    switch (type) {
        case Scalar::kNone:
            break;
        case Scalar::kI8:
            return load<int8_t>(bytes.data());
        case Scalar::kU8:
            return load<uint8_t>(bytes.data());
        case Scalar::kI16:
            return load<int16_t>(bytes.data());
        case Scalar::kU16:
            return load<uint16_t>(bytes.data());
        case Scalar::kI32:
            return load<int32_t>(bytes.data());
        case Scalar::kU32:
            return load<uint32_t>(bytes.data());
        case Scalar::kF32:
            return static_cast<double>(load<float>(bytes.data()));
        case Scalar::kF64:
            return load<double>(bytes.data());
    }
    return 0;
}

void Body::end_record() {
    if (encoding_ != Encoding::kAscii || records_ == Records::kWords) return;
    dropped_lines += scanner_.word_on_line().empty() ? 0 : 1;
    scanner_.next_line();
}

size_t Body::next_length(const Property& list) {
    const double length = next(list.count_type);
    const size_t left = encoding_ == Encoding::kAscii ? text_.size() - scanner_.offset() : text_.size() - position_;
    const size_t least = encoding_ == Encoding::kAscii ? 1 : std::max<size_t>(size_of(list.type), 1);
    const size_t most = left / least;
    if (!(length >= 0) || length > static_cast<double>(most)) failed = true;
    return failed ? 0 : static_cast<size_t>(length);
}

size_t least_size(const Element& element, Encoding encoding) {
    size_t size = 0;
    for (const Property& property : element.properties) {
        const Scalar first = property.count_type == Scalar::kNone ? property.type : property.count_type;
        size += encoding == Encoding::kAscii ? 2 : size_of(first);
    }
    return size;
}

}  // namespace gim::ply
