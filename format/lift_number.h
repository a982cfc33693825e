// A lifting step whose constants are values, so that code is compiled once for all steps and wavelets of a type. Gives the
// bits of Wavelet::lift (format/lifting.h, format/tile_lifting.h).
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/inline.h"

namespace gim {

// A number of an image whose kind is known at run time only: the bits of an int32_t or of a float. It may stand for memory
// that elsewhere is named by its kind.
#if defined(__GNUC__)
typedef uint32_t __attribute__((may_alias)) Number;
#else
typedef uint32_t Number;
#endif

// Which step of a wavelet, and whether it is done or undone.
struct LiftStep {
    int number = 0;
    float factor = 0;  // of a wavelet on floats
    bool undo = false;
};

// Steps of the reversible 5/3.
class LiftInteger {
  public:
    using Sample = int32_t;
    using Sum = int64_t;

    explicit LiftInteger(const LiftStep& step)
        : rounding_(step.number == 0 ? 0 : 2),
          shift_(step.number == 0 ? 1 : 2),
          sign_((step.number == 0) != step.undo ? UINT32_MAX : 1) {}

    Sample operator()(Sample x, Sample a, Sample b) const {
        const uint32_t sum = static_cast<uint32_t>(a) + static_cast<uint32_t>(b);
        return add(x, static_cast<uint32_t>(static_cast<int32_t>(sum + rounding_) >> shift_));
    }
    // A low sample at a vertex. edges, faces: the sums of the details beside it; n: its valence.
    Sample at_vertex(Sample x, Sum edges, Sum faces, uint32_t n) const {
        const int64_t divisor = 4 * int64_t{n}, sum = 4 * edges + faces + 2 * int64_t{n};
        return add(x, static_cast<uint32_t>(sum / divisor - (sum % divisor < 0)));  // rounds down
    }

  private:
    Sample add(Sample x, uint32_t change) const {
        return static_cast<int32_t>(static_cast<uint32_t>(x) + sign_ * change);
    }

    uint32_t rounding_;
    int shift_;
    uint32_t sign_;  // 1 or -1
};

// Steps of the wavelets on floats. Negating a factor changes the sign of a product and no other bit.
class LiftFloat {
  public:
    using Sample = float;
    using Sum = float;

    explicit LiftFloat(const LiftStep& step) : factor_(step.factor), sign_(step.undo ? -1.0f : 1.0f) {}

    Sample operator()(Sample x, Sample a, Sample b) const { return x + sign_ * factor_ * (a + b); }
    Sample at_vertex(Sample x, Sum edges, Sum faces, uint32_t n) const {
        const float change = (factor_ * edges + (factor_ * factor_) * faces) * (4.0f / static_cast<float>(n));
        return x + sign_ * change;
    }

  private:
    float factor_, sign_;
};

// to[i] from a[i] and b[i]. `to` overlaps neither a nor b.
template <class Lift, class Sample>
GIM_ALWAYS_INLINE void lift_numbers(const Lift& lift, Sample* __restrict to, const Sample* a, const Sample* b,
                                    size_t count) {
    for (size_t i = 0; i < count; ++i) to[i] = lift(to[i], a[i], b[i]);
}

}  // namespace gim
