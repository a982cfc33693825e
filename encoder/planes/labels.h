// Labels of cells: each cell of the decoded surface takes the label of the input's triangle at its middle.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/base/result.h"
#include "gim/encoder.h"

namespace gim {

// Whether the mesh has labels worth storing: two different ones.
bool has_labels(const TriangleMesh& mesh);

// An Error unless the labels fit the mesh, and the layout can hold them. If it cannot, that is an Error of kCut: then another
// layout may.
Result<void> check_labels(const TriangleMesh& mesh, Layout layout);

// Returns the labels of the cells of a file at full resolution, image after image. input: the mesh as read, with labels, in
// the frame of the file. O(cells log F).
Result<std::vector<uint8_t>> cell_labels(std::span<const uint8_t> file, const TriangleMesh& input, uint32_t threads);

// Returns the file with these labels, which must be as many as its cells. O(cells).
Result<std::vector<uint8_t>> with_labels(std::span<const uint8_t> file, std::span<const uint8_t> labels);

}  // namespace gim
