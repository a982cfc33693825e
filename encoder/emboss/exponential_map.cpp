#include "encoder/emboss/exponential_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace gim {
namespace {

// Neighbours of all vertices, one list after the other.
struct Neighbours {
    std::vector<uint32_t> first, at;

    explicit Neighbours(const Mesh& mesh) : first(mesh.positions.size() + 1, 0) {
        for (const Triangle& t : mesh.triangles)
            for (const uint32_t v : t) first[v + 1] += 2;
        for (size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];
        at.resize(first.back());
        std::vector<uint32_t> next(first.begin(), first.end() - 1);
        for (const Triangle& t : mesh.triangles) {
            for (size_t i = 0; i < 3; ++i) {
                at[next[t[i]]++] = t[(i + 1) % 3];
                at[next[t[i]]++] = t[(i + 2) % 3];
            }
        }
    }
    template <class F>
    void for_each(uint32_t v, const F& f) const {
        for (uint32_t i = first[v]; i < first[v + 1]; ++i) f(at[i]);
    }
};

class Walk {
  public:
    Walk(const Mesh& mesh, const std::vector<Vec3>& normals, const MapOrigin& origin, double radius)
        : mesh_(mesh),
          normals_(normals),
          origin_(origin),
          radius_(radius),
          neighbours_(mesh),
          map_(mesh.positions.size(), Vec2::Constant(std::numeric_limits<double>::quiet_NaN())),
          distance_(mesh.positions.size(), HUGE_VAL),
          is_settled_(mesh.positions.size(), false) {}

    std::vector<Vec2> run() {
        for (const uint32_t v : mesh_.triangles[origin_.triangle]) {
            map_[v] = unrolled(origin_.outside, mesh_.positions[v] - origin_.point);
            is_start_.push_back(v);
            reach(v, map_[v].norm());
        }
        while (!queue_.empty()) {
            const auto [distance, v] = queue_.top();
            queue_.pop();
            if (-distance > distance_[v]) continue;
            settle(v);
        }
        return std::move(map_);
    }

  private:
    // A step from a point with this normal, in the plane of the map. Its length is kept.
    Vec2 unrolled(const Vec3& normal, const Vec3& step) const {
        const auto turn = Eigen::Quaterniond::FromTwoVectors(origin_.outside, normal);
        const Vec2 flat(step.dot(turn * origin_.right), step.dot(turn * origin_.up));
        const double length = flat.norm();
        return length > 0 ? Vec2(flat * (step.norm() / length)) : Vec2::Zero();
    }
    void reach(uint32_t v, double distance) {
        if (distance >= distance_[v] || distance > radius_) return;
        distance_[v] = distance;
        queue_.emplace(-distance, v);
    }
    void settle(uint32_t v) {
        const bool is_start = std::find(is_start_.begin(), is_start_.end(), v) != is_start_.end();
        if (!is_start) map_[v] = mean_of_settled(v);
        is_settled_[v] = true;
        neighbours_.for_each(v, [&](uint32_t q) {
            if (!is_settled_[q]) reach(q, distance_[v] + (mesh_.positions[q] - mesh_.positions[v]).norm());
        });
    }
    // What the neighbours that are nearer to the middle say, near ones more.
    Vec2 mean_of_settled(uint32_t v) const {
        Vec2 sum = Vec2::Zero();
        double weight = 0;
        neighbours_.for_each(v, [&](uint32_t p) {
            if (!is_settled_[p]) return;
            const Vec3 step = mesh_.positions[v] - mesh_.positions[p];
            const double w = 1 / std::max(step.norm(), 1e-30);
            // Half way, the surface has about the mean of both normals.
            const Vec3 normal = (normals_[p] + normals_[v]).normalized();
            sum += w * (map_[p] + unrolled(normal.allFinite() ? normal : normals_[p], step));
            weight += w;
        });
        return sum / weight;
    }

    const Mesh& mesh_;
    const std::vector<Vec3>& normals_;
    const MapOrigin& origin_;
    double radius_;
    Neighbours neighbours_;
    std::vector<Vec2> map_;
    std::vector<double> distance_;
    std::vector<bool> is_settled_;
    std::vector<uint32_t> is_start_;
    std::priority_queue<std::pair<double, uint32_t>> queue_;  // the nearest first: distances are negative
};

}  // namespace

std::vector<Vec2> exponential_map(const Mesh& mesh, const std::vector<Vec3>& normals, const MapOrigin& origin,
                                  double radius) {
    return Walk(mesh, normals, origin, radius).run();
}

}  // namespace gim
