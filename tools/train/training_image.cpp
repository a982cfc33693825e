#include "tools/train/training_image.h"

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "decoder/squares/square_decoder.h"
#include "encoder/tiles/own_complex.h"
#include "format/plane_code.h"
#include "format/tile_base.h"
#include "format/tile_code.h"
#include "format/tile_seams.h"

namespace gim {
namespace {

constexpr ContainerLimits kNoLimits{UINT64_MAX, UINT32_MAX, UINT32_MAX};

// A coder that only records the decisions.
class Recorder {
  public:
    static constexpr bool kWrites = true;

    explicit Recorder(BandModels& models) {
        models.for_each([&](BitModel& model) { number_.emplace(&model, number_.size()); });
    }
    uint32_t code_bit(BitModel& model, uint32_t bit) {
        recording.decisions.emplace_back(number_.at(&model), static_cast<uint8_t>(bit));
        return bit;
    }
    uint32_t code_raw(uint32_t value, uint32_t count) {
        recording.raw_bits += count;
        return value;
    }

    Recording recording;

  private:
    std::unordered_map<const BitModel*, size_t> number_;
};

// ---- squares and planes ---------------------------------------------------------------------------------------------

struct Level {
    uint32_t side = 0;  // of the image that the bands lead to
    std::vector<int32_t> values[3];
    OwnSharedRim rim{nullptr, 0};  // where mates share their details

    LevelBands bands() {
        const uint32_t low = low_count(side), high = high_count(side);
        return {{values[0].data(), low, high}, {values[1].data(), high, low}, {values[2].data(), high, high}};
    }
};

class SquareTraining final : public TrainingImage {
  public:
    SquareTraining(CoefficientKind kind, uint32_t exponent) : kind_(kind), base_(12) {
        for (uint32_t e = 1; e <= exponent; ++e) {
            Level level;
            level.side = (1u << e) + 1;
            for (auto& values : level.values) values.resize(size_t{level.side} * level.side * 3);  // more than enough
            levels_.push_back(std::move(level));
        }
    }

    CoefficientKind kind() const override { return kind_; }
    size_t steps() const { return levels_.size(); }
    uint32_t side() const { return levels_.back().side; }
    void share_rims(const SeamTable& seams) {
        for (Level& level : levels_) level.rim = OwnSharedRim(&seams, level.side);
    }

    template <class Coder>
    bool code(BandCoder<Coder>& coder, size_t begin, size_t end) {
        if (begin == 0 && !coder.code_base({base_.data(), 2, 2})) return false;
        for (size_t l = begin; l < end; ++l) {
            const LevelBands parents = parents_of(l);
            if (!coder.code_level(levels_[l].bands(), l > 0 ? &parents : nullptr, levels_[l].rim.view())) return false;
        }
        return true;
    }
    Recording record() override {
        BandModels models(kind_);
        Recorder recorder(models);
        OwnBandWork work(side());
        BandCoder<Recorder> coder(&recorder, &models, work.view());
        (void)code(coder, 0, steps());
        return std::move(recorder.recording);
    }
    void for_each_bands(const std::function<void(const TrainingBands&)>& f) override {
        for (size_t l = 0; l < levels_.size(); ++l) {
            const SharedRim rim = levels_[l].rim.view();
            f({levels_[l].bands(), parents_of(l), levels_[l].side >= kFineSide, true,
               [rim](Orientation o, uint32_t row, uint32_t column) { return !rim.is_copy(o, row, column); }});
        }
    }

  private:
    LevelBands parents_of(size_t l) { return l > 0 ? levels_[l - 1].bands() : LevelBands{}; }

    CoefficientKind kind_;
    std::vector<int32_t> base_;
    std::vector<Level> levels_;
};

Status payload_of_level(const Header& header, std::span<const uint8_t> file, uint32_t level,
                        std::span<const uint8_t>* payload) {
    Chunk chunk;
    uint64_t offset = 0;
    if (Status s = find_level_chunk(header, level, &chunk, &offset); s != Status::kOk) return s;
    return read_payload(file, chunk, offset, payload);
}

Status read_square(const Header& header, std::span<const uint8_t> file, TrainingImages* images) {
    auto image = std::make_unique<SquareTraining>(coefficient_kind_of(header), header.side_exponents[0]);
    BandModels models(image->kind());
    SeamTable seams;
    if (header.tangential > 0) {
        if (Status s = read_seams(header, file, 0, &seams); s != Status::kOk) return s;
        image->share_rims(seams);
    }
    OwnBandWork work(image->side());
    size_t done = 0;
    for (uint32_t l = header.level_count_of(0); l-- > 0;) {
        std::span<const uint8_t> payload;
        if (Status s = payload_of_level(header, file, l, &payload); s != Status::kOk) return s;
        RangeDecoder decoder(payload);
        BandCoder<RangeDecoder> coder(&decoder, &models, work.view());
        const size_t end = image->steps() - l;
        if (!image->code(coder, done, end) || !decoder.intact()) return Status::kMalformed;
        done = end;
    }
    images->push_back(std::move(image));
    return Status::kOk;
}

Status read_planes(const Header& header, std::span<const uint8_t> file, TrainingImages* images) {
    for (uint32_t kind = 0; kind < kPlaneKinds; ++kind) {
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload;
        PlaneChunk stored;
        if (!find_chunk(header, plane_type(kind), &chunk, &offset)) continue;
        if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
        if (Status s = parse_plane(payload, header, 0, kNoLimits, &stored); s != Status::kOk) return s;
        auto plane = std::make_unique<SquareTraining>(CoefficientKind::kPlanes, stored.side_exponents[0]);
        BandModels models(plane->kind());
        OwnBandWork work(stored.side(0));
        RangeDecoder decoder(stored.stream);
        BandCoder<RangeDecoder> coder(&decoder, &models, work.view());
        if (!plane->code(coder, 0, plane->steps()) || !decoder.intact()) return Status::kMalformed;
        images->push_back(std::move(plane));
    }
    return Status::kOk;
}

// ---- tiles ----------------------------------------------------------------------------------------------------------

class TileTraining final : public TrainingImage {
  public:
    explicit TileTraining(const Header& header)
        : kind_(tile_kind_of(header)), complex_(header.tiles.tiles), flags_(header.tiles.tiles) {
        for (uint32_t e = 0; e < header.tiles.exponent; ++e)
            details_.emplace_back(header.tiles.tiles * TilePlanes(1u << e).details());
    }

