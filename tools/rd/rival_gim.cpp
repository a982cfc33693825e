// gim's own decoder, timed like the others.
#include "gim/decoder.h"
#include "tools/decoded.h"
#include "tools/rd/rival_codecs.h"

namespace gim::rd {

namespace {

struct Image {
    gim_level_info level = {};
    std::vector<float> positions;
    std::vector<uint32_t> triangles;
};

class GimDecoder : public RepeatedDecoder {
  public:
    explicit GimDecoder(const Bytes& bytes) : bytes_(bytes) {}

    bool prepare() {
        if (gim_read_info(bytes_.data(), bytes_.size(), nullptr, &info_) != GIM_OK) return false;
        uint64_t scratch = 0;
        for (uint32_t i = 0; i < info_.image_count; ++i) {
            Image image;
            if (gim_read_level_info(&info_, bytes_.data(), bytes_.size(), i, 0, &image.level) != GIM_OK) return false;
            image.positions.resize(size_t{3} * image.level.vertex_count);
            image.triangles.resize(size_t{3} * image.level.triangle_count);
            scratch = std::max(scratch, image.level.scratch_size);
            images_.push_back(std::move(image));
        }
        scratch_.resize(scratch / sizeof(Block) + 1);
        return true;
    }

    bool run() override {
        gim_info info;  // what every decoder does first
        if (gim_read_info(bytes_.data(), bytes_.size(), nullptr, &info) != GIM_OK) return false;
        for (uint32_t i = 0; i < images_.size(); ++i) {
            Image& image = images_[i];
            if (gim_decode_mesh(&info, bytes_.data(), bytes_.size(), i, 0, image.positions.data(), nullptr, nullptr,
                                image.triangles.data(), scratch_.data(), image.level.scratch_size) != GIM_OK) {
                return false;
            }
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
            const auto first = static_cast<uint32_t>(result.positions.size());
            for (size_t v = 0; v < image.positions.size(); v += 3) {
                result.positions.push_back({image.positions[v], image.positions[v + 1], image.positions[v + 2]});
            }
            for (size_t t = 0; t < image.triangles.size(); t += 3) {
                result.triangles.push_back(
                    {first + image.triangles[t], first + image.triangles[t + 1], first + image.triangles[t + 2]});
            }
        }
        return result;
    }

  private:
    struct alignas(16) Block {
        uint8_t bytes[16];
    };
    const Bytes& bytes_;
    gim_info info_ = {};
    std::vector<Image> images_;
    std::vector<Block> scratch_;
};

}  // namespace

std::unique_ptr<RepeatedDecoder> make_gim_decoder(const Bytes& bytes) {
    if (!is_gim(bytes)) return nullptr;
    auto decoder = std::make_unique<GimDecoder>(bytes);
    return decoder->prepare() ? std::move(decoder) : nullptr;
}

}  // namespace gim::rd
