// The volume that a closed surface encloses.
#pragma once

#include "encoder/surface/mesh.h"

namespace gim {

inline double volume_of(const Mesh& mesh) {
    double volume = 0;
    for (const Triangle& t : mesh.triangles)
        volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
    return volume;
}

}  // namespace gim
