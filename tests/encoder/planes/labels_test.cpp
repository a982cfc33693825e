#include "encoder/planes/labels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "corpus/generators.h"
#include "encoder/code/decode_surface.h"
#include "gim/cut.h"
#include "gim/encoder.h"
#include "tests/decoder/vectors.h"

namespace gim {
namespace {

using Bytes = std::vector<uint8_t>;

// Label 7 where x is above 0, else label 2.
TriangleMesh halves() {
    TriangleMesh mesh = corpus::sphere(8);
    for (const auto& t : mesh.triangles) {
        const double x = mesh.positions[t[0]][0] + mesh.positions[t[1]][0] + mesh.positions[t[2]][0];
        mesh.labels.push_back(x > 0 ? 7 : 2);
    }
    return mesh;
}

EncodeOptions quick(Layout layout) {
    EncodeOptions options;
    options.layout = layout;
    options.side = 33;
    options.samples = 1089;
    options.tiles = 6;
    options.threads = 2;
    return options;
}

Bytes labels_of(const Bytes& file) {
    Decoder decoder;
    DecoderLevel level;
    EXPECT_EQ(decoder.open(file), GIM_OK);
    EXPECT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    Bytes labels(level.triangle_count / 2);
    EXPECT_EQ(decoder.labels(level, labels), GIM_OK);
    return labels;
}

bool has_chunk(const Bytes& file, const std::string& name) {
    Decoder decoder;
    gim_chunk chunk;
    EXPECT_EQ(decoder.open(file), GIM_OK);
    for (uint32_t i = 0; decoder.read_chunk(i, &chunk) == GIM_OK; ++i)
        if (chunk.name == name) return true;
    return false;
}

TEST(Labels, CellsTakeTheLabelOfTheInputAtTheirMiddle) {
    for (const Layout layout : {Layout::kGim, Layout::kTiles}) {
        const auto encoded = encode(halves(), quick(layout));
        ASSERT_TRUE(encoded.ok()) << encoded.error().message;
        const Bytes& file = encoded.value().bytes;
        EXPECT_EQ(encoded.value().report.file_bytes, file.size());
        const Mesh surface = decode_surface(file, 0).value();
        const Bytes labels = labels_of(file);
        ASSERT_EQ(2 * labels.size(), surface.triangles.size());
        size_t certain = 0;
        for (size_t cell = 0; cell < labels.size(); ++cell) {
            double low = HUGE_VAL, high = -HUGE_VAL;
            for (size_t t = 2 * cell; t < 2 * cell + 2; ++t)
                for (const uint32_t v : surface.triangles[t]) {
                    low = std::min(low, surface.positions[v].x());
                    high = std::max(high, surface.positions[v].x());
                }
            // The input's triangles at the border reach about a tenth beyond it.
            if (low < 0.15 && high > -0.15) continue;
            EXPECT_EQ(labels[cell], low > 0 ? 7 : 2);
            ++certain;
        }
        EXPECT_GT(certain, labels.size() / 2);
    }
}

TEST(Labels, TheSurfaceIsTheOneWithoutLabels) {
    TriangleMesh mesh = halves();
    const auto with = encode(mesh, quick(Layout::kGim));
    mesh.labels.clear();
    const auto without = encode(mesh, quick(Layout::kGim));
    ASSERT_TRUE(with.ok() && without.ok());
    CutOptions drop;
    drop.drop_labels = true;
    EXPECT_EQ(cut(with.value().bytes, drop).value().bytes, without.value().bytes);
}

TEST(Labels, OneLabelIsNotStored) {
    TriangleMesh mesh = halves();
    mesh.labels.assign(mesh.triangles.size(), 9);
    const auto encoded = encode(mesh, quick(Layout::kGim));
    ASSERT_TRUE(encoded.ok());
    EXPECT_FALSE(has_chunk(encoded.value().bytes, "LABL"));
}

TEST(Labels, ABudgetOfBytesHoldsThemToo) {
    EncodeOptions options = quick(Layout::kGim);
    options.rate = {RateTarget::Kind::kBytes, 700};
    const auto encoded = encode(halves(), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_LE(encoded.value().bytes.size(), 700u);
    EXPECT_TRUE(has_chunk(encoded.value().bytes, "LABL"));
}

TEST(Labels, LayoutsWithoutCellsAreRefused) {
    const auto encoded = encode(halves(), quick(Layout::kMcgim));
    ASSERT_FALSE(encoded.ok());
    EXPECT_NE(encoded.error().message.find("mcgim"), std::string::npos);
}

TEST(Labels, TheLosslessChoiceLeavesOutLayoutsWithoutCells) {
    EncodeOptions options = quick(Layout::kAuto);
    options.rate.kind = RateTarget::Kind::kLossless;
    const auto encoded = encode(halves(), options);
    ASSERT_TRUE(encoded.ok()) << encoded.error().message;
    EXPECT_NE(encoded.value().report.layout, Layout::kMcgim);
    EXPECT_TRUE(has_chunk(encoded.value().bytes, "LABL"));
}

TEST(Labels, OtherNumbersOfLabelsAreRefused) {
    TriangleMesh mesh = halves();
    mesh.labels.pop_back();
    EXPECT_FALSE(encode(mesh, quick(Layout::kGim)).ok());
}

}  // namespace
}  // namespace gim
