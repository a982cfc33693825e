#include "tools/npy.h"

#include <Imath/half.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string_view>

namespace gim {
namespace {

constexpr std::string_view kMagicText = "\x93NUMPY";
constexpr size_t kAlignment = 64;  // of the numbers
constexpr size_t kMostAxes = 32;

Error error(std::string message) { return {Stage::kInput, std::move(message)}; }

struct TypeName {
    std::string_view name;
    SampleType type;
    size_t size;
};
constexpr TypeName kTypes[] = {
    {"f4", SampleType::kFloat32, 4}, {"f8", SampleType::kFloat64, 8}, {"f2", SampleType::kFloat16, 2},
    {"u1", SampleType::kUint8, 1},   {"i1", SampleType::kInt8, 1},    {"u2", SampleType::kUint16, 2},
    {"i2", SampleType::kInt16, 2},   {"u4", SampleType::kUint32, 4},  {"i4", SampleType::kInt32, 4},
};
static_assert(kTypes[static_cast<size_t>(SampleType::kInt32)].type == SampleType::kInt32);

double number_of(SampleType type, uint64_t bits) {
    switch (type) {
        case SampleType::kFloat32:
            return std::bit_cast<float>(static_cast<uint32_t>(bits));
        case SampleType::kFloat64:
            return std::bit_cast<double>(bits);
        case SampleType::kFloat16: {
            Imath::half value;
            value.setBits(static_cast<uint16_t>(bits));
            return double{static_cast<float>(value)};
        }
        case SampleType::kInt8:
            return static_cast<int8_t>(bits);
        case SampleType::kInt16:
            return static_cast<int16_t>(bits);
        case SampleType::kInt32:
            return static_cast<int32_t>(bits);
        default:
            return static_cast<double>(bits);
    }
}

uint64_t bits_of(SampleType type, double value) {
    switch (type) {
        case SampleType::kFloat32:
            return std::bit_cast<uint32_t>(static_cast<float>(value));
        case SampleType::kFloat64:
            return std::bit_cast<uint64_t>(value);
        case SampleType::kFloat16:
            return Imath::half(static_cast<float>(value)).bits();
        default:
            return static_cast<uint64_t>(static_cast<int64_t>(value));
    }
}

// The dictionary of Python that begins a file, as numpy writes it.
struct Description {
    std::string descr;
    bool is_fortran = false;
    std::vector<uint64_t> shape;
};

// Returns what stands behind 'key': in the dictionary.
std::optional<std::string_view> value_of(std::string_view text, std::string_view key) {
    const size_t at = text.find("'" + std::string(key) + "'");
    if (at == std::string_view::npos) return {};
    const size_t colon = text.find(':', at);
    if (colon == std::string_view::npos) return {};
    const size_t begin = text.find_first_not_of(' ', colon + 1);
    if (begin == std::string_view::npos) return {};
    return text.substr(begin);
}

std::optional<std::vector<uint64_t>> read_shape(std::string_view text) {
    if (!text.starts_with('(')) return {};
    std::vector<uint64_t> shape;
    bool in_number = false;
    for (const char c : text.substr(1)) {
        if (c == ')') return shape;
        if (c < '0' || c > '9') {
            if (c != ',' && c != ' ' && c != 'L') return {};
            in_number = false;
            continue;
        }
        if (!in_number && shape.size() == kMostAxes) return {};
        if (!in_number) shape.push_back(0);
        in_number = true;
        shape.back() = shape.back() * 10 + static_cast<uint64_t>(c - '0');
        if (shape.back() > uint64_t{1} << 40) return {};
    }
    return {};
}

Result<Description> read_description(std::string_view text) {
    const auto descr = value_of(text, "descr"), order = value_of(text, "fortran_order"),
               shape = value_of(text, "shape");
    const Error broken = error("the header of an array is broken");
    if (!descr || !order || !shape) return broken;
    if (!descr->starts_with('\'')) return error("an array holds structures; gim reads plain numbers");
    const size_t end = descr->find('\'', 1);
    const auto axes = read_shape(*shape);
    if (end == std::string_view::npos || !axes) return broken;
    return Description{std::string(descr->substr(1, end - 1)), order->starts_with("True"), *axes};
}

// The place of number i of the file in C order.
uint64_t place_of(uint64_t i, const Description& d) {
    if (!d.is_fortran) return i;
    uint64_t place = 0, stride = 1;
    std::vector<uint64_t> index;
    for (const uint64_t n : d.shape) {
        index.push_back(i % n);
        i /= n;
    }
    for (size_t axis = d.shape.size(); axis-- > 0;) {
        place += index[axis] * stride;
        stride *= d.shape[axis];
    }
    return place;
}

}  // namespace

Result<NumberArray> read_npy(std::span<const uint8_t> bytes, MemoryBudget& memory) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with(kMagicText) || text.size() < 12) return error("an array does not begin as NumPy's do");
    const bool is_long = text[6] > 1;
    size_t length = 0;
    for (size_t k = is_long ? 4 : 2; k-- > 0;) length = length << 8 | bytes[8 + k];
    const size_t begin = is_long ? 12 : 10;
    if (length > bytes.size() - begin) return error("the header of an array ends too early");
    const Result<Description> read = read_description(text.substr(begin, length));
    if (!read.ok()) return read.error();
    const Description& description = read.value();

    const std::string& descr = description.descr;
    NumberArray array;
    array.is_bool = descr == "|b1";
    const std::string_view name =
        array.is_bool ? "u1" : std::string_view(descr).substr(std::min<size_t>(1, descr.size()));
    const auto* type =
        std::find_if(std::begin(kTypes), std::end(kTypes), [&](const TypeName& t) { return t.name == name; });
    if (descr.find('O') != std::string::npos) return error("an array holds Python objects; gim reads plain numbers");
    if (type == std::end(kTypes) || (descr[0] != '<' && descr[0] != '>' && descr[0] != '|' && descr[0] != '='))
        return error("an array has the type '" + descr +
                     "'; gim reads float16, float32, float64, and whole numbers of 8, 16 and 32 bits");
    array.type = type->type;
    array.shape = description.shape;
    uint64_t count = 1;
    for (const uint64_t n : array.shape) {
        if (n != 0 && count > (uint64_t{1} << 40) / n) return error("an array is too large");
        count *= n;
    }
    if (count * type->size != bytes.size() - begin - length)
        return error("an array has not as many bytes as its shape says");
    if (const Result<void> fits = memory.take(count, sizeof(double), "an array"); !fits.ok()) return fits.error();
    array.values.resize(count);
    const bool is_big = descr[0] == '>';
    const uint8_t* from = bytes.data() + begin + length;
    for (uint64_t i = 0; i < count; ++i, from += type->size) {
        uint64_t bits = 0;
        for (size_t k = 0; k < type->size; ++k) bits = bits << 8 | from[is_big ? k : type->size - 1 - k];
        array.values[place_of(i, description)] = number_of(array.type, bits);
    }
    return array;
}

Bytes write_npy(const NumberArray& array) {
    const TypeName& type = kTypes[static_cast<size_t>(array.type)];
    std::string header = "{'descr': '" +
                         (array.is_bool ? "|b1" : (type.size == 1 ? "|" : "<") + std::string(type.name)) +
                         "', 'fortran_order': False, 'shape': (";
    for (const uint64_t n : array.shape) header += std::to_string(n) + ", ";
    header += "), }";
    while ((kMagicText.size() + 4 + header.size() + 1) % kAlignment != 0) header += ' ';
    header += '\n';
    Bytes bytes(kMagicText.begin(), kMagicText.end());
    for (const size_t b : {size_t{1}, size_t{0}, header.size() & 255, header.size() >> 8})
        bytes.push_back(static_cast<uint8_t>(b));
    bytes.insert(bytes.end(), header.begin(), header.end());
    for (const double value : array.values) {
        const uint64_t bits = bits_of(array.type, value);
        for (size_t k = 0; k < type.size; ++k) bytes.push_back(static_cast<uint8_t>(bits >> (8 * k)));
    }
    return bytes;
}

}  // namespace gim
