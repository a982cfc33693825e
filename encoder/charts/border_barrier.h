// Keeps the border of a chart's map clear of itself: finds where it crosses, and pushes apart what comes close.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "encoder/charts/chart_set.h"
#include "encoder/surface/mesh.h"

namespace gim {

// Two edges (numbers of their first corners) in which a closed polygon touches or crosses itself, if it does. O(n) for
// polygons with edges of similar length.
std::optional<std::array<uint32_t, 2>> find_crossing(const std::vector<Vec2>& polygon);

// A force on the border of a chart beside the map's own energy.
class BorderForce {
  public:
    virtual ~BorderForce() = default;
    // Infinite where the map is not allowed.
    virtual double energy(const std::vector<Vec2>& uv) const = 0;
    // add(vertex, gradient, a bound from above on the vertex's block of the Hessian)
    using Add = std::function<void(uint32_t, const Vec2&, const Eigen::Matrix2d&)>;
    virtual void derivatives(const std::vector<Vec2>& uv, const Add& add) const = 0;
};

// Keeps a border from running into itself: weight * (reach / d - 1)^2 for every border vertex and border edge that are
// closer than `reach` in the plane but not along the border.
class BorderBarrier : public BorderForce {
  public:
    BorderBarrier(const Chart& chart, double weight);

    double energy(const std::vector<Vec2>& uv) const override;
    void derivatives(const std::vector<Vec2>& uv, const Add& add) const override;

  private:
    // Calls body(pair, distance, direction from edge to vertex) for every close pair. False when the border crosses
    // itself.
    template <class Body>
    bool for_each_close(const std::vector<Vec2>& uv, const Body& body) const;
    bool near_along(size_t vertex, size_t edge) const;

    const std::vector<uint32_t>& loop_;
    double weight_, reach_ = 0;
    std::vector<double> along_;
};

}  // namespace gim
