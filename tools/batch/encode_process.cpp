#include "tools/batch/encode_process.h"

#include <sys/wait.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tools/batch/hash_file.h"
#include "tools/decoded.h"
#include "tools/named_file.h"
#include "tools/partial_file.h"
#include "tools/render.h"
#include "tools/report_json.h"

namespace gim {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr uint64_t kThumbnailTriangles = 100000;  // more do not show
constexpr size_t kPiece = size_t{1} << 16;        // bytes

std::string describe(const Error& error) { return std::string(stage_name(error.stage)) + ": " + error.message; }

// Draws the decoded surface at a level that suffices. Empty if that fails: the picture is not worth the file.
Bytes draw_thumbnail(const Encoded& encoded, uint32_t size) {
    if (size == 0) return {};
    uint32_t level = 0;
    for (const LevelReport& coarser : encoded.report.levels) {
        if (coarser.level == level + 1 && encoded.report.levels[level].triangles > kThumbnailTriangles)
            level = coarser.level;
    }
    const auto images = decode_images(encoded.bytes, level);
    if (!images.ok()) return {};
    const Result<Bytes> png = write_png(render_mesh(to_mesh(images.value()), {.size = size}));
    return png.ok() ? png.value() : Bytes();
}

void add_figures(json& result, const EncodeReport& report, double seconds) {
    result["bytes"] = report.file_bytes;
    result["triangles"] = report.input_triangles;
    if (std::isfinite(report.error.psnr)) result["psnr"] = report.error.psnr;
    result["max_error"] = report.error.hausdorff;
    result["seconds"] = seconds;
    result["folded"] = report.error.defects ? report.error.defects->folded_faces : 0;
    result["layout"] = name_of(report.layout);
    result["warnings"] = report.warnings;
}

// Writes the file under a temporary name, and tells it.
Result<std::string> write_partial(const std::string& output, const Bytes& bytes) {
    std::error_code failure;
    fs::create_directories(folder_of(output), failure);  // if it fails, so does what follows, with a reason
    Result<std::unique_ptr<PartialFile>> partial = PartialFile::beside(output);
    if (!partial.ok()) return partial.error();
    const Result<void> written = partial.value()->write(bytes);
    if (!written.ok()) return written.error();
    return fs::path(partial.value()->hand_over()).filename().string();
}

// Fills `result`. Returns what failed.
std::optional<Error> encode_to(json& result, const EncodeTask& task) {
    const Clock::time_point begin = Clock::now();
    const EncodeCommand& command = task.command;
    const Result<std::string> hash = hash_file(command.input);
    if (!hash.ok()) return hash.error();
    result["hash"] = hash.value();
    result["unchanged"] = hash.value() == task.known_hash;
    if (hash.value() == task.known_hash) return {};
    Result<Input> input =
        read_input(command.input, {Want::kShapeAndColors, command.max_memory, command.format, true, command.raster});
    if (!input.ok()) return input.error();
    const Result<Encoded> encoded = encode_input(input.value(), command.options);
    if (!encoded.ok()) return encoded.error();
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    add_figures(result, encoded.value().report, seconds);
    for (const std::string& warning : input.value().warnings) result["warnings"].push_back(warning);
    std::error_code unknown;
    result["input_bytes"] = fs::file_size(command.input, unknown);
    result["thumbnail"] = json::binary(draw_thumbnail(encoded.value(), task.thumbnail));
    const Result<std::string> partial = write_partial(command.output, encoded.value().bytes);
    if (!partial.ok()) return partial.error();
    result["partial"] = partial.value();
    return {};
}

json encode_guarded(const EncodeTask& task) {
    json result = json::object();
    try {
        if (const auto failure = encode_to(result, task)) result["reason"] = describe(*failure);
    } catch (const std::bad_alloc&) {
        result["reason"] = "out of memory; use a smaller --size, fewer --jobs or a smaller mesh";
    } catch (const std::exception& failure) {
        result["reason"] = std::string("unexpected failure: ") + failure.what();
    }
    return result;
}

// If memory runs out, this process is the one to end, not the one that knows all others.
void offer_to_the_memory_killer() {
    const Descriptor file(::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC));
    if (file.get() >= 0) (void)!::write(file.get(), "500", 3);
}

