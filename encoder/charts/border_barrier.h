// Keeps the border of a chart's map clear of itself: finds crossings, and pushes close parts of the border apart.
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

// Finds two edges (numbers of their first corners) in which a closed polygon touches or crosses itself. Empty if there
// are none. O(n) if the edges have similar lengths.
std::optional<std::array<uint32_t, 2>> find_crossing(const std::vector<Vec2>& polygon);

// A force on the border of a chart, in addition to the map's own energy.
class BorderForce {
  public:
    virtual ~BorderForce() = default;
    // Returns infinity if the map is not allowed.
    virtual double energy(const std::vector<Vec2>& uv) const = 0;
    // add(vertex, gradient, upper bound on the vertex's block of the Hessian)
    using Add = std::function<void(uint32_t, const Vec2&, const Eigen::Matrix2d&)>;
    virtual void derivatives(const std::vector<Vec2>& uv, const Add& add) const = 0;
};

// Keeps a border from running into itself. Its energy is the sum of weight * (reach / d - 1)^2 over all border vertices
// and border edges that are closer than `reach` in the map but not along the border. d: their distance in the map.
class BorderBarrier : public BorderForce {
  public:
    BorderBarrier(const Chart& chart, double weight);

    double energy(const std::vector<Vec2>& uv) const override;
    void derivatives(const std::vector<Vec2>& uv, const Add& add) const override;

  private:
    // Calls body(vertex and edge, where on the edge (0..1), distance, direction from edge to vertex) for every close
    // pair. Returns false if the border crosses itself.
    template <class Body>
    bool for_each_close(const std::vector<Vec2>& uv, const Body& body) const;
    bool near_along(size_t vertex, size_t edge) const;

    const std::vector<uint32_t>& loop_;
    double weight_, reach_ = 0;
    std::vector<double> along_;
};

}  // namespace gim
