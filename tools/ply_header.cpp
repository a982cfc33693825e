#include "tools/ply_header.h"

#include <algorithm>
#include <array>
#include <string>

#include "tools/text_scanner.h"

namespace gim::ply {
namespace {

Scalar scalar_named(std::string_view name) {
    struct Entry {
        std::string_view name, alias;
        Scalar type;
    };
    static constexpr std::array<Entry, 8> kScalars = {{{"char", "int8", Scalar::kI8},
                                                       {"uchar", "uint8", Scalar::kU8},
                                                       {"short", "int16", Scalar::kI16},
                                                       {"ushort", "uint16", Scalar::kU16},
                                                       {"int", "int32", Scalar::kI32},
                                                       {"uint", "uint32", Scalar::kU32},
                                                       {"float", "float32", Scalar::kF32},
                                                       {"double", "float64", Scalar::kF64}}};
    for (const Entry& entry : kScalars) {
        if (name == entry.name || name == entry.alias) return entry.type;
    }
    return Scalar::kNone;
}

Error bad_header(size_t line, const std::string& what) {
    return {Stage::kInput, "PLY header, line " + std::to_string(line) + ": " + what};
}

// Bytes up to the first one behind the line of "end_header". `at` is inside that line. A file whose first line ends with
// CR alone may have a body that begins with the byte LF.
size_t size_with_end_line(std::string_view text, size_t at) {
    const size_t first_end = std::min(text.find_first_of("\r\n"), text.size());
    const bool ends_with_cr = text.substr(first_end, 1) == "\r" && text.substr(first_end, 2) != "\r\n";
    const size_t end = text.find(ends_with_cr ? '\r' : '\n', at);
    return end == std::string_view::npos ? text.size() : end + 1;
}

}  // namespace

Result<Header> read_header(std::string_view text) {
    Header header;
    TextScanner in(text);
    if (!equals_ignoring_case(in.word_on_line(), "ply")) return Error{Stage::kInput, "it does not begin with 'ply'"};
    bool has_format = false;
    while (in.next_line()) {
        const size_t line = in.line();
        const std::string_view keyword = in.word_on_line();
        if (keyword == "format") {
            const std::string_view name = in.word_on_line();
            if (name == "ascii") {
                header.encoding = Encoding::kAscii;
            } else if (name == "binary_little_endian") {
                header.encoding = Encoding::kLittleEndian;
            } else if (name == "binary_big_endian") {
                header.encoding = Encoding::kBigEndian;
            } else {
                return bad_header(line, "unknown format '" + std::string(name.substr(0, 40)) + "'");
            }
            has_format = true;
        } else if (keyword == "element") {
            Element element;
            element.name = in.word_on_line();
            const std::optional<int64_t> count = parse_integer(in.word_on_line());
            if (!count || *count < 0) return bad_header(line, "an element needs a name and a number");
            element.count = static_cast<uint64_t>(*count);
            header.elements.push_back(element);
        } else if (keyword == "property") {
            if (header.elements.empty()) return bad_header(line, "a property comes before the first element");
            Property property;
            std::string_view type = in.word_on_line();
            if (type == "list") {
                property.count_type = scalar_named(in.word_on_line());
                if (property.count_type == Scalar::kNone)
                    return bad_header(line, "the length of a list has an unknown type");
                type = in.word_on_line();
            }
            property.type = scalar_named(type);
            if (property.type == Scalar::kNone) {
                return bad_header(line, "unknown type '" + std::string(type.substr(0, 40)) + "'");
            }
            property.name = in.word_on_line();
            header.elements.back().properties.push_back(property);
        } else if (keyword == "end_header") {
            header.size = size_with_end_line(text, in.offset());
            if (!has_format) return bad_header(line, "the format line is missing");
            return header;
        } else if (keyword == "comment") {
            TextScanner ahead = in;
            if (ahead.word_on_line() != "TextureFile") continue;
            header.textures.push_back(ahead.rest_of_line());
        } else if (keyword != "obj_info" && !keyword.empty()) {
            return bad_header(line, "unknown keyword '" + std::string(keyword.substr(0, 40)) + "'");
        }
    }
    return Error{Stage::kInput, "its PLY header has no end (is the file cut short?)"};
}

size_t size_of(Scalar type) {
    switch (type) {
        case Scalar::kNone:
            return 0;
        case Scalar::kI8:
        case Scalar::kU8:
            return 1;
        case Scalar::kI16:
        case Scalar::kU16:
            return 2;
        case Scalar::kI32:
        case Scalar::kU32:
        case Scalar::kF32:
            return 4;
        case Scalar::kF64:
            return 8;
    }
    return 0;
}

}  // namespace gim::ply
