// Folders of meshes for the tests of gim batch, and what a run left in them.
#pragma once

#include <sys/stat.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/program.h"
#include "tools/batch/manifest.h"

namespace gim::test {

// The quickest: no search for a cut, no fit.
inline const std::vector<std::string> kQuickEncode = {"--layout",   "tiles", "--samples", "1000",
                                                      "--lossless", "--fit", "none"};

inline std::vector<std::string> batch_arguments(const std::string& inputs, const std::string& out,
                                                const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = {"batch", inputs, out, "--quiet"};
    arguments.insert(arguments.end(), kQuickEncode.begin(), kQuickEncode.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
}

// A sphere of 56 vertices, each of another shape.
inline TriangleMesh dented_sphere(uint32_t number) {
    TriangleMesh mesh = corpus::corpus().named("sphere-108").mesh();
    for (auto& p : mesh.positions) {
        p[0] *= 1 + 0.01 * (number % 20);
        p[1] *= 1 + 0.02 * (number / 20);
    }
    return mesh;
}

// Meshes in DIR/0, DIR/1, ...: ten in each.
inline void save_many_meshes(const std::string& folder, uint32_t count) {
    for (uint32_t i = 0; i < count; ++i) {
        const std::string below = folder + "/" + std::to_string(i / 10);
        std::filesystem::create_directories(below);
        save(below + "/" + std::to_string(i) + ".obj", obj_text(dented_sphere(i)));
    }
}

// Relative paths of the files below the folder whose names end so.
inline std::vector<std::string> files_below(const std::string& folder, const std::string& end) {
    namespace fs = std::filesystem;
    std::vector<std::string> found;
    std::error_code failure;
    for (fs::recursive_directory_iterator entry(folder, failure), last; !failure && entry != last;
         entry.increment(failure)) {
        const std::string name = entry->path().lexically_relative(folder).string();
        if (name.ends_with(end)) found.push_back(name);
    }
    std::sort(found.begin(), found.end());
    return found;
}

inline size_t count_partial_files(const std::string& folder) {
    size_t count = 0;
    for (const std::string& name : files_below(folder, "")) count += name.find(".gim-partial-") != std::string::npos;
    return count;
}

inline std::vector<nlohmann::json> log_lines(const std::string& text) {
    std::vector<nlohmann::json> lines;
    std::istringstream in(text);
    for (std::string line; std::getline(in, line);) lines.push_back(nlohmann::json::parse(line));
    return lines;
}

// How many lines have that result.
inline size_t count_results(const std::string& log, const std::string& result) {
    size_t count = 0;
    for (const nlohmann::json& line : log_lines(log)) count += line.at("result") == result;
    return count;
}

inline std::vector<BatchRow> manifest_rows(const std::string& path) {
    const Result<std::optional<Manifest>> manifest = Manifest::open_to_read(path);
    if (!manifest.ok() || !manifest.value()) {
        ADD_FAILURE() << (manifest.ok() ? "busy" : manifest.error().message);
        return {};
    }
    const Result<std::vector<BatchRow>> rows = manifest.value()->rows();
    EXPECT_TRUE(rows.ok());
    return rows.ok() ? rows.value() : std::vector<BatchRow>();
}

}  // namespace gim::test
