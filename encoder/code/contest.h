// What a rate search knows of its rivals.
#pragma once

namespace gim {

// Other sides of the square that code to the same target. A search that is sure to lose against them ends early, with an
// error.
struct Contest {
    double rival_bytes = 0;         // of a file that meets the target; 0: none yet
    bool is_finer_to_come = false;  // a larger side follows, so it is no use to go on where the samples are too few
    bool is_target_rough = false;  // the target is a PSNR of another layout's brief fit: one full fit comes near enough
};

}  // namespace gim
