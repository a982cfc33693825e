// A .gim file of a scene: its domain, and what instances of it need.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gim/decoder.hpp"
#include "gim/encoder.h"
#include "gim/refine.h"
#include "tools/file.h"

namespace gim {

inline constexpr uint32_t kDiscreteLevels = 4;

class SceneSurface {
  public:
    // Reads the first image of a file, at level 0, with its displacements if it has some.
    static Result<SceneSurface> read(const std::string& path);

    const gim_domain* domain() const { return domain_; }
    const gim_domain_info& shape() const { return shape_; }
    const gim_info& info() const { return info_; }
    const Bytes& file() const { return file_; }
    bool has_details() const { return has_details_; }
    const std::vector<float>& positions() const { return positions_; }        // three floats a vertex
    const std::vector<uint32_t>& finest_indices() const { return indices_; }  // of the mesh of all samples
    const std::array<double, 3>& middle() const { return middle_; }
    double longest_side() const { return longest_side_; }
    double radius() const { return radius_; }  // of a ball around the middle

    // The mesh of all samples.
    const std::vector<gim_patch>& finest_patches() const { return finest_patches_; }
    uint32_t finest_triangles() const { return finest_triangles_; }

    // A mesh that an engine would keep for one distance: level 0, then simplified to a quarter again and again by
    // meshoptimizer, which keeps a part of the vertices.
    struct DiscreteLevel {
        double error = 0;  // object units: the largest distance to level 0 that sampling found, both ways
        std::vector<std::array<uint32_t, 3>> triangles;  // samples: row << 16 | column
    };
    const std::vector<DiscreteLevel>& levels() const { return levels_; }

  private:
    SceneSurface() = default;
    gim_status open();
    gim_status open_details(const gim_plane_info& plane);
    gim_status refine_all();
    Result<void> simplify();

    Bytes file_;
    gim_info info_{};
    gim_domain_info shape_{};
    std::vector<float> positions_;
    Scratch memory_;
    const gim_domain* domain_ = nullptr;
    std::array<double, 3> middle_ = {};
    bool has_details_ = false;
    double longest_side_ = 0, radius_ = 0;
    std::vector<gim_patch> finest_patches_;
    uint32_t finest_triangles_ = 0;
    std::vector<uint32_t> indices_;
    std::vector<uint32_t> sample_of_;  // per vertex, one of its samples
    std::vector<DiscreteLevel> levels_;
};

}  // namespace gim
