#include "encoder/surface/coarsened.h"

#include <cstdint>

#include "encoder/surface/progressive_mesh.h"

namespace gim {

Mesh coarsened_to(const Mesh& mesh, double vertices) {
    if (double(mesh.positions.size()) <= vertices) return mesh;
    ProgressiveMesh coarse(mesh);
    simplify(coarse, mesh.positions, {static_cast<uint32_t>(vertices), false, {}});
    return coarse.coarsened() ? coarse.compact(mesh.positions).mesh : mesh;
}

}  // namespace gim
