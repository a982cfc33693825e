#include "tools/batch/batch_run.h"

#include <poll.h>

#include <chrono>
#include <list>
#include <thread>

#include "tools/partial_file.h"

namespace gim {
namespace {

using State = BatchRow::State;

constexpr int kPatience = 100;  // ms between two looks at the signals
// If a terminal or a queue stops all processes of a batch, the encoder may end before this process has its own signal.
constexpr std::chrono::milliseconds kSignalsMayDiffer(200);

}  // namespace

std::string batch_program() { return std::string(GIM_VERSION) + " coder " + std::to_string(kCoderVersion); }

EncodeTask BatchRun::task_of(const BatchRow& row) const {
    EncodeTask task = {command_.encode, {}, command_.thumbnail};
    task.command.input = row.path == "-" ? "./-" : row.path;
    task.command.output = output_path(command_.folder, row.name);
    const bool is_current = row.recipe.options == command_.options && row.recipe.program == batch_program();
    if (is_current) task.known_hash = row.recipe.hash;
    return task;
}

Result<void> BatchRun::begin(BatchRow& row, std::list<Running>& running) {
    const EncodeTask task = task_of(row);
    // While an input with an output is only looked at, its row stays as it is: a kill must not make it count as begun.
    if (task.known_hash.empty()) {
        row.state = State::kRunning;
        row.owner = this_process();
        row.since = now_since_1970();
        if (Result<void> put = manifest_.put(row); !put.ok()) return put;
    }
    Result<EncodeProcess> process = EncodeProcess::start(task);
    if (!process.ok()) return process.error();
    running.push_back({&row, std::move(process.value())});
    return {};
}

// An earlier output stays, and the row knows what it was made from: if the input comes back, it need not be made again.
Result<void> BatchRun::fail(BatchRow& row, const std::string& reason, BatchCounts& counts) {
    row.state = State::kFailed;
    row.reason = reason;
    row.since = now_since_1970();
    ++counts.failed;
    Result<void> put = manifest_.put(row);
    listener_({BatchEvent::Kind::kFailed, row, {}});
    return put;
}

// The row is done before the file has its name, so no moment is left at which a kill makes the work happen twice.
Result<void> BatchRun::end_encoded(BatchRow& row, const EncodeOutcome& outcome, BatchCounts& counts) {
    row.state = State::kDone;
    row.recipe = {outcome.hash, command_.options, batch_program()};
    row.reason.clear();
    row.partial = outcome.partial;
    row.figures = outcome.figures;
    row.thumbnail = outcome.thumbnail;
    row.owner = this_process();
    row.since = now_since_1970();
    ++row.encodes;
    if (Result<void> put = manifest_.put(row); !put.ok()) {
        remove_partials_of(output_path(command_.folder, row.name));
        return put;
    }
    if (const Result<void> placed = place_output(row, command_.folder); !placed.ok()) {
        remove_partials_of(output_path(command_.folder, row.name));
        forget_output(row);
        return fail(row, "write: " + placed.error().message, counts);
    }
    if (Result<void> put = manifest_.put(row); !put.ok()) return put;
    ++counts.encoded;
    listener_({BatchEvent::Kind::kEncoded, row, outcome.warnings});
    return {};
}

Result<void> BatchRun::end_unchanged(BatchRow& row, BatchCounts& counts) {
    if (row.state != State::kDone) {
        row.state = State::kDone;
        row.reason.clear();
        row.since = now_since_1970();
        if (Result<void> put = manifest_.put(row); !put.ok()) return put;
    }
    ++counts.kept;
    listener_({BatchEvent::Kind::kKept, row, {}});
    return {};
}

Result<void> BatchRun::end(BatchRow& row, const EncodeOutcome& outcome, BatchCounts& counts) {
    switch (outcome.kind) {
        case EncodeOutcome::Kind::kEncoded:
            return end_encoded(row, outcome, counts);
        case EncodeOutcome::Kind::kUnchanged:
            return end_unchanged(row, counts);
        case EncodeOutcome::Kind::kFailed:
        case EncodeOutcome::Kind::kStopped:
            break;
    }
    remove_partials_of(output_path(command_.folder, row.name));
    return fail(row, outcome.reason, counts);
}

void BatchRun::wait_for_some(std::list<Running>& running) const {
    std::vector<pollfd> waits;
    waits.reserve(running.size());
    for (const Running& one : running) waits.push_back({one.process.descriptor(), POLLIN, 0});
    ::poll(waits.data(), waits.size(), kPatience);
}

Result<void> BatchRun::collect(std::list<Running>& running, const StopSignals& stop, BatchCounts& counts) {
    for (auto one = running.begin(); one != running.end();) {
        pollfd wait = {one->process.descriptor(), POLLIN, 0};
        if (::poll(&wait, 1, 0) <= 0 || !one->process.read_some()) {
            ++one;
            continue;
        }
        const EncodeOutcome outcome = one->process.finish();
        BatchRow& row = *one->row;
        one = running.erase(one);
        if (outcome.kind == EncodeOutcome::Kind::kStopped) {
            if (stop.waiting() == 0) std::this_thread::sleep_for(kSignalsMayDiffer);
            if (stop.waiting() != 0) {
                if (Result<void> put = put_back(row); !put.ok()) return put;
                continue;
            }
        }
        if (Result<void> ended = end(row, outcome, counts); !ended.ok()) return ended;
    }
    return {};
}

Result<void> BatchRun::put_back(BatchRow& row) {
    remove_partials_of(output_path(command_.folder, row.name));
    recover(row, command_.folder);
    return manifest_.put(row);
}

// Ends all processes. What they finished counts, what they began waits again.
Result<void> BatchRun::give_up(std::list<Running>& running, BatchCounts& counts) {
    for (const Running& one : running) one.process.stop();
    for (Running& one : running) {
        const EncodeOutcome outcome = one.process.finish();
        const bool is_finished =
            outcome.kind == EncodeOutcome::Kind::kEncoded || outcome.kind == EncodeOutcome::Kind::kUnchanged;
        Result<void> kept = is_finished ? end(*one.row, outcome, counts) : put_back(*one.row);
        if (!kept.ok()) return kept;
    }
    running.clear();
    return {};
}

Result<BatchCounts> BatchRun::run(std::vector<BatchRow>& rows, const StopSignals& stop) {
    BatchCounts counts;
    std::list<Running> running;
    size_t next = 0;
    while ((next < rows.size() || !running.empty()) && stop.waiting() == 0) {
        while (next < rows.size() && running.size() < command_.jobs && stop.waiting() == 0) {
            if (Result<void> begun = begin(rows[next], running); !begun.ok()) return begun.error();
            ++next;
        }
        wait_for_some(running);
        if (Result<void> collected = collect(running, stop, counts); !collected.ok()) return collected.error();
    }
    if (Result<void> given_up = give_up(running, counts); !given_up.ok()) return given_up.error();
    counts.left = rows.size() - counts.encoded - counts.kept - counts.failed;
    return counts;
}

}  // namespace gim
