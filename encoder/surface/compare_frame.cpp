#include "encoder/surface/compare_frame.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>

namespace gim {

namespace {

// Extents whose powers up to the eighth are normal doubles, with room for short edges.
constexpr int kMostExponent = 100;
// Beyond so many extents from 0, the surfaces are compared around the reference.
constexpr double kFar = 0x1p20;

}  // namespace

CompareFrame choose_compare_frame(const Mesh& reference, const Mesh& test) {
    Vec3 low = Vec3::Constant(INFINITY), high = -low;
    for (const Mesh* mesh : {&reference, &test}) {
        for (const Triangle& t : mesh->triangles) {
            for (const uint32_t v : t) {
                low = low.cwiseMin(mesh->positions[v]);
                high = high.cwiseMax(mesh->positions[v]);
            }
        }
    }
    CompareFrame frame;
    // Half of it, because the whole may be infinite.
    const double half_extent = (0.5 * high - 0.5 * low).maxCoeff();
    if (!(half_extent > 0)) return frame;
    const int exponent = std::ilogb(half_extent) + 1;
    if (std::abs(exponent) > kMostExponent) frame.exponent = exponent;
    if (std::max(low.cwiseAbs().maxCoeff(), high.cwiseAbs().maxCoeff()) / kFar > half_extent) frame.origin = low;
    return frame;
}

void move_into(const CompareFrame& frame, Mesh& mesh) {
    if (frame.exponent == 0 && frame.origin.isZero(0)) return;
    const auto scaled = [&](double x) { return std::ldexp(x, -frame.exponent); };
    for (Vec3& p : mesh.positions) {
        for (int k = 0; k < 3; ++k) p[k] = scaled(p[k]) - scaled(frame.origin[k]);
    }
}

void move_out_of(const CompareFrame& frame, Comparison& c) {
    for (double* length :
         {&c.diagonal, &c.rms_to_test, &c.rms_to_reference, &c.rms, &c.max_to_test, &c.max_to_reference, &c.hausdorff})
        *length = std::ldexp(*length, frame.exponent);
    if (!c.defects || c.defects->largest_fold.faces == 0) return;
    Defects::Fold& fold = c.defects->largest_fold;
    fold.area = std::ldexp(fold.area, 2 * frame.exponent);
    for (size_t k = 0; k < 3; ++k)
        fold.center[k] = std::ldexp(fold.center[k], frame.exponent) + frame.origin[static_cast<int>(k)];
}

}  // namespace gim
