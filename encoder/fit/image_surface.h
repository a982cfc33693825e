// The surface of an image's samples, as the fit needs it: faces with normals and areas.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/image/gluing.h"
#include "encoder/surface/mesh.h"

namespace gim {

struct ImageSurface {
    Mesh mesh;
    std::vector<uint32_t> slot;  // per face (GridFaces)
    std::vector<Vec3> normals;   // per face; zero if it has no area
    std::vector<double> areas;

    ImageSurface(const std::vector<Vec3>& positions, const GridGluing& gluing)
        : ImageSurface(positions, triangulate_grid(positions, gluing)) {}

    double area() const {
        double sum = 0;
        for (const double a : areas) sum += a;
        return sum;
    }

  private:
    ImageSurface(const std::vector<Vec3>& positions, GridFaces faces);
};

// Returns whether a corner is marked.
inline bool touches(const Triangle& t, const std::vector<bool>& marked) {
    return marked[t[0]] || marked[t[1]] || marked[t[2]];
}

// Returns v at length 1, or `otherwise` if v has no direction.
inline Vec3 direction_or(const Vec3& v, const Vec3& otherwise) {
    const double length = v.norm();
    return length > 1e-14 ? Vec3(v / length) : otherwise;
}

}  // namespace gim
