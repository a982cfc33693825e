// What a batch tells while it runs, and at its end.
#pragma once

#include <chrono>
#include <optional>
#include <vector>

#include "tools/batch/batch_run.h"
#include "tools/commands.h"
#include "tools/descriptor.h"

namespace gim {

// One JSON object a line for each input, at the end of the file --log or on stdout, each written at once. A summary at
// the end, on stdout, or on stderr if the lines have stdout. On a terminal, also how far the run is.
class BatchLog {
  public:
    BatchLog(const BatchCommand& command, size_t files);

    std::optional<FileError> open();
    void add(const BatchEvent& event);
    void end(const std::vector<BatchRow>& rows, const BatchCounts& counts);
    // The first line that was lost.
    std::optional<FileError> failure() const;

  private:
    using Clock = std::chrono::steady_clock;
    void write_line(const std::string& line);
    void show_progress(const BatchEvent& event);

    const BatchCommand& command_;
    size_t files_, finished_ = 0, failed_ = 0, encoded_ = 0;
    Clock::time_point begin_ = Clock::now();
    bool shows_progress_;
    std::optional<Descriptor> file_;
    std::optional<FileError> failure_;
};

}  // namespace gim
