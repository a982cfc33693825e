#include "decoder/told_bounds.h"

#include <algorithm>
#include <cfloat>

#include "format/bounds.h"

namespace gim {
namespace {

constexpr gim_box kEndless = {{-FLT_MAX, -FLT_MAX, -FLT_MAX}, {FLT_MAX, FLT_MAX, FLT_MAX}};

bool read_told_box(const Header& header, uint32_t image, gim_box* box) {
    BoxNumbers numbers;
    if (header.boxes.empty() || !read_box(header.box_bytes(image), &numbers) || !numbers.is_told()) return false;
    const Box told = numbers.box(header);
    std::copy(told.low.begin(), told.low.end(), box->low);
    std::copy(told.high.begin(), told.high.end(), box->high);
    return true;
}

}  // namespace

gim_box image_box(const Header& header, uint32_t image) {
    gim_box box;
    return read_told_box(header, image, &box) ? box : kEndless;
}

void tell_bounds(const Header& header, gim_info* info) {
    for (size_t k = 0; k < header.level_errors.size() / kErrorsOfLevel; ++k) {
        const size_t level = header.kept_levels() - 1 - k;
        info->level_rms_error[level] = error_of(header.level_errors[kErrorsOfLevel * k], header);
        info->level_max_error[level] = error_of(header.level_errors[kErrorsOfLevel * k + 1], header);
    }
    info->has_boxes = 0;
    info->box = kEndless;
    gim_box all = {{FLT_MAX, FLT_MAX, FLT_MAX}, {-FLT_MAX, -FLT_MAX, -FLT_MAX}};
    for (uint32_t image = 0; image < header.image_count(); ++image) {
        gim_box box;
        if (!read_told_box(header, image, &box)) return;
        for (size_t k = 0; k < 3; ++k) {
            all.low[k] = std::min(all.low[k], box.low[k]);
            all.high[k] = std::max(all.high[k], box.high[k]);
        }
    }
    info->has_boxes = 1;
    info->box = all;
}

}  // namespace gim
