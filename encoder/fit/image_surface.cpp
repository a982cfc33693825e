#include "encoder/fit/image_surface.h"

#include <utility>

#include "encoder/base/parallel.h"

namespace gim {

ImageSurface::ImageSurface(const std::vector<Vec3>& positions, GridFaces faces)
    : mesh{positions, std::move(faces.triangles)},
      slot(std::move(faces.slot)),
      normals(mesh.triangles.size()),
      areas(normals.size()) {
    parallel_blocks(normals.size(), 16384, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t f = begin; f < end; ++f) {
            const Triangle& t = mesh.triangles[f];
            const Vec3& a = positions[t[0]];
            const Vec3 cross = (positions[t[1]] - a).cross(positions[t[2]] - a);
            const double length = cross.norm();
            areas[f] = 0.5 * length;
            normals[f] = length > 0 ? Vec3(cross / length) : Vec3(Vec3::Zero());
        }
    });
}

}  // namespace gim
