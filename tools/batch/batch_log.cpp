#include "tools/batch/batch_log.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "tools/batch/html_text.h"
#include "tools/partial_file.h"

namespace gim {
namespace {

using nlohmann::ordered_json;
using State = BatchRow::State;

constexpr mode_t kPermissions = 0666;  // less the umask

const char* name_of(BatchEvent::Kind kind) {
    switch (kind) {
        case BatchEvent::Kind::kEncoded:
            return "encoded";
        case BatchEvent::Kind::kKept:
            return "kept";
        case BatchEvent::Kind::kFailed:
            break;
    }
    return "failed";
}

ordered_json to_json(const BatchEvent& event, const std::string& folder) {
    const BatchRow& row = event.row;
    ordered_json json = {{"input", row.path}, {"result", name_of(event.kind)}};
    if (event.kind == BatchEvent::Kind::kFailed) {
        json["reason"] = row.reason;
        return json;
    }
    json["output"] = output_path(folder, row.name);
    json["hash"] = row.recipe.hash;
    json["input_bytes"] = row.figures.input_bytes;
    json["bytes"] = row.figures.bytes;
    json["triangles"] = row.figures.triangles;
    json["layout"] = row.figures.layout;
    json["psnr"] = row.figures.psnr ? ordered_json(*row.figures.psnr) : ordered_json();
    json["max_error"] = row.figures.max_error;
    json["folded"] = row.figures.folded;
    json["seconds"] = row.figures.seconds;
    if (!event.warnings.empty()) json["warnings"] = event.warnings;
    return json;
}

std::string table_line(const std::string& label, const std::string& value) {
    std::string line = label;
    line.resize(std::max<size_t>(line.size() + 1, 16), ' ');
    return line + value + "\n";
}

std::string summary(const std::vector<BatchRow>& rows, const BatchCounts& counts, double seconds) {
    uint64_t bytes = 0, input_bytes = 0, with_psnr = 0;
    double least = 0, sum = 0;
    std::string failures;
    for (const BatchRow& row : rows) {
        if (row.state == State::kFailed) failures += "  " + row.path + ": " + row.reason + "\n";
        if (row.state != State::kDone) continue;
        bytes += row.figures.bytes;
        input_bytes += row.figures.input_bytes;
        if (!row.figures.psnr) continue;
        least = with_psnr == 0 ? *row.figures.psnr : std::min(least, *row.figures.psnr);
        sum += *row.figures.psnr;
        ++with_psnr;
    }
    std::string text = table_line("files", with_thousands(rows.size()));
    text += table_line("encoded", with_thousands(counts.encoded));
    if (counts.kept > 0) text += table_line("kept", with_thousands(counts.kept) + ", done by an earlier run");
    if (counts.left > 0) text += table_line("left", with_thousands(counts.left) + ", run again to do them");
    text += table_line("bytes", with_thousands(bytes) + ", from " + with_thousands(input_bytes));
    if (with_psnr > 0) {
        text += table_line("PSNR", decimal(sum / static_cast<double>(with_psnr), 2) + " dB in the mean, least " +
                                       decimal(least, 2) + " dB");
    }
    text += table_line("time", decimal(seconds, 1) + " s");
    text += table_line("failed", with_thousands(counts.failed));
    return text + failures;
}

}  // namespace

BatchLog::BatchLog(const BatchCommand& command, size_t files)
    : command_(command),
      files_(files),
      shows_progress_(!command.quiet && !command.log.empty() && ::isatty(STDERR_FILENO) == 1) {}

std::optional<FileError> BatchLog::open() {
    if (command_.log.empty()) return {};
    file_.emplace(::open(command_.log.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, kPermissions));
    if (file_->get() < 0) return FileError{command_.log, cannot_write(errno)};
    return {};
}

void BatchLog::write_line(const std::string& line) {
    const int fd = file_ ? file_->get() : STDOUT_FILENO;
    if (failure_ || write_all(fd, {reinterpret_cast<const uint8_t*>(line.data()), line.size()})) return;
    failure_ = FileError{file_ ? command_.log : "standard output", cannot_write(errno)};
}

void BatchLog::show_progress(const BatchEvent& event) {
    const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    const double left =
        encoded_ == 0 ? 0 : seconds / static_cast<double>(finished_) * static_cast<double>(files_ - finished_);
    std::fprintf(stderr, "\r  %zu of %zu, %zu failed, about %.0f s left. %.40s\x1b[K", finished_, files_, failed_, left,
                 event.row.name.c_str());
    std::fflush(stderr);
}

void BatchLog::add(const BatchEvent& event) {
    ++finished_;
    failed_ += event.kind == BatchEvent::Kind::kFailed ? 1 : 0;
    encoded_ += event.kind == BatchEvent::Kind::kEncoded ? 1 : 0;
    write_line(to_json(event, command_.folder).dump(-1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
    if (shows_progress_) show_progress(event);
}

void BatchLog::end(const std::vector<BatchRow>& rows, const BatchCounts& counts) {
    if (shows_progress_) std::fputs("\r\x1b[K", stderr);
    if (command_.quiet) return;
    const double seconds = std::chrono::duration<double>(Clock::now() - begin_).count();
    std::fputs(summary(rows, counts, seconds).c_str(), file_ ? stdout : stderr);
}

std::optional<FileError> BatchLog::failure() const { return failure_; }

}  // namespace gim
