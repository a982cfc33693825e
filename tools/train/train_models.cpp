// Prints new tables for format/trained_models.h, made from .gim files of the layout `gim` with one image:
//   gim_train a.gim b.gim ...
// Lossy positions train the tables for coefficients in frames, lossless positions those for plain coefficients, planes
// their own. A table that no file trains stays unchanged. Weights decide which model takes a decision. So put new
// weights into the header, build, encode the files again, and take the states from a second run.
//
// 1. Weights, per coefficient class. The expected magnitude is e = sum of weight * magnitude nearby. The fit makes the
//    magnitude m, taken as geometric with mean e, cost fewest bits: (m + 1) log(1 + e) - m log e. Adam works on the
//    logarithms of the weights. Each file gives at most kMostEvents to a class, so large files do not drown small ones.
// 2. States. Each model takes the start probability and age with which its first kMostDecisions decisions in each file
//    cost fewest bits. A small price keeps rarely used models near the middle.
// Cost: a minute for 50 files. Deterministic.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "decoder/squares/square_decoder.h"
#include "format/band_code.h"
#include "format/plane_code.h"

namespace gim {
namespace {

constexpr size_t kMostEvents = 1500;
constexpr size_t kMostDecisions[3] = {3000, 400, 1500};  // by kind: lossless files are long
constexpr CoefficientKind kKinds[3] = {CoefficientKind::kPlain, CoefficientKind::kInFrames, CoefficientKind::kPlanes};
constexpr int kSteps = 800;  // of Adam
constexpr double kLeastWeight = 1e-3;

// The bands of an image, coarsest first.
struct Level {
    uint32_t columns = 0, rows = 0;  // of the image that the bands lead to
    std::vector<int32_t> values[3];
    OwnSharedRim rim{nullptr, 0};  // where mates share their details

    LevelBands bands() {
        return {{values[0].data(), low_count(rows), high_count(columns)},
                {values[1].data(), high_count(rows), low_count(columns)},
                {values[2].data(), high_count(rows), high_count(columns)}};
    }
};
struct Image {
    CoefficientKind kind = CoefficientKind::kPlain;
    std::vector<int32_t> base;
    std::vector<Level> levels;
};

// A coder that only records the decisions.
struct Listener {
    static constexpr bool kWrites = true;
    std::vector<std::pair<const BitModel*, uint8_t>> decisions;

