// Looks for the quantizer whose file meets a target closely, by the secant of the last two files.
#pragma once

#include <optional>

namespace gim {

class NextQuantizer {
  public:
    // most_step: octaves from one quantizer to the next.
    explicit NextQuantizer(double most_step) : most_step_(most_step) {}

    // Takes the result of a file and returns the quantizer to try next. room: by how many octaves the quantizer could be
    // coarser if a file changed as usual (octaves_to()); negative if it has to be finer.
    double after(double quantizer, double room);

    // By how many octaves of room an octave of the quantizer gained, from the last file but one to the last. 1 is usual.
    // Near 0, finer quantizers hardly help. Nothing after fewer than two files, or if both quantizers are about the same.
    std::optional<double> slope() const { return slope_; }

  private:
    struct Tried {
        double octave, room;  // octave: base-2 logarithm of the quantizer
    };
    double most_step_;
    std::optional<Tried> last_;
    std::optional<double> slope_;
};

}  // namespace gim
