// Newton's method for the map of a chart: finds the least energy (chart_energy.h) near a map that is upright.
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

// uv: per vertex, every triangle counter-clockwise; none flips. force: on the border; null: the border is free to run over
// itself.
void minimise_energy(const Mesh& mesh, const std::vector<MapElement>& elements, const BorderForce* force,
                     const NewtonOptions& options, std::vector<Vec2>& uv);

}  // namespace gim
