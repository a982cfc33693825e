// Shared by the tests of tools/: a folder that removes itself, small meshes, small decoded images.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <string_view>
#include <vector>

#include "tools/decoded.h"
#include "tools/file.h"

namespace gim::test {

class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "gim-test-XXXXXX").string();
        path_ = ::mkdtemp(name.data()) ? name : std::string();
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    std::string file(const std::string& name) const { return path_ + "/" + name; }
    const std::string& path() const { return path_; }
    // Names of everything inside, sorted.
    std::vector<std::string> names() const {
        std::vector<std::string> found;
        for (const auto& entry : std::filesystem::directory_iterator(path_)) found.push_back(entry.path().filename());
        std::sort(found.begin(), found.end());
        return found;
    }

  private:
    std::string path_;
};

inline Bytes to_bytes(std::string_view text) { return {text.begin(), text.end()}; }

inline void save(const std::string& path, std::string_view text) {
    std::ofstream(path, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
}

inline std::string load_text(const std::string& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// A torus: opposite sides of the square are one, so (side-1)^2 vertices are shared by 2*(side-1)^2 triangles.
inline DecodedImage torus_image(uint32_t side, float shift = 0) {
    DecodedImage image;
    image.columns = image.rows = side;
    const uint32_t n = side - 1;
    const auto place = [&](uint32_t row, uint32_t column, std::vector<float>& positions, std::vector<float>& normals) {
        const double u = 2 * std::numbers::pi * (row % n) / n;
        const double v = 2 * std::numbers::pi * (column % n) / n;
        const double r = 2 + 0.7 * std::cos(v);
        for (const double x : {r * std::cos(u) + static_cast<double>(shift), r * std::sin(u), 0.7 * std::sin(v)}) {
            positions.push_back(static_cast<float>(x));
        }
        for (const double x : {std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v)}) {
            normals.push_back(static_cast<float>(x));
        }
    };
    for (uint32_t row = 0; row < side; ++row) {
        for (uint32_t column = 0; column < side; ++column) {
            place(row, column, image.grid, image.grid_normals);
            image.grid_texcoords.push_back(static_cast<float>(column) / static_cast<float>(n));
            image.grid_texcoords.push_back(static_cast<float>(row) / static_cast<float>(n));
        }
    }
    for (uint32_t row = 0; row < n; ++row) {
        for (uint32_t column = 0; column < n; ++column) {
            place(row, column, image.positions, image.normals);
            image.texcoords.push_back(static_cast<float>(column) / static_cast<float>(n));
            image.texcoords.push_back(static_cast<float>(row) / static_cast<float>(n));
        }
    }
    for (uint32_t row = 0; row < n; ++row) {
        for (uint32_t column = 0; column < n; ++column) {
            const std::array<std::array<uint32_t, 2>, 6> corners = {{{row, column},
                                                                     {row + 1, column},
                                                                     {row + 1, column + 1},
                                                                     {row, column},
                                                                     {row + 1, column + 1},
                                                                     {row, column + 1}}};
            for (const auto& [r, c] : corners) {
                image.grid_triangles.push_back(r * side + c);
                image.triangles.push_back(r % n * n + c % n);
            }
        }
    }
    return image;
}

}  // namespace gim::test
