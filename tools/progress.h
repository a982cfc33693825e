// Prints one line per stage on stderr: while it runs, what part is done and how long the rest takes; then what it took.
// Silent unless stderr is a terminal.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "gim/encoder.h"
#include "tools/time_left.h"

namespace gim {

class ProgressPrinter {
  public:
    explicit ProgressPrinter(bool quiet);
    ~ProgressPrinter();
    ProgressPrinter(const ProgressPrinter&) = delete;
    ProgressPrinter& operator=(const ProgressPrinter&) = delete;

    // Begins a new list of stages, with a line of its own above it.
    void begin_part(const std::string& title);
    void update(Stage stage, double fraction);
    // The callback for the encoder. Empty if there is nothing to print. Must not outlive the printer.
    Progress callback();

  private:
    using Clock = std::chrono::steady_clock;
    void finish_stage();

    bool visible_;
    std::optional<Stage> stage_;
    TimeLeft left_;  // of the stage
    Clock::time_point begin_;
    Clock::time_point printed_;
};

}  // namespace gim