    uint32_t code_bit(BitModel& model, uint32_t bit) {
        decisions.emplace_back(&model, static_cast<uint8_t>(bit));
        return bit;
    }
    uint32_t code_raw(uint32_t value, uint32_t) { return value; }
};

template <class Coder>
bool code_levels(BandCoder<Coder>& coder, Image& image, size_t begin, size_t end) {
    if (begin == 0 && !coder.code_base({image.base.data(), 2, 2})) return false;
    for (size_t l = begin; l < end; ++l) {
        LevelBands parents;
        if (l > 0) parents = image.levels[l - 1].bands();
        if (!coder.code_level(image.levels[l].bands(), l > 0 ? &parents : nullptr, image.levels[l].rim.view()))
            return false;
    }
    return true;
}

Image blank_image(CoefficientKind kind, uint32_t exponent) {
    Image image;
    image.kind = kind;
    image.base.resize(12);
    for (uint32_t e = 1; e <= exponent; ++e) {
        Level level;
        level.columns = level.rows = (1u << e) + 1;
        for (auto& values : level.values) values.resize(size_t{level.rows} * level.columns * 3);  // more than enough
        image.levels.push_back(std::move(level));
    }
    return image;
}

// Reads the coefficients of a file's only image, and of its planes.
Status read_images(std::span<const uint8_t> file, std::vector<Image>* images) {
    Header header;
    const ContainerLimits no_limits{UINT64_MAX, UINT32_MAX, UINT32_MAX};
    if (Status s = parse_header(file, no_limits, &header); s != Status::kOk) return s;
    if (header.layout != FileLayout::kSquares || header.image_count() != 1) return Status::kBadArgument;
    Image positions = blank_image(coefficient_kind_of(header), header.side_exponents[0]);
    BandModels models(positions.kind);
    if (header.tangential > 0) {
        SeamTable seams;
        if (Status s = read_seams(header, file, 0, &seams); s != Status::kOk) return s;
        for (Level& level : positions.levels) level.rim = OwnSharedRim(&seams, level.columns);
    }
    OwnBandWork work(header.side(0));
    size_t done = 0;
    for (uint32_t l = header.level_count_of(0); l-- > 0;) {
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload;
        if (Status s = find_level_chunk(header, l, &chunk, &offset); s != Status::kOk) return s;
        if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
        RangeDecoder decoder(payload);
        BandCoder<RangeDecoder> coder(&decoder, &models, work.view());
        const size_t end = positions.levels.size() - l;
        if (!code_levels(coder, positions, done, end) || !decoder.intact()) return Status::kMalformed;
        done = end;
    }
    images->push_back(std::move(positions));
    for (uint32_t kind = 0; kind < kPlaneKinds; ++kind) {
        Chunk chunk;
        uint64_t offset = 0;
        std::span<const uint8_t> payload;
        PlaneChunk stored;
        if (!find_chunk(header, plane_type(kind), &chunk, &offset)) continue;
        if (Status s = read_payload(file, chunk, offset, &payload); s != Status::kOk) return s;
        if (Status s = parse_plane(payload, header, 0, no_limits, &stored); s != Status::kOk) return s;
        Image plane = blank_image(CoefficientKind::kPlanes, stored.side_exponents[0]);
        BandModels plane_models(plane.kind);
        OwnBandWork plane_work(stored.side(0));
        RangeDecoder decoder(stored.stream);
        BandCoder<RangeDecoder> coder(&decoder, &plane_models, plane_work.view());
        if (!code_levels(coder, plane, 0, plane.levels.size()) || !decoder.intact()) return Status::kMalformed;
        images->push_back(std::move(plane));
    }
    return Status::kOk;
}

// ---- weights --------------------------------------------------------------------------------------------------------

constexpr size_t kWeights = 11;  // members of BandWeights, in their order
struct Event {
    double nearby[kWeights];
    double magnitude;
};

double magnitude_at(const Band& band, int64_t row, int64_t column, uint32_t k) {
    if (!band.values || row < 0 || column < 0 || row >= band.rows || column >= band.columns) return 0;
    return magnitude_of(band.row(static_cast<uint32_t>(row))[static_cast<size_t>(column) * 3 + k]);
}

// Collects the magnitudes that spec/gim-format.md, "Values", weighs.
Event event_at(const LevelBands& level, const LevelBands& parents, Orientation orientation, int64_t row, int64_t column,
               uint32_t k) {
    const Band &band = level.of(orientation), &parent = parents.of(orientation);
    const auto at = [&](int64_t r, int64_t c, uint32_t component) { return magnitude_at(band, r, c, component); };
    const auto beside = [&](uint32_t component) {
        return at(row, column - 1, component) + at(row - 1, column, component);
    };
    const auto parent_at = [&](int64_t r, int64_t c) { return magnitude_at(parent, r, c, k); };
    Event e{};
    e.nearby[0] = at(row, column - 1, k);
    e.nearby[1] = at(row - 1, column, k);
    e.nearby[2] = at(row - 1, column - 1, k) + at(row - 1, column + 1, k);
    const int64_t r = row / 2, c = column / 2;
    e.nearby[3] = parent_at(r, c);
    // The decoder ignores the neighbours of a parent that does not exist.
    if (r < parent.rows && c < parent.columns)
        e.nearby[4] = parent_at(r - 1, c) + parent_at(r + 1, c) + parent_at(r, c - 1) + parent_at(r, c + 1);
    for (int64_t d = 0; d < 2; ++d) {
        if (orientation != Orientation::kHorizontal) {
            e.nearby[5] += magnitude_at(level.horizontal, row + d, column, k);
            if (orientation == Orientation::kVertical)
                e.nearby[5] += magnitude_at(level.horizontal, row + d, column - 1, k);
        }
        if (orientation == Orientation::kDiagonal) e.nearby[6] += magnitude_at(level.vertical, row, column + d, k);
    }
    e.nearby[7] = k == 0 ? beside(1) + beside(2) : beside(3 - k);
    if (k > 0) e.nearby[8] = at(row, column, 0);
    if (k == 2) e.nearby[9] = at(row, column, 1);
    e.nearby[10] = 1;
    e.magnitude = at(row, column, k);
    return e;
}

bool empty(const Band& band, uint32_t row, uint32_t column) {
    for (uint32_t r = row; r < std::min(row + 8, band.rows); ++r) {
        for (uint32_t i = column * 3; i < std::min(column + 8, band.columns) * 3; ++i)
            if (band.row(r)[i] != 0) return false;
    }
    return true;
}

// Returns the coefficients of one class that lie outside of empty blocks.
std::vector<Event> events_of(std::vector<Image>& images, CoefficientKind kind, bool fine, Orientation orientation,
                             bool later) {
    std::vector<Event> all;
    for (Image& image : images) {
        if (image.kind != kind) continue;
        std::vector<Event> events;
        for (size_t l = 0; l < image.levels.size(); ++l) {
            if ((std::min(image.levels[l].columns, image.levels[l].rows) >= kFineSide) != fine) continue;
            const LevelBands level = image.levels[l].bands(),
                             parents = l > 0 ? image.levels[l - 1].bands() : LevelBands{};
            const Band& band = level.of(orientation);
            for (uint32_t row = 0; row < band.rows; ++row) {
                for (uint32_t column = 0; column < band.columns; ++column) {
                    if (empty(band, row / 8 * 8, column / 8 * 8)) {
                        column |= 7;
                        continue;
                    }
                    if (image.levels[l].rim.view().is_copy(orientation, row, column)) continue;
                    for (uint32_t k = later ? 1 : 0; k < (later ? 3u : 1u); ++k)
                        events.push_back(event_at(level, parents, orientation, row, column, k));
                }
            }
        }
        const size_t stride = events.size() / kMostEvents + 1;
        for (size_t i = 0; i < events.size(); i += stride) all.push_back(events[i]);
    }
    return all;
}

BandWeights fit_weights(const std::vector<Event>& events) {
    bool useful[kWeights] = {};
    for (const Event& e : events)
        for (size_t i = 0; i < kWeights; ++i) useful[i] |= e.nearby[i] != 0;
    double log_weight[kWeights], mean[kWeights] = {}, square[kWeights] = {};
    std::fill_n(log_weight, kWeights, std::log(0.1));
    for (int step = 1; step <= kSteps; ++step) {
        double gradient[kWeights] = {}, weight[kWeights];
        for (size_t i = 0; i < kWeights; ++i) weight[i] = std::exp(log_weight[i]);
        for (const Event& e : events) {
            double expected = 0;
            for (size_t i = 0; i < kWeights; ++i) expected += weight[i] * e.nearby[i];
            const double slope = (e.magnitude + 1) / (1 + expected) - e.magnitude / expected;
            for (size_t i = 0; i < kWeights; ++i) gradient[i] += slope * weight[i] * e.nearby[i];
        }
        const double rate = 0.1 * std::min(1.0, 1.6 * (kSteps - step) / kSteps);
        for (size_t i = 0; i < kWeights; ++i) {
            const double g = gradient[i] / static_cast<double>(events.size());
            mean[i] = 0.9 * mean[i] + 0.1 * g;
            square[i] = 0.999 * square[i] + 0.001 * g * g;
            log_weight[i] -= rate * mean[i] / (1 - std::pow(0.9, step)) /
                             (std::sqrt(square[i] / (1 - std::pow(0.999, step))) + 1e-8);
            log_weight[i] = std::max(log_weight[i], std::log(kLeastWeight));
        }
    }
    uint32_t n[kWeights];
    for (size_t i = 0; i < kWeights; ++i) {
        const double weight = std::exp(log_weight[i]);
        n[i] = useful[i] && weight > 1.01 * kLeastWeight ? static_cast<uint32_t>(std::lround(weight * 256)) : 0;
    }
    return {n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8], n[9], n[10]};
}

// ---- states ---------------------------------------------------------------------------------------------------------

std::string fit_states(std::vector<Image>& images, CoefficientKind kind) {
    using Bits = std::vector<uint8_t>;
    std::vector<std::vector<Bits>> seen;  // per model and file
    for (Image& image : images) {
        if (image.kind != kind) continue;
        BandModels models(kind);
        std::unordered_map<const BitModel*, size_t> number;
        models.for_each([&](BitModel& model) { number.emplace(&model, number.size()); });
        Listener listener;
        OwnBandWork work(image.levels.back().columns);
        BandCoder<Listener> coder(&listener, &models, work.view());
        (void)code_levels(coder, image, 0, image.levels.size());
        std::vector<Bits> bits(number.size());
        for (const auto& [model, bit] : listener.decisions) {
            Bits& b = bits[number[model]];
            if (b.size() < kMostDecisions[static_cast<size_t>(kind)]) b.push_back(bit);
        }
        seen.resize(bits.size());
        for (size_t m = 0; m < bits.size(); ++m) seen[m].push_back(std::move(bits[m]));
    }
    std::vector<double> bits_of(65537);
    for (size_t p = 1; p < bits_of.size(); ++p) bits_of[p] = -std::log2(static_cast<double>(p) / 65536);
    std::string codes;
    for (const auto& files : seen) {
        double least = HUGE_VAL;
        size_t best = 16;
        for (size_t code = 0; code < 256; ++code) {
            double cost = 0.2 * std::abs(static_cast<double>(code & 31) - 16) + 0.02 * kStartAges[code >> 5];
            for (const Bits& bits : files) {
                BitModel model(kStartProbabilities[code & 31], kStartAges[code >> 5]);
                for (const uint8_t bit : bits) {
                    const uint32_t zero = model.zero_probability();
                    cost += bits_of[bit ? 65536 - zero : zero];
                    model.update(bit);
                }
                if (cost > least) break;
            }
            if (cost < least) least = cost, best = code;
        }
        for (const size_t digit : {best >> 4, best & 15}) codes += "0123456789abcdef"[digit];
    }
    return codes;
}

// Counts the bits that a perfect coder would take.
struct Meter {
    static constexpr bool kWrites = true;
    double bits = 0;

