// Encodes one input in a process of its own.
//
// A process costs a few milliseconds, and gives what threads cannot: an input that crashes the encoder, or that takes
// all memory, ends its own process, with a reason, and no other. The process is a fork without a new program: the
// parent has one thread, so all of its state is whole in the child.
#pragma once

#include <sys/types.h>

#include <optional>
#include <string>

#include "tools/batch/batch_row.h"
#include "tools/commands.h"
#include "tools/descriptor.h"

namespace gim {

struct EncodeTask {
    EncodeCommand command;    // with its names; the output's folder need not be there
    std::string known_hash;   // if the input still has it, nothing is encoded; empty: encode
    uint32_t thumbnail = 96;  // pixels per side; 0: none
};

struct EncodeOutcome {
    enum class Kind { kEncoded, kUnchanged, kFailed, kStopped };
    Kind kind = Kind::kFailed;
    std::string reason;                 // kFailed
    int signal = 0;                     // kStopped: SIGINT, SIGTERM or SIGHUP ended the process
    std::string hash;                   // empty if the input cannot be read
    std::string partial;                // kEncoded: name of the finished file beside the output
    BatchFigures figures;               // kEncoded
    std::vector<std::string> warnings;  // kEncoded
    Bytes thumbnail;                    // kEncoded
};

class EncodeProcess {
  public:
    // The caller has one thread. The process ends if its parent does.
    static Result<EncodeProcess> start(const EncodeTask& task);
    EncodeProcess(EncodeProcess&& other) noexcept;
    EncodeProcess& operator=(EncodeProcess&&) = delete;
    ~EncodeProcess();  // stops it, and waits for its end

    // To wait for with poll().
    int descriptor() const { return pipe_.get(); }
    // Takes what the process sent. Returns true once it sent all.
    bool read_some();
    // Waits for the end of the process.
    EncodeOutcome finish();
    // Asks the process to end. It removes its unfinished file.
    void stop() const;

  private:
    EncodeProcess(pid_t process, Descriptor pipe) : process_(process), pipe_(std::move(pipe)) {}

    pid_t process_;  // 0: finished
    Descriptor pipe_;
    Bytes received_;
};

}  // namespace gim
