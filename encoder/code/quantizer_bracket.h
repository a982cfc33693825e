// Looks for the coarsest quantizer whose file is good enough, where the measure is noisy: a largest distance is that of
// one place, and another place in the next file. Also notices when finer quantizers no longer help.
#pragma once

#include <optional>

namespace gim {

class QuantizerBracket {
  public:
    // decibel_per_octave: what halving the quantizer is expected to gain.
    explicit QuantizerBracket(double decibel_per_octave) : decibel_per_octave_(decibel_per_octave) {}

    // Takes the result of a file. margin: dB by which it is better than the target; negative if it misses the target.
    // -RateSearchValues::kMostMargin tells that the file has no surface.
    void add(double quantizer, double margin);

    // Returns the next quantizer to try. Returns nothing if another file would hardly be smaller, or if none meets the
    // target and finer quantizers gain nothing. Call after add().
    std::optional<double> next() const;

  private:
    struct Tried {
        double octave;  // base-2 logarithm of the quantizer
        double margin;
    };
    std::optional<double> between() const;
    std::optional<double> coarser() const;
    std::optional<double> finer() const;
    double step(double margin) const;

    double decibel_per_octave_;
    std::optional<Tried> met_, missed_;  // the coarsest that meets the target, the finest that misses it
    double best_miss_ = 0;               // margin
    int same_ = 0;                       // files in a row that met the target, or that missed it
    int idle_ = 0;                       // misses in a row that were no better than earlier ones
};

}  // namespace gim
