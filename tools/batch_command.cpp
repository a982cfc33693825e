// gim batch: encodes many meshes, and goes on where an earlier run ended.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <set>

#include "tools/batch/batch_folder.h"
#include "tools/batch/batch_list.h"
#include "tools/batch/batch_log.h"
#include "tools/batch/batch_report.h"
#include "tools/batch/batch_run.h"
#include "tools/batch/manifest.h"
#include "tools/batch/stop_signals.h"
#include "tools/commands.h"
#include "tools/file.h"

namespace gim {
namespace {

namespace fs = std::filesystem;
using State = BatchRow::State;

constexpr int kSignalBase = 128;  // of the exit status, as shells have it

// No output may take the place of an input, and no line of the log may go into one.
std::optional<FileError> find_replaced_input(const std::vector<BatchItem>& items, const BatchCommand& command) {
    std::error_code unknown;
    std::map<fs::path, std::string> inputs;
    for (const BatchItem& item : items) inputs[fs::weakly_canonical(item.path, unknown)] = item.path;
    if (command.inputs != "-") inputs[fs::weakly_canonical(command.inputs, unknown)] = command.inputs;
    if (!command.log.empty() && inputs.contains(fs::weakly_canonical(command.log, unknown)))
        return FileError{command.log, {Stage::kWrite, "this is an input; choose another --log"}};
    for (const BatchItem& item : items) {
        const auto found = inputs.find(fs::weakly_canonical(output_path(command.folder, item.name), unknown));
        if (found == inputs.end()) continue;
        return FileError{
            found->second,
            {Stage::kWrite, "the output of " + item.path + " would replace this input; choose another OUT_DIR"}};
    }
    return {};
}

// What the manifests know of the inputs, true at this moment.
std::vector<BatchRow> recovered_rows(const std::vector<BatchItem>& items, RowsByName known, const std::string& folder) {
    std::vector<BatchRow> rows;
    for (const BatchItem& item : items) {
        BatchRow row = known.contains(item.name) ? std::move(known[item.name]) : BatchRow();
        row.name = item.name;
        row.path = item.path;
        recover(row, folder);
        rows.push_back(std::move(row));
    }
    return rows;
}

Result<RowsByName> known_rows(const Manifest& manifest, const FolderRows& others) {
    const Result<std::vector<BatchRow>> own = manifest.rows();
    if (!own.ok()) return own.error();
    RowsByName known = others.rows;
    for (const BatchRow& row : own.value()) {
        const auto [place, is_new] = known.try_emplace(row.name, row);
        if (!is_new && place->second.since <= row.since) place->second = row;
    }
    return known;
}

// Runs with other options may have made a part of the outputs.
std::vector<std::string> options_of(const std::vector<BatchRow>& rows) {
    std::set<std::string> options;
    for (const BatchRow& row : rows) {
        if (row.state == State::kDone) options.insert(row.recipe.options);
    }
    return {options.begin(), options.end()};
}

BatchPage page_of(const std::vector<BatchItem>& items, const FolderRows& found) {
    BatchPage page;
    for (const BatchItem& item : items) {
        const auto row = found.rows.find(item.name);
        if (row != found.rows.end()) {
            page.rows.push_back(row->second);
            continue;
        }
        BatchRow waiting;
        waiting.name = item.name;
        waiting.path = item.path;
        page.rows.push_back(waiting);
    }
    page.options = options_of(page.rows);
    if (!found.busy.empty())
        page.notes.push_back("Other shards still run: " + std::to_string(found.busy.size()) +
                             ". What they did is not here yet.");
    for (const std::string& fault : found.broken) page.notes.push_back(fault);
    return page;
}

// The shard that ends last writes a page with all rows: each writes again if another has ended while it wrote.
std::optional<FileError> write_report(const BatchCommand& command, const std::vector<BatchItem>& items) {
    const std::string path = command.folder + "/report.html";
    for (std::vector<std::string> busy;;) {
        const FolderRows found = read_manifests(command.folder);
        const std::string html = batch_html(page_of(items, found));
        const Result<void> written = write_file(path, {reinterpret_cast<const uint8_t*>(html.data()), html.size()});
        if (!written.ok()) return FileError{path, written.error()};
        busy = found.busy;
        const bool has_one_ended = std::any_of(busy.begin(), busy.end(), [](const std::string& manifest) {
            const auto opened = Manifest::open_to_read(manifest);
            return opened.ok() && opened.value().has_value();
        });
        if (!has_one_ended) return {};
    }
}

// Shards of one split share no input. Those of two splits do, so they must not run at a time.
std::optional<Error> running_split(const FolderRows& others, uint32_t shards) {
    for (const std::string& path : others.busy) {
        if (!is_of_other_split(path, shards)) continue;
        return Error{Stage::kWrite, "a gim batch with another --shard I/N encodes to this folder and has " + path +
                                        " open; wait until it ends, or stop it"};
    }
    return {};
}

struct Encoding {
    BatchCounts counts;
    int signal = 0;
};

// The manifest is open here alone: when this returns, others can read it.
Result<Encoding> encode_shard(const BatchCommand& command, const std::vector<BatchItem>& items, BatchLog& log) {
    const std::string path = manifest_path(command.folder, command.shard, command.shards);
    Result<Manifest> manifest = Manifest::open(path);
    if (!manifest.ok()) return manifest.error();
    const FolderRows others = read_manifests(command.folder, path);
    if (const auto other = running_split(others, command.shards)) return *other;
    Result<RowsByName> known = known_rows(manifest.value(), others);
    if (!known.ok()) return known.error();
    std::vector<BatchRow> rows = recovered_rows(items, std::move(known.value()), command.folder);
    remove_unfinished(rows, command.folder);
    if (const Result<void> put = manifest.value().put_all(rows); !put.ok()) return put.error();
    const StopSignals stop;
    BatchRun run(command, manifest.value(), [&](const BatchEvent& event) { log.add(event); });
    const Result<BatchCounts> counts = run.run(rows, stop);
    if (!counts.ok()) return counts.error();
    log.end(rows, counts.value());
    return Encoding{counts.value(), counts.value().left > 0 ? stop.waiting() : 0};
}

}  // namespace

int run_batch(const BatchCommand& command) {
    const Result<std::vector<BatchItem>> items = list_batch(command.inputs);
    if (!items.ok()) return report_error(shown_name(command.inputs, Direction::kRead), items.error());
    if (items.value().empty())
        return report_error(shown_name(command.inputs, Direction::kRead), {Stage::kInput, "there is no mesh in it"});
    std::error_code failure;
    fs::create_directories(command.folder, failure);
    if (failure) return report_error(command.folder, {Stage::kWrite, "cannot make the folder: " + failure.message()});
    if (const auto clash = find_replaced_input(items.value(), command)) return report_error(*clash);

    Encoding done;
    if (!command.report_only) {
        const std::vector<BatchItem> mine = shard_of(items.value(), command.shard, command.shards);
        BatchLog log(command, mine.size());
        if (const auto fault = log.open()) return report_error(*fault);
        const Result<Encoding> encoding = encode_shard(command, mine, log);
        if (!encoding.ok())
            return report_error(manifest_path(command.folder, command.shard, command.shards), encoding.error());
        done = encoding.value();
        if (const auto fault = log.failure()) return report_error(*fault);
    }
    if (const auto fault = write_report(command, items.value())) return report_error(*fault);
    if (done.signal != 0) return kSignalBase + done.signal;
    return done.counts.failed > 0 ? 1 : 0;
}

}  // namespace gim
