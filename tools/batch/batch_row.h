// What is known of one input of a batch.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/file.h"

namespace gim {

struct BatchFigures {
    uint64_t input_bytes = 0;
    uint64_t bytes = 0;          // of the output
    uint64_t triangles = 0;      // of the input
    std::optional<double> psnr;  // dB; nothing if the surfaces are equal
    double max_error = 0;        // object units
    double seconds = 0;          // from reading the input to the end of the encode
    uint64_t folded = 0;         // triangles
    std::string layout;
};

// What an output was made from.
struct BatchRecipe {
    std::string hash;     // of the input's bytes, in hexadecimal
    std::string options;  // BatchCommand::options
    std::string program;  // version of the program and of the coder

    bool operator==(const BatchRecipe&) const = default;
};

struct BatchRow {
    enum class State { kWaiting, kRunning, kDone, kFailed };

    std::string name, path;  // BatchItem
    State state = State::kWaiting;
    BatchRecipe recipe;    // of the output that is there, in any state; empty: there is none
    std::string owner;     // host and process that began it last
    double since = 0;      // seconds since 1970: when the state was entered
    std::string reason;    // kFailed
    std::string partial;   // kDone: the file that has yet to take the output's name; empty: it has it
    uint32_t encodes = 0;  // how often this input was encoded to the end
    BatchFigures figures;  // of the output that is there
    Bytes thumbnail;       // PNG of that output's surface; may be empty
};

// "waiting", "running", "done", "failed"
const char* name_of(BatchRow::State state);

}  // namespace gim
