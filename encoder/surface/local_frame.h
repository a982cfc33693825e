// Where a surface is coded: in object space, or around its own corner if binary32 would spoil its coordinates.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "encoder/base/result.h"
#include "encoder/surface/mesh.h"
#include "gim/encoder.h"

namespace gim {

// Positions of the frame plus `origin` are positions in object space.
struct LocalFrame {
    Vec3 origin = Vec3::Zero();
    bool is_moved = false;  // false: the frame is object space
};

// Whether the format can hold positions with so many bits. The message names one that is too far from 0, or the
// farthest one of a surface that is too large or too small for the format's steps. name(i) names position i.
Result<void> check_extent(std::span<const Vec3> positions, uint32_t bits, Stage stage,
                          const std::function<std::string(size_t)>& name);
// The same for the vertices that triangles use, which must not all be at one place. Leaves it to clean() to find what is
// no number or no vertex.
Result<void> check_extent(const TriangleMesh& mesh, uint32_t bits);

// Returns the frame for a surface through these points. It is moved only where binary32 rounds a coordinate by more
// than a hundredth of a step because the surface lies many of its extents away from 0.
LocalFrame choose_frame(std::span<const Vec3> positions, uint32_t bits);

// Moves positions from object space into the frame.
void move_into(const LocalFrame& frame, std::span<Vec3> positions);
// Returns the mesh in the frame; nothing if that is object space, to save the copy.
std::optional<TriangleMesh> moved_into(const LocalFrame& frame, const TriangleMesh& mesh);

// Turns places of the report and of intermediate states back into object space.
void move_out_of(const LocalFrame& frame, EncodeReport& report);
Observer moved_out_of(const LocalFrame& frame, const Observer& observer);

}  // namespace gim
