#include "tools/time_left.h"

#include <algorithm>
#include <cmath>

namespace gim {
namespace {

constexpr double kLeastSeconds = 2, kLeastPart = 0.03;  // of which an estimate is made

}  // namespace

std::optional<double> TimeLeft::update(double fraction, double now) {
    if (fraction < last_fraction_) {
        first_fraction_ = fraction;
        begin_ = now;
    }
    last_fraction_ = fraction;
    const double done = fraction - first_fraction_, seconds = now - begin_;
    if (done < kLeastPart || seconds < kLeastSeconds) return {};
    return seconds * std::max(0.0, 1 - fraction) / done;
}

std::string duration_text(double seconds) {
    const auto rounded = [](double value, double to) { return static_cast<long long>(std::round(value / to) * to); };
    const double s = std::clamp(seconds, 0.0, 1e9);
    if (s < 59.5) return std::to_string(rounded(s, 1)) + " s";
    if (s < 3570) {
        const long long all = rounded(s, 10);
        return std::to_string(all / 60) + " min" + (all % 60 > 0 ? " " + std::to_string(all % 60) + " s" : "");
    }
    const long long minutes = rounded(s / 60, 5);
    return std::to_string(minutes / 60) + " h" + (minutes % 60 > 0 ? " " + std::to_string(minutes % 60) + " min" : "");
}

}  // namespace gim
