// The metrics of a surface's faces, as the solvers of the square and of the tiles weight them.
#pragma once

#include <vector>

#include "encoder/surface/mesh.h"
#include "encoder/surface/stretch.h"

namespace gim {

// How much a face counts. Faces with hardly any area count as if they had some, so that they resist flipping too.
class FaceMetrics {
  public:
    // surface, domain: area of the whole surface, and of what it is mapped to.
    // squeeze: how much a squeeze counts against the stretch of the same factor.
    // importance: per vertex; empty: 1 everywhere.
    FaceMetrics(const std::vector<Vec3>& positions, const std::vector<double>& importance, double surface,
                double domain, double squeeze)
        : positions_(positions),
          importance_(importance),
          surface_(surface),
          squeeze_(squeeze * (surface / domain) * (surface / domain) / 8) {}

    // Sets the least area from the faces that the coarsest mesh has and from the number of faces of the finest one.
    void set_least_area(const std::vector<Triangle>& coarsest, size_t faces);
    FaceMetric of(const Triangle& face) const { return metric_of(face, least_area_); }

  private:
    FaceMetric metric_of(const Triangle& face, double least_area) const;

    const std::vector<Vec3>& positions_;
    const std::vector<double>& importance_;
    double surface_, squeeze_;  // weight of N is this over the face's area
    double least_area_ = 0, least_squeezed_area_ = 0;
};

}  // namespace gim
