// States on the way for the caller's pictures (Observer).
#pragma once

#include <string>
#include <vector>

#include "encoder/charts/atlas.h"
#include "encoder/charts/multi_chart_image.h"
#include "encoder/charts/pack.h"
#include "encoder/image/geometry_image.h"
#include "encoder/squares/open_mesh.h"
#include "gim/encoder.h"

namespace gim {

// An opened mesh and its map.
Snapshot make_snapshot(std::string name, std::string caption, const OpenedMesh& opened, const std::vector<Vec2>& uv);

// A geometry image as a surface; the rim of the square is the cut.
Snapshot make_snapshot(std::string name, std::string caption, const GeometryImage& image);

// Packed charts, and the surface cut open between them.
Snapshot make_snapshot(std::string name, std::string caption, const Atlas& atlas, const Packing& packing);

// A multi-chart image as a surface; the borders of the charts are the cut.
Snapshot make_snapshot(std::string name, std::string caption, const MultiChartImage& image);

}  // namespace gim