    CoefficientKind kind() const override { return kind_; }
    uint32_t steps() const { return static_cast<uint32_t>(details_.size()); }

    Status read_complex(const Header& header, std::span<const uint8_t> file) {
        std::span<const uint8_t> payload;
        if (Status s = read_seam_payload(header, file, &payload); s != Status::kOk) return s;
        struct {
        } source;
        std::vector<uint32_t> next(complex().half_edges()), previous(next.size()), fan(next.size());
        RangeDecoder decoder(payload);
        if (!code_tile_seams(decoder, source, header.tiles, {next.data(), previous.data(), fan.data()},
                             &complex_.view()))
            return Status::kMalformed;
        base_.resize(3 * size_t{complex().vertices});
        return Status::kOk;
    }
    template <class Coder>
    bool code(Coder& coder, BandModels& models, uint32_t begin, uint32_t end) {
        if (begin == 0 && !BaseCoder<Coder>(&coder, &models).code(complex(), base_.data())) return false;
        OwnBandWork work((1u << end) + 1);
        TileCoder<Coder> tiles(&coder, &models, work.view());
        for (uint32_t e = begin; e < end; ++e) {
            if (!tiles.code_step(complex(), TilePlanes(1u << e), details_[e].data(),
                                 e > 0 ? details_[e - 1].data() : nullptr, flags_.data()))
                return false;
        }
        return true;
    }
    Recording record() override {
        BandModels models(kind_);
        Recorder recorder(models);
        (void)code(recorder, models, 0, steps());
        return std::move(recorder.recording);
    }
    void for_each_bands(const std::function<void(const TrainingBands&)>& f) override {
        for (uint32_t e = 0; e < steps(); ++e) {
            for (uint32_t t = 0; t < complex().tiles; ++t) {
                const TilePlanes planes(1u << e);
                const LevelBands bands = bands_of(e, t);
                f({bands, e > 0 ? bands_of(e - 1, t) : LevelBands{}, weights_step(planes.h),
                   planes.h >= kLeastFlaggedTile,
                   [this, t, h = planes.h](Orientation o, uint32_t row, uint32_t column) {
                       return !is_known(t, o, row, column, h);
                   }});
            }
        }
    }

  private:
    const QuadComplex& complex() const { return complex_.view(); }
    LevelBands bands_of(uint32_t e, uint32_t tile) {
        const TilePlanes planes(1u << e);
        return planes.bands(details_[e].data() + tile * planes.details());
    }
    // Whether an earlier tile has the detail.
    bool is_known(uint32_t tile, Orientation o, uint32_t row, uint32_t column, uint32_t h) const {
        const auto beyond = [&](uint32_t side) { return complex().mate[4 * tile + side] < 4 * tile + side; };
        if (o == Orientation::kHorizontal) return (row == 0 && beyond(0)) || (row == h && beyond(2));
        if (o == Orientation::kVertical) return (column == 0 && beyond(3)) || (column == h && beyond(1));
        return false;
    }

    CoefficientKind kind_;
    OwnComplex complex_;
    std::vector<int32_t> base_;
    std::vector<std::vector<int32_t>> details_;
    std::vector<TileFlags> flags_;
};

Status read_tiles(const Header& header, std::span<const uint8_t> file, TrainingImages* images) {
    auto image = std::make_unique<TileTraining>(header);
    if (Status s = image->read_complex(header, file); s != Status::kOk) return s;
    BandModels models(image->kind());
    uint32_t done = 0;
    for (uint32_t l = header.level_count; l-- > 0;) {
        std::span<const uint8_t> payload;
        if (Status s = payload_of_level(header, file, l, &payload); s != Status::kOk) return s;
        RangeDecoder decoder(payload);
        const uint32_t end = image->steps() - l;
        if (!image->code(decoder, models, done, end) || !decoder.intact()) return Status::kMalformed;
        done = end;
    }
    images->push_back(std::move(image));
    return Status::kOk;
}

}  // namespace

Status read_training_images(std::span<const uint8_t> file, TrainingImages* images) {
    Header header;
    if (Status s = parse_header(file, kNoLimits, &header); s != Status::kOk) return s;
    if (header.layout == FileLayout::kTiles) return read_tiles(header, file, images);
    if (header.layout != FileLayout::kSquares || header.image_count() != 1) return Status::kBadArgument;
    if (Status s = read_square(header, file, images); s != Status::kOk) return s;
    return read_planes(header, file, images);
}

}  // namespace gim
