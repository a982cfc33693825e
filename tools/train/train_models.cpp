// Prints new tables for format/trained_models.h, made from .gim files:
//   gim_train a.gim b.gim ...
// of the layout `gim` with one image, and of the layout `tiles`. Lossy positions train the tables for coefficients in
// frames, lossless positions those for plain coefficients, planes and tiles their own. A table that no file trains stays
// unchanged. Weights decide which model takes a decision. So put new weights into the header, build, encode the files
// again, and take the states from a second run.
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
#include <vector>

#include "tools/train/training_image.h"

namespace gim {
namespace {

constexpr size_t kMostEvents = 1500;
// By kind: lossless files are long.
constexpr size_t kMostDecisions[kCoefficientKinds] = {3000, 400, 1500, 3000, 400};
constexpr CoefficientKind kSquareKinds[3] = {CoefficientKind::kPlain, CoefficientKind::kInFrames,
                                             CoefficientKind::kPlanes};
constexpr CoefficientKind kTileKinds[2] = {CoefficientKind::kTiles, CoefficientKind::kTilesInFrames};
constexpr int kSteps = 800;  // of Adam
constexpr double kLeastWeight = 1e-3;

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
std::vector<Event> events_of(const TrainingImages& images, CoefficientKind kind, uint32_t weights,
                             Orientation orientation, bool later) {
    std::vector<Event> all;
    for (const auto& image : images) {
        if (image->kind() != kind) continue;
        std::vector<Event> events;
        image->for_each_bands([&](const TrainingBands& b) {
            if (b.weights != weights) return;
            const Band& band = b.bands.of(orientation);
            for (uint32_t row = 0; row < band.rows; ++row) {
                for (uint32_t column = 0; column < band.columns; ++column) {
                    if (b.has_flags && empty(band, row / 8 * 8, column / 8 * 8)) {
                        column |= 7;
                        continue;
                    }
                    if (!b.is_coded(orientation, row, column)) continue;
                    for (uint32_t k = later ? 1 : 0; k < (later ? 3u : 1u); ++k)
                        events.push_back(event_at(b.bands, b.parents, orientation, row, column, k));
                }
            }
        });
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
    const auto rounded = [&](size_t i) {
        const double weight = std::exp(log_weight[i]);
        return useful[i] && weight > 1.01 * kLeastWeight ? static_cast<uint32_t>(std::lround(weight * 256)) : 0u;
    };
    const auto n = [&](size_t i) { return static_cast<uint8_t>(std::min(rounded(i), 255u)); };
    return {n(0), n(1), n(2), n(3), n(4), n(5), n(6), n(7), n(8), n(9), rounded(10)};
}

// ---- states ---------------------------------------------------------------------------------------------------------

std::vector<BitModel> fresh_models(CoefficientKind kind) {
    std::vector<BitModel> fresh;
    BandModels(kind).for_each([&](BitModel& model) { fresh.push_back(model); });
    return fresh;
}

std::string fit_states(const TrainingImages& images, CoefficientKind kind) {
    using Bits = std::vector<uint8_t>;
    std::vector<std::vector<Bits>> seen;  // per model and file
    for (const auto& image : images) {
        if (image->kind() != kind) continue;
        std::vector<Bits> bits(fresh_models(kind).size());
        for (const auto& [model, bit] : image->record().decisions) {
            Bits& b = bits[model];
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

// What a perfect coder would take.
double coded_bytes(TrainingImage& image) {
    std::vector<BitModel> models = fresh_models(image.kind());
    const Recording recording = image.record();
    auto bits = static_cast<double>(recording.raw_bits);
    for (const auto& [number, bit] : recording.decisions) {
        const double zero = models[number].zero_probability() / 65536.0;
        bits -= std::log2(bit ? 1 - zero : zero);
        models[number].update(bit);
    }
    return bits / 8;
}

// ---- output ---------------------------------------------------------------------------------------------------------

void print(const BandWeights& w) {
    std::printf("{%u, %u, %u, %u, %u, %u, %u, %u, %u, %u, %u}", w.left, w.above, w.corners, w.parent, w.beside_parent,
                w.horizontal, w.vertical, w.cross, w.first, w.second, w.constant);
}

// current: by orientation, first and later. They stay where no file trains them.
void print_weights(const TrainingImages& images, CoefficientKind kind, uint32_t number,
                   const BandWeights (&current)[3][2]) {
    std::printf("        {\n");
    for (size_t o = 0; o < 3; ++o) {
        std::printf("            {");
        for (const bool later : {false, true}) {
            const auto events = events_of(images, kind, number, static_cast<Orientation>(o), later);
            print(events.empty() ? current[o][later] : fit_weights(events));
            std::printf(later ? "},\n" : ", ");
        }
    }
    std::printf("        },\n");
}

int run(std::span<char*> paths) {
    TrainingImages images;
    for (const char* path : paths) {
        std::ifstream stream(path, std::ios::binary);
        const std::vector<char> bytes((std::istreambuf_iterator<char>(stream)), {});
        const std::span<const uint8_t> file = {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()};
        const size_t first = images.size();
        if (Status s = read_training_images(file, &images); s != Status::kOk) {
            std::fprintf(stderr, "gim_train: %s: not a .gim file of one square or of tiles (status %d)\n", path,
                         static_cast<int>(s));
            return 1;
        }
        std::fprintf(stderr, "%s: bytes of coefficients with the current tables:", path);
        for (size_t i = first; i < images.size(); ++i) std::fprintf(stderr, " %.0f", coded_bytes(*images[i]));
        std::fprintf(stderr, "\n");
    }
    std::printf("// kBandWeights\n");
    for (const CoefficientKind kind : kSquareKinds) {
        std::printf("    {\n");
        for (const uint32_t fine : {0u, 1u})
            print_weights(images, kind, fine, kBandWeights[static_cast<size_t>(kind)][fine]);
        std::printf("    },\n");
    }
    std::printf("// kTileWeights\n");
    for (const CoefficientKind kind : kTileKinds) {
        std::printf("    {\n");
        for (uint32_t step = 0; step < kTileSteps; ++step)
            print_weights(images, kind, step, kTileWeights[is_in_frames(kind)][step]);
        std::printf("    },\n");
    }
    std::printf("// kTrainedModels\n");
    for (size_t kind = 0; kind < kCoefficientKinds; ++kind) {
        std::string codes = fit_states(images, static_cast<CoefficientKind>(kind));
        if (codes.empty()) codes = kTrainedModels[kind];
        for (size_t i = 0; i < codes.size(); i += 106) {
            std::printf("    \"%s\"%s\n", codes.substr(i, 106).c_str(), i + 106 < codes.size() ? "" : ",");
        }
    }
    return 0;
}

}  // namespace
}  // namespace gim

int main(int argc, char** argv) { return gim::run({argv + 1, argv + argc}); }
