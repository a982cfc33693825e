#include "tools/gltf_accessor.h"

#include <algorithm>

#include "tools/little_endian.h"

namespace gim::gltf {
namespace {

enum ComponentType : uint64_t {
    kByte = 5120,
    kUnsignedByte = 5121,
    kShort = 5122,
    kUnsignedShort = 5123,
    kInt = 5124,
    kUnsignedInt = 5125,
    kFloat = 5126,
    kDouble = 5130,
};

size_t component_size(uint64_t type) {
    switch (type) {
        case kByte:
        case kUnsignedByte:
            return 1;
        case kShort:
        case kUnsignedShort:
            return 2;
        case kInt:
        case kUnsignedInt:
        case kFloat:
            return 4;
        case kDouble:
            return 8;
        default:
            throw Failure("the component type " + std::to_string(type) + " is unknown");
    }
}

size_t width_of(const std::string& type) {
    if (type == "SCALAR") return 1;
    if (type == "VEC2") return 2;
    if (type == "VEC3") return 3;
    if (type == "VEC4") return 4;
    if (type == "MAT4") return 16;
    throw Failure("the type \"" + type.substr(0, 40) + "\" is not one that a mesh has");
}

double component(const uint8_t* at, uint64_t type, bool normalized) {
    const char* bytes = reinterpret_cast<const char*>(at);
    switch (type) {
        case kByte:
            return normalized ? std::max(load<int8_t>(bytes) / 127.0, -1.0) : load<int8_t>(bytes);
        case kUnsignedByte:
            return load<uint8_t>(bytes) / (normalized ? 255.0 : 1.0);
        case kShort:
            return normalized ? std::max(load<int16_t>(bytes) / 32767.0, -1.0) : load<int16_t>(bytes);
        case kUnsignedShort:
            return load<uint16_t>(bytes) / (normalized ? 65535.0 : 1.0);
        case kInt:
            return normalized ? std::max(load<int32_t>(bytes) / 2147483647.0, -1.0) : load<int32_t>(bytes);
        case kUnsignedInt:
            return load<uint32_t>(bytes) / (normalized ? 4294967295.0 : 1.0);
        case kFloat:
            return static_cast<double>(load<float>(bytes));
        default:
            return load<double>(bytes);
    }
}

// Points the column at `place`, an object with bufferView and byteOffset. step: bytes from row to row, 0 if the buffer
// view tells.
void point_at(File& file, const Json& place, size_t step, Column& column) {
    const std::optional<uint64_t> view = whole_number(place, "bufferView");
    if (!view) throw Failure("it has no buffer view");
    const size_t row = column.width * component_size(column.component_type);
    column.stride = step != 0 ? step : row;
    if (step == 0) {
        const uint64_t written = whole_number(element(file.root(), "bufferViews", *view), "byteStride").value_or(0);
        if (written != 0 && written < row) throw Failure("its rows overlap (\"byteStride\" is too small)");
        if (written > UINT32_MAX) throw Failure("its \"byteStride\" is too large");
        if (written != 0) column.stride = written;
    }
    const std::span<const uint8_t> bytes = file.view(*view);
    const uint64_t offset = whole_number(place, "byteOffset").value_or(0);
    const uint64_t room = offset <= bytes.size() ? bytes.size() - offset : 0;
    if (column.count > 0 && (room < row || column.count - 1 > (room - row) / column.stride)) {
        throw Failure("it reaches beyond its buffer (is the file cut short?)");
    }
    if (column.count > 0) column.bytes = bytes.data() + offset;
}

// Replaces the rows that "sparse" lists.
void apply_sparse(File& file, const Json& sparse, Column& column) {
    Column rows;
    rows.count = whole_number(sparse, "count").value_or(0);
    rows.width = 1;
    rows.component_type = whole_number(member(sparse, "indices"), "componentType").value_or(0);
    if (rows.component_type != kUnsignedByte && rows.component_type != kUnsignedShort &&
        rows.component_type != kUnsignedInt) {
        throw Failure("its sparse indices are no unsigned integers");
    }
    point_at(file, member(sparse, "indices"), component_size(rows.component_type), rows);
    Column values;
    values.count = rows.count;
    values.width = column.width;
    values.component_type = column.component_type;
    values.normalized = column.normalized;
    point_at(file, member(sparse, "values"), column.width * component_size(column.component_type), values);
    for (uint64_t i = 0; i < rows.count; ++i) {
        const auto row = static_cast<uint64_t>(rows.at(i, 0));
        if (row >= column.count) throw Failure("its sparse index " + std::to_string(row) + " is beyond its end");
        for (size_t k = 0; k < column.width; ++k) column.own[row * column.width + k] = values.at(i, k);
    }
}

Column read(File& file, const Json& accessor) {
    Column column;
    column.count = whole_number(accessor, "count").value_or(0);
    column.width = width_of(text(accessor, "type"));
    column.component_type = whole_number(accessor, "componentType").value_or(0);
    component_size(column.component_type);  // fails if it is unknown
    const Json& normalized = member(accessor, "normalized");
    column.normalized = normalized.is_boolean() && normalized.get<bool>();
    const bool has_view = whole_number(accessor, "bufferView").has_value();
    const Json& sparse = member(accessor, "sparse");
    if (has_view) point_at(file, accessor, 0, column);
    if (has_view && !sparse.is_object()) return column;

    take(file.memory(), column.count, column.width * sizeof(double), "its numbers");
    std::vector<double> own(column.count * column.width);  // zeros without a buffer view
    for (uint64_t row = 0; has_view && row < column.count; ++row) {
        for (size_t k = 0; k < column.width; ++k) own[row * column.width + k] = column.at(row, k);
    }
    column.own = std::move(own);
    if (sparse.is_object()) apply_sparse(file, sparse, column);
    return column;
}

}  // namespace

double Column::at(uint64_t row, size_t k) const {
    if (!own.empty()) return own[row * width + k];
    return component(bytes + row * stride + k * component_size(component_type), component_type, normalized);
}

Column read_column(File& file, uint64_t accessor) {
    const Json& object = element(file.root(), "accessors", accessor);
    try {
        return read(file, object);
    } catch (const Failure& failure) {
        throw Failure("accessor " + std::to_string(accessor) + ": " + failure.what());
    }
}

Indices read_indices(File& file, uint64_t accessor) {
    const Column column = read_column(file, accessor);
    const uint64_t type = column.component_type;
    if (column.width != 1 || (type != kUnsignedByte && type != kUnsignedShort && type != kUnsignedInt)) {
        throw Failure("the indices (accessor " + std::to_string(accessor) + ") are no unsigned integers");
    }
    take(file.memory(), column.count, sizeof(uint32_t), "its indices");
    Indices indices;
    indices.restart = type == kUnsignedByte ? UINT8_MAX : type == kUnsignedShort ? UINT16_MAX : UINT32_MAX;
    indices.values.reserve(column.count);
    for (uint64_t i = 0; i < column.count; ++i) indices.values.push_back(static_cast<uint32_t>(column.at(i, 0)));
    return indices;
}

}  // namespace gim::gltf
