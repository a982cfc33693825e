// Removes unfinished files when a signal ends the program.
#pragma once

#include <string>

namespace gim {

// Prepares the process that runs the program. Installs the handlers of all signals that end a program and can be caught:
// they remove the unfinished files, then let the signal do what it does. Ignored signals stay ignored. A file that
// grows beyond the limit (SIGXFSZ) becomes a failed write. Opens the null device for standard streams that are closed,
// so that no file of ours takes their number; reads and writes of those streams fail.
void prepare_process();

// A path that is removed if a signal comes while this lives.
class RemovedOnSignal {
  public:
    explicit RemovedOnSignal(std::string path);
    RemovedOnSignal(const RemovedOnSignal&) = delete;
    RemovedOnSignal& operator=(const RemovedOnSignal&) = delete;
    ~RemovedOnSignal();

  private:
    struct Entry;
    friend struct Removal;
    Entry* entry_;
};

}  // namespace gim
