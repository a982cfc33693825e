// The model that all stages share: surface points on a grid, and the gluing that makes them one surface.
// Layouts only produce a gluing: squares from a sideband, charts from a mask and a seam record, tiles from a base mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/image/gluing.h"
#include "encoder/surface/mesh.h"

namespace gim {

struct GeometryImage {
    std::vector<Vec3> positions;  // width * height, row-major; zero if undefined; equal if glued
    GridGluing gluing;

    uint32_t width() const { return gluing.width; }
    uint32_t height() const { return gluing.height; }
};

// The image's surface: one vertex for each surface point. Cells are split as the decoder splits them. Triangles with
// two corners at one point are left out. O(samples).
struct Surface {
    Mesh mesh;
    std::vector<uint32_t> sample;  // per vertex: the first sample at its point
};
Surface surface_of(const GeometryImage& image);

// The same triangles over all samples. Vertex v is sample v, so the seams are open.
Mesh samples_as_mesh(const GeometryImage& image);

}  // namespace gim
