#include "tools/state_pictures.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "tools/file.h"
#include "tools/named_file.h"

namespace gim {
namespace {

constexpr uint32_t kPixels = 480;       // per side of a single picture
constexpr uint32_t kStripPixels = 200;  // per side of a picture in the strip
constexpr size_t kMostInStrip = 8;

Panel draw(const Snapshot& state, uint32_t pixels) {
    const View view = {.size = pixels};
    const Picture surface = render_mesh(state.mesh, view, state.cut);
    return {place_below(surface, render_map(state.mesh, state.uv, pixels)), state.caption};
}

}  // namespace

bool StatePictures::may_replace(const std::string& name) const {
    const std::array<NamedFile, 2> folder = {{{"", folder_}, {"", name, Direction::kWrite}}};
    const std::array<NamedFile, 2> strip = {{{"", folder_ + "/strip.png"}, {"", name, Direction::kWrite}}};
    if (find_clash(folder) || find_clash(strip)) return true;
    std::error_code ignored;
    return extension_of(name) == "png" && std::filesystem::equivalent(folder_of(target_of(name)), folder_, ignored);
}

Result<void> StatePictures::make_folder() const {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) return Error{Stage::kWrite, "cannot make the folder: " + error.message()};
    return {};
}

Observer StatePictures::observer() {
    return [this](const Snapshot& state) { add(state); };
}

void StatePictures::add(const Snapshot& state) {
    if (!state_.ok()) return;
    char number[16];
    std::snprintf(number, sizeof(number), "%02zu-", panels_.size());
    const Panel panel = draw(state, kPixels);
    state_ = save(number + state.name + ".png", place_side_by_side({&panel, 1}));
    panels_.push_back(draw(state, kStripPixels));
}

Result<void> StatePictures::finish() {
    if (!state_.ok() || panels_.empty()) return state_;
    const size_t count = std::min(panels_.size(), kMostInStrip);
    std::vector<Panel> chosen;
    for (size_t i = 0; i < count; ++i) {
        chosen.push_back(panels_[count == 1 ? 0 : i * (panels_.size() - 1) / (count - 1)]);
    }
    return save("strip.png", place_side_by_side(chosen));
}

Result<void> StatePictures::save(const std::string& name, const Picture& picture) const {
    const Result<Bytes> png = write_png(picture);
    if (!png.ok()) return png.error();
    return write_file(folder_ + "/" + name, png.value());
}

}  // namespace gim
