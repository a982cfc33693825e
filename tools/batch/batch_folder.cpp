#include "tools/batch/batch_folder.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <set>
#include <thread>

#include "tools/batch/manifest.h"
#include "tools/named_file.h"
#include "tools/partial_file.h"

namespace gim {
namespace {

namespace fs = std::filesystem;
using State = BatchRow::State;

constexpr const char* kManifestBegin = "gim-batch-";
constexpr const char* kManifestEnd = ".sqlite";
constexpr int kTries = 20;
constexpr std::chrono::milliseconds kPause(100);  // between two tries

std::vector<std::string> manifests_in(const std::string& folder, const std::string& except) {
    std::vector<std::string> paths;
    std::error_code failure;
    for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure)) {
        const std::string name = entry->path().filename().string();
        if (name.starts_with(kManifestBegin) && name.ends_with(kManifestEnd) &&
            name != fs::path(except).filename().string())
            paths.push_back(entry->path().string());
    }
    std::sort(paths.begin(), paths.end());
    return paths;
}

// Returns false if a process has the manifest open.
bool add_rows(FolderRows& all, const std::string& path) {
    const Result<std::optional<Manifest>> manifest = Manifest::open_to_read(path);
    if (manifest.ok() && !manifest.value()) return false;
    const Result<std::vector<BatchRow>> rows =
        manifest.ok() ? manifest.value()->rows() : Result<std::vector<BatchRow>>(manifest.error());
    if (!rows.ok()) {
        all.broken.push_back(path + ": " + rows.error().message);
        return true;
    }
    for (const BatchRow& row : rows.value()) {
        const auto [place, is_new] = all.rows.try_emplace(row.name, row);
        if (!is_new && place->second.since < row.since) place->second = row;
    }
    return true;
}

bool holds(const std::string& path, uint64_t bytes) {
    std::error_code missing;
    return fs::is_regular_file(path, missing) && fs::file_size(path, missing) == bytes && !missing;
}

}  // namespace

std::string manifest_path(const std::string& folder, uint32_t shard, uint32_t shards) {
    return folder + "/" + kManifestBegin + std::to_string(shard) + "-of-" + std::to_string(shards) + kManifestEnd;
}

bool is_of_other_split(const std::string& path, uint32_t shards) {
    return !path.ends_with("-of-" + std::to_string(shards) + kManifestEnd);
}

std::string output_path(const std::string& folder, const std::string& name) { return folder + "/" + name + ".gim"; }

std::string this_process() {
    std::array<char, 256> host = {};
    if (::gethostname(host.data(), host.size() - 1) != 0) host[0] = '?';
    return std::string(host.data()) + ":" + std::to_string(::getpid());
}

double now_since_1970() {
    return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

FolderRows read_manifests(const std::string& folder, const std::string& except) {
    FolderRows all;
    all.busy = manifests_in(folder, except);
    for (int i = 0; i < kTries && !all.busy.empty(); ++i) {
        if (i > 0) std::this_thread::sleep_for(kPause);
        std::erase_if(all.busy, [&](const std::string& path) { return add_rows(all, path); });
    }
    return all;
}

Result<void> place_output(BatchRow& row, const std::string& folder) {
    const std::string output = output_path(folder, row.name);
    if (!row.partial.empty()) {
        const std::string partial = (folder_of(output) / row.partial).string();
        if (std::rename(partial.c_str(), output.c_str()) != 0) {
            const int cause = errno;
            if (cause != ENOENT) return cannot_write(cause);
        }
        row.partial.clear();
    }
    if (!holds(output, row.figures.bytes)) return Error{Stage::kWrite, "the output is missing or was changed"};
    return {};
}

void forget_output(BatchRow& row) {
    row.recipe = {};
    row.partial.clear();
    row.figures = {};
    row.thumbnail.clear();
}

void recover(BatchRow& row, const std::string& folder) {
    const bool has_output = !row.recipe.hash.empty() && place_output(row, folder).ok();
    if (!has_output) forget_output(row);
    const bool is_lost = row.state == State::kRunning || (row.state == State::kDone && !has_output);
    if (!is_lost) return;
    row.state = State::kWaiting;
    row.since = now_since_1970();
}

void remove_unfinished(const std::vector<BatchRow>& rows, const std::string& folder) {
    std::map<fs::path, std::set<std::string>> names;
    for (const BatchRow& row : rows) {
        const fs::path output = output_path(folder, row.name);
        names[folder_of(output)].insert(output.filename().string());
    }
    for (const auto& [place, outputs] : names) {
        std::error_code failure;
        for (fs::directory_iterator entry(place, failure), end; !failure && entry != end; entry.increment(failure)) {
            const std::optional<std::string> target = target_of_partial(entry->path().filename().string());
            if (target && outputs.contains(*target)) ::unlink(entry->path().c_str());
        }
    }
}

}  // namespace gim
