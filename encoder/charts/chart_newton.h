// Finds the least energy (chart_energy.h) near an upright map of a chart, by Newton's method.
#pragma once

#include <limits>
#include <vector>

#include "encoder/charts/border_barrier.h"
#include "encoder/charts/chart_energy.h"
#include "encoder/surface/mesh.h"

namespace gim {

struct NewtonOptions {
    int most_steps = 0;
    double tolerance = 0;                                       // stops when a step gains less than this part
    double hopeless = std::numeric_limits<double>::infinity();  // gives up early while the energy is above this
};

// uv: per vertex. Every triangle is counter-clockwise and stays so. force: acts on the border; if null, the border may
// cross itself.
void minimise_energy(const Mesh& mesh, const std::vector<MapElement>& elements, const BorderForce* force,
                     const NewtonOptions& options, std::vector<Vec2>& uv);

}  // namespace gim
