// Which level to show: by its error in pixels.
#include <cmath>

#include "gim/decoder.h"

namespace {

constexpr float kShareForCoarser = 0.75f;  // of the pixels allowed

}  // namespace

uint32_t gim_choose_level(const gim_info* info, const gim_view* view, uint32_t shown) {
    if (!info || !view) return 0;
    const float half_height = std::tan(0.5f * view->vertical_fov);
    // Object units that one pixel covers at this distance.
    const float unit = 2 * half_height * view->distance / view->viewport_height;
    if (!(unit > 0) || !(view->pixel_error > 0)) return 0;
    for (uint32_t level = info->level_count; level-- > 1;) {
        const float error = info->level_max_error[level];
        const float share = level > shown ? kShareForCoarser : 1;
        if (error > 0 && error <= share * view->pixel_error * unit) return level;
    }
    return 0;
}
