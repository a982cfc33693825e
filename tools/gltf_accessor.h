// Accessors: numbers in buffer views.
#pragma once

#include "tools/gltf_file.h"

namespace gim::gltf {

// The values of an accessor, `width` numbers in each of `count` rows. Refers to the file's bytes, or holds its own
// numbers where an accessor is sparse, has no buffer view, or was compressed by Draco.
struct Column {
    uint64_t count = 0;
    size_t width = 0;
    std::vector<double> own;

    // Used if `own` is empty.
    const uint8_t* bytes = nullptr;
    size_t stride = 0;
    uint64_t component_type = 0;
    bool normalized = false;

    // row < count, k < width. Normalized integers become numbers from 0 or -1 to 1.
    double at(uint64_t row, size_t k) const;
};

Column read_column(File& file, uint64_t accessor);

// The vertex numbers of an index accessor, as they stand.
struct Indices {
    std::vector<uint32_t> values;
    uint32_t restart = UINT32_MAX;  // the largest number of the component type: begins a new strip or fan
};
Indices read_indices(File& file, uint64_t accessor);

}  // namespace gim::gltf
