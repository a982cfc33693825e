#include "format/trained_models.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

#include "format/band_code.h"

namespace gim {
namespace {

constexpr const char* kKinds[3] = {"plain ", "frames ", "planes "};
constexpr const char* kOrientations[3] = {"horiz ", "vert ", "diag "};
constexpr const char* kHeadings[kCoefficientKinds] = {"\nPlain:\n\n", "\nIn frames:\n\n", "\nPlanes:\n\n",
                                                      "\nTiles:\n\n", "\nTiles in frames:\n\n"};

std::string specification() {
    std::ifstream stream(GIM_SOURCE_DIR "/spec/gim-format.md");
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string weights_line(const std::string& name, const BandWeights& w) {
    char line[200];
    std::snprintf(line, sizeof line, "    %-26s%7u%7u%7u%7u%7u%7u%7u%7u%7u%7u%7u\n", name.c_str(), w.left, w.above,
                  w.corners, w.parent, w.beside_parent, w.horizontal, w.vertical, w.cross, w.first, w.second,
                  w.constant);
    return line;
}

// If the tables change, the expected text goes into the specification as it is.
TEST(TrainedModels, WeightsAreThoseOfTheSpecification) {
    std::string expected = weights_line("base first", kBaseWeights[0]) + weights_line("base later", kBaseWeights[1]);
    const auto add = [&](const std::string& name, const BandWeights(&weights)[3][2]) {
        for (const size_t orientation : {0u, 1u, 2u}) {
            for (const size_t later : {0u, 1u})
                expected += weights_line(name + kOrientations[orientation] + (later ? "later" : "first"),
                                         weights[orientation][later]);
        }
    };
    for (const size_t kind : {0u, 1u, 2u}) {
        for (const size_t fine : {0u, 1u})
            add(std::string(kKinds[kind]) + (fine ? "fine " : "coarse "), kBandWeights[kind][fine]);
    }
    for (const size_t framed : {0u, 1u}) {
        for (size_t step = 0; step < kTileSteps; ++step)
            add((framed ? "tiles frames " : "tiles ") + std::to_string(step + 1) + " ", kTileWeights[framed][step]);
    }
    EXPECT_NE(specification().find(expected), std::string::npos) << expected;
}

TEST(TrainedModels, StatesAreThoseOfTheSpecification) {
    const std::string text = specification();
    for (size_t kind = 0; kind < kCoefficientKinds; ++kind) {
        const std::string codes = kTrainedModels[kind];
        std::string expected = kHeadings[kind];
        for (size_t i = 0; i < codes.size(); i += 128) expected += "    " + codes.substr(i, 128) + "\n";
        EXPECT_NE(text.find(expected), std::string::npos) << expected;
    }
    std::string ages, probabilities;
    for (const uint32_t age : kStartAges) ages += (ages.empty() ? "" : ", ") + std::to_string(age);
    EXPECT_NE(text.find("Age by its code: " + ages + "."), std::string::npos) << ages;
    for (size_t i = 0; i < 32; ++i)
        probabilities += (i % 16 ? " " : "    ") + std::to_string(kStartProbabilities[i]) + (i % 16 == 15 ? "\n" : "");
    EXPECT_NE(text.find(probabilities), std::string::npos) << probabilities;
}

TEST(TrainedModels, EveryModelHasAState) {
    for (size_t kind = 0; kind < kCoefficientKinds; ++kind) {
        BandModels models(static_cast<CoefficientKind>(kind));
        size_t count = 0;
        models.for_each([&](const BitModel& model) {
            ++count;
            EXPECT_GE(model.zero_probability(), 200u);
            EXPECT_LE(model.zero_probability(), 65336u);
        });
        EXPECT_EQ(std::string(kTrainedModels[kind]).size(), 2 * count);
    }
}

}  // namespace
}  // namespace gim
