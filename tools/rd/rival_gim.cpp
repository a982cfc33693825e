// gim's own decoder, timed like the others.
#include "gim/decoder.hpp"
#include "tools/decoded.h"
#include "tools/rd/rival_codecs.h"

namespace gim::rd {

namespace {

struct Image {
    DecoderLevel level;
    std::vector<float> positions;
    std::vector<uint32_t> triangles;
};

class GimDecoder : public RepeatedDecoder {
  public:
    explicit GimDecoder(const Bytes& bytes) : bytes_(bytes) {}

    bool prepare() {
        if (decoder_.open(bytes_) != GIM_OK) return false;
        for (uint32_t i = 0; i < decoder_.info().image_count; ++i) {
            Image image;
            if (decoder_.read_level(i, 0, &image.level) != GIM_OK) return false;
            image.positions.resize(size_t{3} * image.level.vertex_count);
            image.triangles.resize(size_t{3} * image.level.triangle_count);
            images_.push_back(std::move(image));
        }
        return true;
    }

    bool run() override {
        if (decoder_.open(bytes_) != GIM_OK) return false;  // counted, because every decoder does it
        for (Image& image : images_) {
            if (decoder_.mesh(image.level, {image.positions, {}, {}, image.triangles}) != GIM_OK) return false;
        }
        return true;
    }

    std::array<uint64_t, 2> counts() const override {
        std::array<uint64_t, 2> sum = {0, 0};
        for (const Image& image : images_) sum[0] += image.level.vertex_count, sum[1] += image.level.triangle_count;
        return sum;
    }

    RivalMesh mesh() const override {
        RivalMesh result;
        for (const Image& image : images_) {
            const gim_info& info = decoder_.info();
            const auto first = static_cast<uint32_t>(result.positions.size());
            for (size_t v = 0; v < image.positions.size(); v += 3) {
                std::array<float, 3>& p = result.positions.emplace_back();
                for (size_t k = 0; k < 3; ++k)
                    p[k] = image.positions[v + k] + (info.is_relative ? static_cast<float>(info.origin[k]) : 0.0f);
            }
            for (size_t t = 0; t < image.triangles.size(); t += 3) {
                result.triangles.push_back(
                    {first + image.triangles[t], first + image.triangles[t + 1], first + image.triangles[t + 2]});
            }
        }
        return result;
    }

  private:
    const Bytes& bytes_;
    Decoder decoder_;
    std::vector<Image> images_;
};

}  // namespace

std::unique_ptr<RepeatedDecoder> make_gim_decoder(const Bytes& bytes) {
    if (!is_gim(bytes)) return nullptr;
    auto decoder = std::make_unique<GimDecoder>(bytes);
    return decoder->prepare() ? std::move(decoder) : nullptr;
}

}  // namespace gim::rd
