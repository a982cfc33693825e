#include "tools/gltf_json.h"

#include <cmath>

namespace gim::gltf {
namespace {

constexpr double kLargestWhole = 9007199254740992.0;  // 2^53

uint64_t as_whole(const Json& value, const std::string& key) {
    if (value.is_number_unsigned()) return value.get<uint64_t>();
    // Some programs write 3.0 for 3.
    if (value.is_number_float()) {
        const double number = value.get<double>();
        if (number >= 0 && number <= kLargestWhole && number == std::floor(number)) {
            return static_cast<uint64_t>(number);
        }
    }
    throw Failure("\"" + key + "\" is not a whole number from 0 on");
}

}  // namespace

const Json& member(const Json& object, const std::string& key) {
    static const Json nothing;
    if (!object.is_object()) return nothing;
    const auto found = object.find(key);
    return found == object.end() ? nothing : *found;
}

const Json& extension(const Json& object, const std::string& name) {
    return member(member(object, "extensions"), name);
}

std::optional<uint64_t> whole_number(const Json& object, const std::string& key) {
    const Json& value = member(object, key);
    if (value.is_null()) return std::nullopt;
    return as_whole(value, key);
}

double real_number(const Json& object, const std::string& key, double missing) {
    const Json& value = member(object, key);
    if (value.is_null()) return missing;
    if (!value.is_number()) throw Failure("\"" + key + "\" is not a number");
    return value.get<double>();
}

std::string text(const Json& object, const std::string& key, const std::string& missing) {
    const Json& value = member(object, key);
    return value.is_string() ? value.get<std::string>() : missing;
}

std::vector<double> numbers(const Json& object, const std::string& key, size_t size) {
    std::vector<double> values;
    const Json& list = member(object, key);
    if (list.is_null()) return values;
    if (!list.is_array() || (size != 0 && list.size() != size)) {
        throw Failure("\"" + key + "\" is not a list of " + (size == 0 ? "" : std::to_string(size) + " ") + "numbers");
    }
    for (const Json& value : list) {
        if (!value.is_number()) throw Failure("\"" + key + "\" holds something that is not a number");
        values.push_back(value.get<double>());
    }
    return values;
}

std::vector<uint64_t> whole_numbers(const Json& object, const std::string& key) {
    std::vector<uint64_t> values;
    const Json& list = member(object, key);
    if (list.is_null()) return values;
    if (!list.is_array()) throw Failure("\"" + key + "\" is not a list");
    for (const Json& value : list) values.push_back(as_whole(value, key));
    return values;
}

const Json& element(const Json& root, const std::string& list, uint64_t index) {
    const Json& values = member(root, list);
    if (!values.is_array() || index >= values.size() || !values[index].is_object()) {
        throw Failure("it has no " + std::to_string(index) + " in \"" + list + "\", which another part of it uses");
    }
    return values[index];
}

}  // namespace gim::gltf
