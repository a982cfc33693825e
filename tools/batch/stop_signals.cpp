#include "tools/batch/stop_signals.h"

namespace gim {
namespace {

constexpr int kStops[] = {SIGINT, SIGTERM, SIGHUP};

bool is_ignored(int signal) {
    struct sigaction now = {};
    return ::sigaction(signal, nullptr, &now) == 0 && (now.sa_flags & SA_SIGINFO) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

StopSignals::StopSignals() {
    ::sigemptyset(&held_);
    for (const int signal : kStops) {
        if (!is_ignored(signal)) ::sigaddset(&held_, signal);
    }
    ::sigprocmask(SIG_BLOCK, &held_, &before_);
}

StopSignals::~StopSignals() {
    int signal = 0;
    while (waiting() != 0 && ::sigwait(&held_, &signal) == 0) {
    }
    ::sigprocmask(SIG_SETMASK, &before_, nullptr);
}

int StopSignals::waiting() const {
    sigset_t now;
    if (::sigpending(&now) != 0) return 0;
    for (const int signal : kStops) {
        if (::sigismember(&held_, signal) == 1 && ::sigismember(&now, signal) == 1) return signal;
    }
    return 0;
}

}  // namespace gim
