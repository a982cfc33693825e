#include "encoder/fit/image_basis.h"

#include <algorithm>

#include "encoder/base/parallel.h"

namespace gim {
namespace {

constexpr size_t kTriplesPerBlock = 4096;

// Returns area / cell_area, from scale = (cell_area / area)^(1/4).
float relative_area_of(const DetailFrame& frame, float cell_area) {
    const float s2 = frame.scale * frame.scale;
    return cell_area > 0 ? 1 / (s2 * s2) : 1;
}

}  // namespace

void ImageBasis::add_base(size_t triples, float step, float norm) {
    base_size_ += 3 * triples;
    const size_t count = base_size_ / 3;
    frames_.resize(count, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 1});
    steps_.resize(count, step);
    tangential_steps_ = steps_;  // unused for the base, which has no tangents
    areas_.resize(count, 1);
    norms_.resize(count, norm);
}

void ImageBasis::add_detail(const DetailFrame& frame, const DetailSteps& steps, Orientation orientation, float norm) {
    frames_.push_back(frame);
    float step[3];
    steps_in(frame, steps, orientation, step);
    steps_.push_back(step[0]);
    tangential_steps_.push_back(step[1]);
    areas_.push_back(relative_area_of(frame, steps.cell_area));
    norms_.push_back(norm);
}

void ImageBasis::turn(Coordinates& coordinates, Way way) const {
    parallel_blocks(frames_.size(), kTriplesPerBlock, 0, [&](size_t, size_t begin, size_t end) {
        for (size_t i = std::max(begin, base_size_ / 3); i < end; ++i) {
            float* c = &coordinates[3 * i];
            const float from[3] = {c[0], c[1], c[2]};
            way == Way::kIntoFrames ? into_frame(frames_[i], from, c) : out_of_frame(frames_[i], from, c);
        }
    });
}

}  // namespace gim
