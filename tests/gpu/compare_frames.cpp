#include "tests/gpu/compare_frames.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace gim::test {
namespace {

uint32_t difference(const uint8_t* a, const uint8_t* b) {
    int most = 0;
    for (int k = 0; k < 3; ++k) most = std::max(most, std::abs(int{a[k]} - int{b[k]}));
    return static_cast<uint32_t>(most);
}

const uint8_t* pixel(const FramePixels& frame, int64_t x, int64_t y) {
    return &frame.rgba[4 * static_cast<size_t>(y * frame.width + x)];
}

bool is(const uint8_t* shown, const std::array<uint8_t, 4>& colour) { return difference(shown, colour.data()) == 0; }

// Calls visit(column, row) for the places of a picture that are at most so far away.
template <class Visit>
void around(const FramePixels& picture, int64_t x, int64_t y, int64_t most, const Visit& visit) {
    for (int64_t v = std::max<int64_t>(y - most, 0); v <= std::min<int64_t>(y + most, picture.height - 1); ++v) {
        for (int64_t u = std::max<int64_t>(x - most, 0); u <= std::min<int64_t>(x + most, picture.width - 1); ++u)
            visit(u, v);
    }
}

int64_t centre(int64_t place) { return kFiner * place + kFiner / 2; }

class Comparison {
  public:
    Comparison(const FramePixels& frame, const Reference& reference) : frame_(frame), reference_(reference) {}

    void add(int64_t x, int64_t y, uint32_t close, FrameDifference* found) const {
        const uint32_t here = between(x, y, centre(x), centre(y));
        if (here <= 1) return;
        uint32_t to_reference = 255, to_frame = 255;
        bool has_background = false, has_back = false;
        around(reference_.samples, centre(x), centre(y), kFiner, [&](int64_t u, int64_t v) {
            to_reference = std::min(to_reference, between(x, y, u, v));
            const uint8_t* near = pixel(reference_.samples, u, v);
            has_background = has_background || is(near, kBackground);
            has_back = has_back || is(near, kBackFace) || is_contested(u, v);
        });
        around(frame_, x, y, 1,
               [&](int64_t u, int64_t v) { to_frame = std::min(to_frame, between(u, v, centre(x), centre(y))); });
        const uint32_t worst = std::max(to_reference, to_frame);
        found->worst = std::max(found->worst, worst);
        found->far += worst > close ? 1 : 0;
        found->shifted += here > close ? 1 : 0;
        found->background += is(pixel(frame_, x, y), kBackground) && !has_background ? 1 : 0;
        found->backs += is(pixel(frame_, x, y), kBackFace) && !has_back ? 1 : 0;
    }

  private:
    bool is_contested(int64_t x, int64_t y) const {
        return reference_.contested[static_cast<size_t>(y * reference_.samples.width + x)] != 0;
    }
    // From pixel (x, y) of the frame to sample (u, v) of the reference.
    uint32_t between(int64_t x, int64_t y, int64_t u, int64_t v) const {
        const uint8_t* shown = pixel(frame_, x, y);
        if (is_contested(u, v) && !is(shown, kBackground)) return 0;
        return difference(shown, pixel(reference_.samples, u, v));
    }

    const FramePixels& frame_;
    const Reference& reference_;
};

}  // namespace

FrameDifference compare_frames(const FramePixels& frame, const Reference& reference, uint32_t close) {
    FrameDifference found;
    const Comparison comparison(frame, reference);
    for (int64_t y = 1; y + 1 < frame.height; ++y) {
        for (int64_t x = 1; x + 1 < frame.width; ++x) comparison.add(x, y, close, &found);
    }
    return found;
}

double covered_part(const FramePixels& frame) {
    size_t covered = 0;
    for (size_t i = 0; i < frame.rgba.size(); i += 4) covered += is(&frame.rgba[i], kBackground) ? 0 : 1;
    return 4.0 * static_cast<double>(covered) / static_cast<double>(frame.rgba.size());
}

double contested_part(const Reference& reference) {
    const auto count = std::count(reference.contested.begin(), reference.contested.end(), uint8_t{1});
    return static_cast<double>(count) / static_cast<double>(reference.contested.size());
}

void keep_frame(const FramePixels& frame, const std::string& name) {
    const char* folder = std::getenv("GIM_GPU_FRAMES");
    if (!folder) return;
    std::ofstream file(std::string(folder) + "/" + name + ".ppm", std::ios::binary);
    file << "P6 " << frame.width << " " << frame.height << " 255\n";
    for (size_t i = 0; i < frame.rgba.size(); i += 4) file.write(reinterpret_cast<const char*>(&frame.rgba[i]), 3);
}

}  // namespace gim::test
