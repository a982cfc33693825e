// A .gim file of a scene: its domain, and what instances of it need.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "gim/encoder.h"
#include "gim/refine.h"
#include "tools/file.h"

namespace gim {

inline constexpr uint32_t kDiscreteLevels = 4;

// Aligned memory for the C interface.
class AlignedMemory {
  public:
    explicit AlignedMemory(uint64_t size = 0) : blocks_(size / sizeof(Block) + 1) {}
    void* get() { return blocks_.data(); }
    size_t size() const { return blocks_.size() * sizeof(Block); }

  private:
    struct alignas(16) Block {
        std::byte bytes[16];
    };
    std::vector<Block> blocks_;
};

class SceneSurface {
  public:
    // Reads the first image of a file, at level 0.
    static Result<SceneSurface> read(const std::string& path);

    const gim_domain* domain() const { return domain_; }
    const gim_domain_info& shape() const { return shape_; }
    const gim_info& info() const { return info_; }
    const Bytes& file() const { return file_; }
    const std::array<double, 3>& middle() const { return middle_; }
    double longest_side() const { return longest_side_; }
    double radius() const { return radius_; }  // of a ball around the middle

    // A level that an engine would keep as a mesh of its own: every 2^level-th sample.
    struct DiscreteLevel {
        double error = 0;  // object units: how far it is from the samples that it leaves out
        uint32_t triangles = 0;
        std::vector<gim_patch> patches;
    };
    const std::vector<DiscreteLevel>& levels() const { return levels_; }

  private:
    SceneSurface() = default;
    gim_status open();
    gim_status make_levels();

    Bytes file_;
    gim_info info_{};
    gim_domain_info shape_{};
    std::vector<float> positions_;
    AlignedMemory memory_;
    const gim_domain* domain_ = nullptr;
    std::array<double, 3> middle_ = {};
    double longest_side_ = 0, radius_ = 0;
    std::vector<DiscreteLevel> levels_;
};

}  // namespace gim
