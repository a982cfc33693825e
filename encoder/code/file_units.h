// The units of a file: the steps of its quantizer, and positions counted in them.  spec/gim-format.md, "Header".
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "encoder/surface/mesh.h"
#include "format/container.h"

namespace gim {

// Returns bits, origin and step: one isotropic step for the bounding box of all positions.
Units units_of_box(std::span<const std::span<const Vec3>> positions, uint32_t bits);

// Lossy files code details in frames. Tangential steps are this many times the normal ones. The reference area is the
// mean over the cells of all grids; cells with an undefined sample do not count.
inline constexpr double kTangentialRatio = 3;
class CellArea {
  public:
    // defined: empty, or per sample.
    void add(std::span<const Vec3> positions, std::span<const uint8_t> defined, uint32_t columns, uint32_t rows);
    // Sets tangential ratio and cell area of the units, whose step must be set.
    void set_details(Units* units) const;

  private:
    double sum_ = 0;
    uint64_t cells_ = 0;
};

// Returns the nearest quantizer that the format can hold.
float quantizer_in_range(double quantizer);

// Returns positions as interleaved triples in units. Integers are rounded and clamped to the range of the bits.
template <class Sample>
std::vector<Sample> to_units(std::span<const Vec3> positions, const Units& units) {
    std::vector<Sample> samples;
    samples.reserve(positions.size() * 3);
    const double most = std::exp2(units.bits) - 1;
    for (const Vec3& p : positions) {
        for (int k = 0; k < 3; ++k) {
            const double unit = (p[k] - double{units.origin[static_cast<size_t>(k)]}) / double{units.step};
            if constexpr (std::is_integral_v<Sample>) {
                samples.push_back(static_cast<Sample>(std::clamp(std::floor(unit + 0.5), 0.0, most)));
            } else {
                samples.push_back(static_cast<Sample>(unit));
            }
        }
    }
    return samples;
}

// Returns samples, interleaved triples in units, as positions.
std::vector<Vec3> from_units(std::span<const float> samples, const Units& units);

}  // namespace gim