[[noreturn]] void run_child(const EncodeTask& task, pid_t parent, int pipe) {
#ifdef __linux__
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
#endif
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    if (::getppid() != parent) ::_exit(1);
    offer_to_the_memory_killer();
    const std::vector<uint8_t> bytes = json::to_cbor(encode_guarded(task));
    ::_exit(write_all(pipe, bytes) ? 0 : 1);  // nothing of the parent's is flushed a second time
}

EncodeOutcome outcome_of(const json& result) {
    EncodeOutcome outcome;
    outcome.hash = result.value("hash", "");
    outcome.reason = result.value("reason", "");
    if (!outcome.reason.empty()) return outcome;
    outcome.kind = EncodeOutcome::Kind::kUnchanged;
    if (result.value("unchanged", false)) return outcome;
    outcome.kind = EncodeOutcome::Kind::kEncoded;
    outcome.partial = result.at("partial");
    BatchFigures& figures = outcome.figures;
    figures.input_bytes = result.at("input_bytes");
    figures.bytes = result.at("bytes");
    figures.triangles = result.at("triangles");
    if (result.contains("psnr")) figures.psnr = result.at("psnr").get<double>();
    figures.max_error = result.at("max_error");
    figures.seconds = result.at("seconds");
    figures.folded = result.at("folded");
    figures.layout = result.at("layout");
    outcome.warnings = result.at("warnings").get<std::vector<std::string>>();
    outcome.thumbnail = result.at("thumbnail").get_binary();
    return outcome;
}

EncodeOutcome ended_without_result(int state) {
    EncodeOutcome outcome;
    if (!WIFSIGNALED(state)) {
        outcome.reason = "the encoder ended without a result, status " + std::to_string(WEXITSTATUS(state));
        return outcome;
    }
    const int signal = WTERMSIG(state);
    if (signal == SIGINT || signal == SIGTERM || signal == SIGHUP) {
        outcome.kind = EncodeOutcome::Kind::kStopped;
        outcome.signal = signal;
    }
    outcome.reason = "the encoder was ended by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
    if (signal == SIGKILL) outcome.reason += "; memory may have run out: use fewer --jobs";
    return outcome;
}

}  // namespace

Result<EncodeProcess> EncodeProcess::start(const EncodeTask& task) {
    int ends[2] = {};
    if (::pipe(ends) != 0) return Error{Stage::kInput, "cannot start an encoder: " + reason(errno)};
    Descriptor out(ends[0]);
    Descriptor in(ends[1]);
    const pid_t parent = ::getpid();
    const pid_t process = ::fork();
    if (process < 0) return Error{Stage::kInput, "cannot start an encoder: " + reason(errno)};
    if (process == 0) run_child(task, parent, in.get());
    return EncodeProcess(process, std::move(out));
}

EncodeProcess::EncodeProcess(EncodeProcess&& other) noexcept
    : process_(std::exchange(other.process_, 0)),
      pipe_(std::move(other.pipe_)),
      received_(std::move(other.received_)) {}

EncodeProcess::~EncodeProcess() {
    if (process_ == 0) return;
    stop();
    finish();
}

bool EncodeProcess::read_some() {
    Bytes piece(kPiece);
    const ssize_t size = ::read(pipe_.get(), piece.data(), piece.size());
    if (size < 0) return errno != EINTR;
    received_.insert(received_.end(), piece.begin(), piece.begin() + size);
    return size == 0;
}

EncodeOutcome EncodeProcess::finish() {
    while (!read_some()) {
    }
    int state = 0;
    while (::waitpid(process_, &state, 0) < 0 && errno == EINTR) {
    }
    process_ = 0;
    if (!WIFEXITED(state) || WEXITSTATUS(state) != 0) return ended_without_result(state);
    const json result = json::from_cbor(received_, true, false);
    return result.is_object() ? outcome_of(result) : ended_without_result(state);
}

void EncodeProcess::stop() const { ::kill(process_, SIGTERM); }

}  // namespace gim
