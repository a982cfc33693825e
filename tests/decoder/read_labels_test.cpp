#include <gtest/gtest.h>

#include <string>

#include "gim/decoder.hpp"
#include "tests/decoder/vector_file.h"

namespace gim {
namespace {

using Bytes = std::vector<uint8_t>;

using test::vector_file;

Bytes labels_of(const Bytes& file, uint32_t image, uint32_t level) {
    Decoder decoder;
    DecoderLevel of;
    EXPECT_EQ(decoder.open(file), GIM_OK);
    EXPECT_EQ(decoder.read_level(image, level, &of), GIM_OK);
    Bytes labels(of.triangle_count / 2);
    EXPECT_EQ(decoder.labels(of, labels), GIM_OK);
    return labels;
}

// Labels of a coarse level, taken from squares of side x side cells of level 0.
Bytes coarser(const Bytes& fine, uint32_t side, uint32_t level) {
    const uint32_t step = 1u << level;
    Bytes labels;
    for (size_t square = 0; square < fine.size(); square += size_t{side} * side)
        for (uint32_t r = step / 2; r < side; r += step)
            for (uint32_t c = step / 2; c < side; c += step) labels.push_back(fine[square + size_t{r} * side + c]);
    return labels;
}

TEST(ReadLabels, CoarseCellsHaveTheLabelBehindTheirMiddle) {
    const Bytes sphere = vector_file("labels-sphere-17"), cube = vector_file("labels-tiles-cube"),
                cut = vector_file("labels-cut-tiles");
    EXPECT_EQ(labels_of(sphere, 0, 1), coarser(labels_of(sphere, 0, 0), 16, 1));
    EXPECT_EQ(labels_of(sphere, 0, 1).size(), 64u);
    EXPECT_EQ(labels_of(cube, 0, 1), coarser(labels_of(cube, 0, 0), 8, 1));
    EXPECT_EQ(labels_of(cut, 0, 0), coarser(labels_of(cube, 0, 0), 8, 2));
}

TEST(ReadLabels, ImagesHaveTheirOwn) {
    const Bytes file = vector_file("labels-two-images");
    const Bytes first = labels_of(file, 0, 0), second = labels_of(file, 1, 0);
    EXPECT_EQ(first.size(), 1024u);
    EXPECT_EQ(second.size(), 64u);
    EXPECT_NE(Bytes(first.begin(), first.begin() + 64), second);
}

TEST(ReadLabels, FilesWithoutLabelsSaySo) {
    Decoder decoder;
    DecoderLevel level;
    const Bytes file = vector_file("sphere-17-lossless");
    ASSERT_EQ(decoder.open(file), GIM_OK);
    ASSERT_EQ(decoder.read_level(0, 0, &level), GIM_OK);
    Bytes labels(256);
    EXPECT_EQ(decoder.labels(level, labels), GIM_NO_SUCH_PLANE);
}

TEST(ReadLabels, WrongArgumentsAreRefused) {
    const Bytes file = vector_file("labels-sphere-17");
    gim_info info;
    ASSERT_EQ(gim_read_info(file.data(), file.size(), nullptr, &info), GIM_OK);
    gim_labels_info of;
    ASSERT_EQ(gim_read_labels_info(&info, file.data(), file.size(), 0, 0, &of), GIM_OK);
    EXPECT_EQ(of.cell_count, 256u);
    EXPECT_EQ(gim_read_labels_info(&info, file.data(), file.size(), 1, 0, &of), GIM_BAD_ARGUMENT);
    EXPECT_EQ(gim_read_labels_info(&info, file.data(), file.size(), 0, 9, &of), GIM_NO_SUCH_LEVEL);
    EXPECT_EQ(gim_read_labels_info(&info, file.data(), file.size(), 0, 0, nullptr), GIM_BAD_ARGUMENT);
    Bytes labels(of.cell_count), scratch(static_cast<size_t>(of.scratch_size));
    const auto decode = [&](uint8_t* out, void* work, size_t work_size, size_t size) {
        return gim_decode_labels(&info, file.data(), size, 0, 0, out, work, work_size);
    };
    EXPECT_EQ(decode(nullptr, scratch.data(), scratch.size(), file.size()), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(labels.data(), nullptr, 0, file.size()), GIM_BAD_ARGUMENT);
    EXPECT_EQ(decode(labels.data(), scratch.data(), scratch.size() - 1, file.size()), GIM_SCRATCH_TOO_SMALL);
    EXPECT_EQ(decode(labels.data(), scratch.data(), scratch.size(), static_cast<size_t>(of.prefix_size) - 1),
              GIM_NEED_MORE_INPUT);
    EXPECT_EQ(decode(labels.data(), scratch.data(), scratch.size(), static_cast<size_t>(of.prefix_size)), GIM_OK);
}

}  // namespace
}  // namespace gim
