// Encodes the inputs of a batch, several at a time, and keeps the manifest true at every moment.
#pragma once

#include <functional>
#include <list>
#include <string>
#include <vector>

#include "tools/batch/batch_folder.h"
#include "tools/batch/batch_row.h"
#include "tools/batch/encode_process.h"
#include "tools/batch/manifest.h"
#include "tools/batch/stop_signals.h"

namespace gim {

// What became of one input in this run.
struct BatchEvent {
    enum class Kind { kEncoded, kKept, kFailed };
    Kind kind;
    const BatchRow& row;
    const std::vector<std::string>& warnings;
};

struct BatchCounts {
    uint64_t encoded = 0, kept = 0, failed = 0, left = 0;
};

class BatchRun {
  public:
    using Listener = std::function<void(const BatchEvent&)>;
    BatchRun(const BatchCommand& command, Manifest& manifest, Listener listener)
        : command_(command), manifest_(manifest), listener_(std::move(listener)) {}

    // Encodes what is not done. rows: one for each input, recovered. They are current at the end, and in the manifest.
    // Fails only if the manifest cannot be written. Ends early, in order, if a signal waits.
    Result<BatchCounts> run(std::vector<BatchRow>& rows, const StopSignals& stop);

  private:
    struct Running {
        BatchRow* row;
        EncodeProcess process;
    };
    EncodeTask task_of(const BatchRow& row) const;
    Result<void> begin(BatchRow& row, std::list<Running>& running);
    Result<void> end(BatchRow& row, const EncodeOutcome& outcome, BatchCounts& counts);
    Result<void> end_encoded(BatchRow& row, const EncodeOutcome& outcome, BatchCounts& counts);
    Result<void> end_unchanged(BatchRow& row, BatchCounts& counts);
    Result<void> fail(BatchRow& row, const std::string& reason, BatchCounts& counts);
    void wait_for_some(std::list<Running>& running) const;
    Result<void> collect(std::list<Running>& running, const StopSignals& stop, BatchCounts& counts);
    Result<void> put_back(BatchRow& row);
    Result<void> give_up(std::list<Running>& running, BatchCounts& counts);

    const BatchCommand& command_;
    Manifest& manifest_;
    Listener listener_;
};

// The version that BatchRecipe::program takes.
std::string batch_program();

}  // namespace gim
