// A conformance vector by its name.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "tests/decoder/vectors.h"

namespace gim::test {

// name: of a valid file, without its extension.
inline std::vector<uint8_t> vector_file(const std::string& name) {
    std::vector<uint8_t> bytes = read_bytes(std::string(GIM_SOURCE_DIR) + "/spec/vectors/valid/" + name + ".gim");
    EXPECT_FALSE(bytes.empty()) << name;
    return bytes;
}

}  // namespace gim::test