    uint32_t code_bit(BitModel& model, uint32_t bit) {
        const double zero = model.zero_probability() / 65536.0;
        bits -= std::log2(bit ? 1 - zero : zero);
        model.update(bit);
        return bit;
    }
    uint32_t code_raw(uint32_t value, uint32_t count) {
        bits += count;
        return value;
    }
};

double coded_bytes(Image& image) {
    Meter meter;
    BandModels models(image.kind);
    OwnBandWork work(image.levels.back().columns);
    BandCoder<Meter> coder(&meter, &models, work.view());
    (void)code_levels(coder, image, 0, image.levels.size());
    return meter.bits / 8;
}

// ---- output ---------------------------------------------------------------------------------------------------------

void print(const BandWeights& w) {
    std::printf("{%u, %u, %u, %u, %u, %u, %u, %u, %u, %u, %u}", w.left, w.above, w.corners, w.parent, w.beside_parent,
                w.horizontal, w.vertical, w.cross, w.first, w.second, w.constant);
}

int run(std::span<char*> paths) {
    std::vector<Image> images;
    for (const char* path : paths) {
        std::ifstream stream(path, std::ios::binary);
        const std::vector<char> bytes((std::istreambuf_iterator<char>(stream)), {});
        const std::span<const uint8_t> file = {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
        const size_t first = images.size();
        if (Status s = read_images(file, &images); s != Status::kOk) {
            std::fprintf(stderr, "gim_train: %s: not a .gim file of layout gim with one image (status %d)\n", path,
                         static_cast<int>(s));
            return 1;
        }
        std::fprintf(stderr, "%s: bytes of coefficients with the current tables:", path);
        for (size_t i = first; i < images.size(); ++i) std::fprintf(stderr, " %.0f", coded_bytes(images[i]));
        std::fprintf(stderr, "\n");
    }
    std::printf("// kBandWeights\n");
    for (const CoefficientKind kind : kKinds) {
        std::printf("    {\n");
        for (const bool fine : {false, true}) {
            std::printf("        {\n");
            for (size_t o = 0; o < 3; ++o) {
                std::printf("            {");
                for (const bool later : {false, true}) {
                    const auto events = events_of(images, kind, fine, static_cast<Orientation>(o), later);
                    print(events.empty() ? kBandWeights[static_cast<size_t>(kind)][fine][o][later]
                                         : fit_weights(events));
                    std::printf(later ? "},\n" : ", ");
                }
            }
            std::printf("        },\n");
        }
        std::printf("    },\n");
    }
    std::printf("// kTrainedModels\n");
    for (const CoefficientKind kind : kKinds) {
        std::string codes = fit_states(images, kind);
        if (codes.empty()) codes = kTrainedModels[static_cast<size_t>(kind)];
        for (size_t i = 0; i < codes.size(); i += 106) {
            std::printf("    \"%s\"%s\n", codes.substr(i, 106).c_str(), i + 106 < codes.size() ? "" : ",");
        }
    }
    return 0;
}

}  // namespace
}  // namespace gim

int main(int argc, char** argv) { return gim::run({argv + 1, argv + argc}); }
