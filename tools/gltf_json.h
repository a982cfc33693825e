// Checked access to the JSON of a glTF file. Every function throws a Failure that names what is wrong.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace gim::gltf {

using Json = nlohmann::json;

// Caught in read_gltf, never beyond.
class Failure : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Returns a null value if `object` is no object or has no such member.
const Json& member(const Json& object, const std::string& key);
const Json& extension(const Json& object, const std::string& name);

// Returns nothing if the member is missing. Fails if it is not a whole number from 0 on.
std::optional<uint64_t> whole_number(const Json& object, const std::string& key);
double real_number(const Json& object, const std::string& key, double missing);
// Returns `missing` if there is no string.
std::string text(const Json& object, const std::string& key, const std::string& missing = "");
// Returns the numbers of an array. Empty if it is missing; fails if it has another size than `size` (0: any).
std::vector<double> numbers(const Json& object, const std::string& key, size_t size = 0);
// Returns the whole numbers of an array. Empty if it is missing.
std::vector<uint64_t> whole_numbers(const Json& object, const std::string& key);

// Returns an object of one of the lists at the top: element(root, "meshes", 3). Fails if there is none.
const Json& element(const Json& root, const std::string& list, uint64_t index);

}  // namespace gim::gltf
