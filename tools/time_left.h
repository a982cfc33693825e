// Estimates how long running work still takes.
#pragma once

#include <optional>
#include <string>

namespace gim {

// Follows work that tells which part of it is done. Work that begins anew, as the stages of a search do, is estimated anew.
class TimeLeft {
  public:
    // Takes what part is done, 0 to 1, and the time in seconds on any clock that only rises. Returns the seconds that are left
    // if the rest goes on as the part since the beginning did. Nothing while that part is too short to tell.
    std::optional<double> update(double fraction, double now);

  private:
    double first_fraction_ = 0, last_fraction_ = 2, begin_ = 0;  // 2: nothing yet
};

// Returns "8 s", "2 min 10 s" or "1 h 5 min". Rounded more coarsely the more it is; not negative.
std::string duration_text(double seconds);

}  // namespace gim
