// A small software rasteriser that draws a mesh on any machine: z-buffer, one key and one fill light, edges smoothed by
// averaging kSupersampling^2 samples per pixel. Deterministic. Cost O(triangles + pixels).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "gim/encoder.h"
#include "tools/decoded.h"
#include "tools/picture.h"

namespace gim {

enum class UpAxis { kAuto, kX, kY, kZ };  // kAuto: z for flat models that lie in the x-y plane (terrain), else y

struct View {
    UpAxis up = UpAxis::kAuto;
    double azimuth = 35;    // degrees, turns the model about its up axis
    double elevation = 20;  // degrees, looks down from above
    uint32_t size = 512;    // pixels per side
    bool flat = false;      // one normal per triangle instead of smooth shading
    bool wire = false;      // draws the triangles' edges
};

// Draws the mesh so that it fills the picture. Faces seen from behind are reddish, so holes and flipped faces show.
// Smooth shading uses the mesh's own normals if it has some. Leaves out triangles with a non-finite corner. `lines`:
// edges of the mesh, in red, paler behind the surface.
Picture render_mesh(const TriangleMesh& mesh, const View& view, std::span<const std::array<uint32_t, 2>> lines = {});

// Draws the mesh grey, with its defects against a reference: folded triangles red, edges folded back dark red, area whose
// shading normal is off by more than 45 degrees orange, by more than 20 pale yellow. Backs are bluish. The smallest fold
// is a dot of a few pixels. A fold that lies closely under other parts of the surface shows too.
Picture render_defects(const TriangleMesh& mesh, const DefectMap& defects, const View& view);

// Draws a flat map of the mesh so that it fills the picture. uv per vertex, v downwards. Blue: the map squeezes the
// surface, which gets fewer samples than its share. White: its share. Orange: more.
Picture render_map(const TriangleMesh& mesh, std::span<const std::array<double, 2>> uv, uint32_t size);

// Draws the geometry images themselves: x y z in the bounding box as red green blue. Several images become tiles.
Picture render_images(std::span<const DecodedImage> images, uint32_t size);

}  // namespace gim
