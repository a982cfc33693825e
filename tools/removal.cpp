#include "tools/removal.h"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <utility>

namespace gim {

struct RemovedOnSignal::Entry {
    std::string path;
    std::atomic<bool> is_there = true;
    Entry* next = nullptr;
};

// A handler of signals can reach nothing but static memory, so this list is the program's only global state. Entries
// are added at the front and never freed: a handler may be on its way through them at any time.
struct Removal {
    static inline std::atomic<RemovedOnSignal::Entry*> first = nullptr;

    static void add(RemovedOnSignal::Entry* entry) {
        entry->next = first.load();
        while (!first.compare_exchange_weak(entry->next, entry)) {
        }
    }

    // Calls only what a handler may call. The signal is blocked here and has its default action again, so raise() ends
    // the program on return.
    static void remove_all(int signal) {
        for (const RemovedOnSignal::Entry* entry = first.load(); entry != nullptr; entry = entry->next) {
            if (entry->is_there.load()) ::unlink(entry->path.c_str());
        }
        ::raise(signal);
    }
};

namespace {

bool ends_a_program(int signal) {
    for (const int other : {SIGCHLD, SIGCONT, SIGSTOP, SIGTSTP, SIGTTIN, SIGTTOU, SIGURG, SIGWINCH}) {
        if (signal == other) return false;
    }
    return true;
}

// Handles the signal unless somebody else does, or it is ignored (nohup).
void handle(int signal, void (*handler)(int)) {
    struct sigaction now = {};
    if (::sigaction(signal, nullptr, &now) != 0 || (now.sa_flags & SA_SIGINFO) != 0 || now.sa_handler != SIG_DFL)
        return;
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = static_cast<int>(SA_RESETHAND);
    ::sigfillset(&action.sa_mask);
    ::sigaction(signal, &action, nullptr);
}

// A read of the stream for results, or a write of the input, must fail as it would with the closed one.
void open_if_closed(int stream, int mode) {
    if (::fcntl(stream, F_GETFD) != -1) return;
    const int opened = ::open("/dev/null", mode);  // takes the lowest free number: those below are open
    if (opened >= 0 && opened != stream) ::close(opened);
}

}  // namespace

void prepare_process() {
    open_if_closed(STDIN_FILENO, O_WRONLY);
    open_if_closed(STDOUT_FILENO, O_RDONLY);
    open_if_closed(STDERR_FILENO, O_WRONLY);
    // The reason of a failure is lost if it comes before the last flush. So all results wait for it.
    static std::array<char, size_t{1} << 20> results;
    if (::isatty(STDOUT_FILENO) == 0) std::setvbuf(stdout, results.data(), _IOFBF, results.size());
    handle(SIGXFSZ, SIG_IGN);
    for (int signal = 1; signal <= SIGRTMAX; ++signal) {
        if (ends_a_program(signal)) handle(signal, Removal::remove_all);
    }
}

RemovedOnSignal::RemovedOnSignal(std::string path) : entry_(new Entry{std::move(path)}) { Removal::add(entry_); }

RemovedOnSignal::~RemovedOnSignal() { entry_->is_there.store(false); }

}  // namespace gim
