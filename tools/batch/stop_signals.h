// Holds back the signals that ask a batch to stop, so that it can end in order.
#pragma once

#include <csignal>

namespace gim {

// While it lives, SIGINT, SIGTERM and SIGHUP wait. Those that the process ignores (nohup) stay ignored. At the end they
// are forgotten, since whoever held them back obeyed them.
class StopSignals {
  public:
    StopSignals();
    StopSignals(const StopSignals&) = delete;
    StopSignals& operator=(const StopSignals&) = delete;
    ~StopSignals();

    // The signal that waits, or 0.
    int waiting() const;

  private:
    sigset_t held_ = {};
    sigset_t before_ = {};
};

}  // namespace gim
