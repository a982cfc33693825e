// Borders and zippers through the coder and back, and compared with a second writer of the same bits.
#include "format/chart_border.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <string>

#include "decoder/pyramid/range_decoder.h"
#include "encoder/code/range_encoder.h"
#include "format/chart_table.h"
#include "tests/format/random_sideband.h"
#include "tests/format/raw_chart_table.h"

namespace gim {
namespace {

using test::Random;
using Bytes = std::vector<uint8_t>;
using Glued = std::vector<std::pair<uint32_t, uint32_t>>;

struct Walk {
    uint32_t columns = 2, rows = 2;
    std::vector<uint32_t> samples;
    std::string directions;
};

// A closed walk that never turns back: an octagon whose long sides zigzag here and there. The box has room to spare.
Walk random_walk(Random& random) {
    std::array<uint32_t, 4> counts{};
    while (std::count(counts.begin(), counts.end(), 0u) > 2) {
        for (uint32_t& n : counts) n = random.below(3) == 0 ? 0 : random.below(9);
    }
    Walk walk;
    for (uint32_t d = 0; d < 8; ++d) {
        const uint32_t n = counts[d % 4];
        for (uint32_t k = 0; k < n; ++k) {
            const bool zigzag = d % 2 == 0 && k > 0 && k + 2 < n && random.below(3) == 0;
            walk.directions += static_cast<char>('0' + (zigzag ? (d + 1) % 8 : d));
            if (zigzag) walk.directions += static_cast<char>('0' + (d + 7) % 8), ++k;
        }
    }
    std::rotate(walk.directions.begin(),
                walk.directions.begin() + random.below(static_cast<uint32_t>(walk.directions.size())),
                walk.directions.end());
    int32_t column = 0, row = 0;
    std::vector<std::array<int32_t, 2>> points;
    std::array<int32_t, 2> low{}, high{};
    for (const char c : walk.directions) {
        points.push_back({column, row});
        low = {std::min(low[0], column), std::min(low[1], row)};
        high = {std::max(high[0], column), std::max(high[1], row)};
        column += kDirections[static_cast<size_t>(c - '0')][0];
        row += kDirections[static_cast<size_t>(c - '0')][1];
    }
    EXPECT_TRUE(column == 0 && row == 0);
    walk.columns = static_cast<uint32_t>(high[0] - low[0]) + 1 + random.below(3);
    walk.rows = static_cast<uint32_t>(high[1] - low[1]) + 1 + random.below(3);
    walk.columns = std::max(walk.columns, 2u);
    walk.rows = std::max(walk.rows, 2u);
    for (const auto& p : points)
        walk.samples.push_back(static_cast<uint32_t>(p[1] - low[1]) * walk.columns +
                               static_cast<uint32_t>(p[0] - low[0]));
    return walk;
}

// Charts with their paths. Zippers belong to second paths, as in a file.
struct Level {
    std::vector<Walk> walks;
    std::vector<uint32_t> path_counts;
    std::vector<BorderPath> paths;
    std::vector<std::vector<ZipStep>> zippers;
};

// like: has the numbers of charts and paths, and the mates, if it is not null.
Level random_level(Random& random, const Level* like = nullptr) {
    Level level;
    const size_t charts = like ? like->walks.size() : 1 + random.below(5);
    for (uint32_t c = 0; c < charts; ++c) {
        Walk walk = random_walk(random);
        while (like && walk.samples.size() < like->path_counts[c]) walk = random_walk(random);
        level.walks.push_back(std::move(walk));
        const auto length = static_cast<uint32_t>(level.walks[c].samples.size());
        const uint32_t count = like ? like->path_counts[c] : 1 + random.below(std::min(length, 5u));
        level.path_counts.push_back(count);
        uint32_t left = length;
        for (uint32_t k = 0; k < count; ++k) {
            const uint32_t most = left - (count - 1 - k);
            const uint32_t n = k + 1 == count ? left : 1 + random.below(most);
            level.paths.push_back({kNoMate, n, 0, c, 0, 0});
            left -= n;
        }
    }
    for (uint32_t p = 0; like && p < level.paths.size(); ++p) level.paths[p].mate = like->paths[p].mate;
    for (uint32_t p = 0; !like && p < level.paths.size(); ++p) {
        const uint32_t q = random.below(static_cast<uint32_t>(level.paths.size()));
        if (q >= p || level.paths[p].mate != kNoMate || level.paths[q].mate != kNoMate) continue;
        level.paths[p].mate = q;
        level.paths[q].mate = p;
    }
    for (uint32_t p = 0; p < level.paths.size(); ++p) {
        if (level.paths[p].mate >= p) continue;
        std::vector<ZipStep> steps;
        uint32_t a = level.paths[level.paths[p].mate].length, b = level.paths[p].length;
        while (a > 0 || b > 0) {
            const auto step = a == 0   ? ZipStep::kSecond
                              : b == 0 ? ZipStep::kFirst
                                       : static_cast<ZipStep>(random.below(2) * random.below(3));
            a -= step != ZipStep::kSecond;
            b -= step != ZipStep::kFirst;
            steps.push_back(step);
        }
        level.zippers.push_back(steps);
    }
    return level;
}

// Runs either direction. A decoder fills in the level, and `glued` from its zippers. Returns false on bad bytes. coarse:
// the next coarser level, or null.
template <class Coder>
bool code(Coder& coder, BorderModels& models, Level& level, Glued* glued, const Level* coarse = nullptr) {
    BorderCoder<Coder> border_coder(&coder, &models);
    uint32_t first_path = 0;
    size_t zipper = 0;
    for (size_t c = 0; c < level.walks.size(); ++c) {
        Walk& walk = level.walks[c];
        BorderChart chart;
        chart.columns = walk.columns;
        chart.rows = walk.rows;
        chart.first_path = first_path;
        chart.path_count = level.path_counts[c];
        chart.border_length = static_cast<uint32_t>(walk.samples.size());
        // Exactly the promised room, so that sanitizers notice one sample too many.
        std::vector<uint32_t> samples(size_t{walk.columns} * walk.rows);
        std::copy_n(walk.samples.begin(), std::min(walk.samples.size(), samples.size()), samples.begin());
        chart.samples = samples.data();
        if (coarse) {
            chart.coarse = coarse->walks[c].samples.data();
            chart.coarse_columns = coarse->walks[c].columns;
            chart.coarse_border_length = static_cast<uint32_t>(coarse->walks[c].samples.size());
            for (uint32_t p = first_path; p < first_path + chart.path_count; ++p) {
                level.paths[p].coarse_length = coarse->paths[p].length;
                level.paths[p].coarse_first = coarse->paths[p].first;
            }
        }
        if (!border_coder.code_border(chart, level.paths.data())) return false;
        walk.samples.assign(samples.begin(), samples.begin() + std::min<size_t>(chart.border_length, samples.size()));
        for (uint32_t p = first_path; p < first_path + chart.path_count; ++p) {
            if (level.paths[p].mate >= p) continue;
            std::vector<ZipStep> none;
            auto step = Coder::kWrites ? level.zippers[zipper].begin() : none.begin();
            if (!border_coder.code_zipper(
                    level.paths[level.paths[p].mate], level.paths[p], [&] { return *step++; },
                    [&](uint32_t i, uint32_t j) {
                        if (glued) glued->push_back({i, j});
                    }))
                return false;
            ++zipper;
        }
        first_path += chart.path_count;
    }
    return true;
}

// What a decoder knows before it reads borders.
Level without_borders(Level level) {
    for (Walk& walk : level.walks) walk.samples.clear();
    for (BorderPath& path : level.paths) path = {path.mate, 0, 0, path.chart, 0, 0};
    return level;
}

// The same borders with two steps for each one. Zippers go on along both sides wherever they can.
Level doubled(const Level& level) {
    Level twice = level;
    for (Walk& walk : twice.walks) {
        const std::vector<uint32_t> samples = std::move(walk.samples);
        const uint32_t columns = walk.columns;
        walk.columns = 2 * columns - 1;
        walk.rows = 2 * walk.rows - 1;
        walk.samples.clear();
        for (size_t k = 0; k < samples.size(); ++k) {
            const uint32_t a = samples[k], b = samples[(k + 1) % samples.size()];
            walk.samples.push_back(2 * (a / columns) * walk.columns + 2 * (a % columns));
            walk.samples.push_back((a / columns + b / columns) * walk.columns + a % columns + b % columns);
        }
        std::string directions;
        for (const char d : walk.directions) directions += {d, d};
        walk.directions = directions;
    }
    for (BorderPath& path : twice.paths) path.length *= 2;
    size_t zipper = 0;
    for (uint32_t p = 0; p < twice.paths.size(); ++p) {
        if (twice.paths[p].mate >= p) continue;
        const uint32_t a = twice.paths[twice.paths[p].mate].length, b = twice.paths[p].length;
        std::vector<ZipStep>& steps = twice.zippers[zipper++];
        steps.assign(std::min(a, b), ZipStep::kBoth);
        steps.insert(steps.end(), std::max(a, b) - std::min(a, b), a > b ? ZipStep::kFirst : ZipStep::kSecond);
    }
    return twice;
}

// Two levels, as in a file: the coarser one guides the other.
struct TwoLevels {
    Level coarse, fine;
};

TwoLevels random_levels(Random& random) {
    TwoLevels levels;
    levels.fine = random_level(random);
    levels.coarse = random_level(random, &levels.fine);
    return levels;
}

template <class Coder>
bool code(Coder& coder, TwoLevels& levels, Glued* glued) {
    BorderModels models;
    return code(coder, models, levels.coarse, glued) && code(coder, models, levels.fine, glued, &levels.coarse);
}

Bytes encoded(TwoLevels levels, Glued* glued) {
    RangeEncoder encoder;
    EXPECT_TRUE(code(encoder, levels, glued));
    return encoder.finish();
}

TwoLevels without_borders(const TwoLevels& levels) {
    return {without_borders(levels.coarse), without_borders(levels.fine)};
}

void expect_equal(const Level& a, const Level& b) {
    for (size_t c = 0; c < a.walks.size(); ++c) ASSERT_EQ(b.walks[c].samples, a.walks[c].samples);
    for (size_t p = 0; p < a.paths.size(); ++p) ASSERT_EQ(b.paths[p].length, a.paths[p].length);
}

TEST(ChartBorder, RandomBordersAndZippersComeBack) {
    Random random(1);
    for (int round = 0; round < 300; ++round) {
        const TwoLevels levels = random_levels(random);
        Glued written, read;
        const Bytes bytes = encoded(levels, &written);
        TwoLevels back = without_borders(levels);
        RangeDecoder decoder(bytes);
        ASSERT_TRUE(code(decoder, back, &read)) << round;
        EXPECT_TRUE(decoder.intact());
        expect_equal(levels.coarse, back.coarse);
        expect_equal(levels.fine, back.fine);
        ASSERT_EQ(read, written);
    }
}

void write_raw(const Level& level, const Level* coarse, test::RawBorderWriter& writer) {
    uint32_t p = 0;
    size_t zipper = 0;
    for (size_t c = 0; c < level.walks.size(); ++c) {
        const Walk& walk = level.walks[c];
        const uint32_t first = p, column = walk.samples[0] % walk.columns, row = walk.samples[0] / walk.columns;
        if (coarse) {
            std::vector<std::array<int64_t, 2>> guide;
            for (const uint32_t i : coarse->walks[c].samples)
                guide.push_back({i % coarse->walks[c].columns, i / coarse->walks[c].columns});
            writer.begin_guided_chart(column, row, guide);
        } else {
            writer.begin_chart(walk.columns, walk.rows, column, row);
        }
        size_t done = 0;
        for (; p < first + level.path_counts[c]; ++p) {
            const BorderPath& path = level.paths[p];
            if (coarse) {
                writer.guided_length(path.length, coarse->paths[p].length, path.mate < p);
            } else if (path.mate < p) {
                writer.length_of_second(path.length, level.paths[path.mate].length);
            } else {
                writer.length(path.length);
            }
            writer.steps(walk.directions.substr(done, path.length));
            done += path.length;
        }
        for (uint32_t q = first; q < p; ++q) {
            if (level.paths[q].mate >= q) continue;
            std::string steps;
            for (const ZipStep step : level.zippers[zipper]) steps += static_cast<char>('0' + static_cast<int>(step));
            writer.zipper(level.paths[level.paths[q].mate].length, level.paths[q].length, steps);
            ++zipper;
        }
    }
}

TEST(ChartBorder, BytesAreThoseOfTheText) {
    Random random(2);
    for (int round = 0; round < 100; ++round) {
        const TwoLevels levels = random_levels(random);
        RangeEncoder encoder;
        test::RawBorderWriter writer(&encoder);
        write_raw(levels.coarse, nullptr, writer);
        write_raw(levels.fine, &levels.coarse, writer);
        ASSERT_EQ(encoder.finish(), encoded(levels, nullptr)) << round;
    }
}

// A border costs little where it follows that of the coarser level.
TEST(ChartBorder, AGuideSavesHalf) {
    Random random(4);
    size_t alone = 0, guided = 0;
    for (int round = 0; round < 100; ++round) {
        TwoLevels levels;
        levels.coarse = random_level(random);
        levels.fine = doubled(levels.coarse);
        RangeEncoder one;
        BorderModels models;
        ASSERT_TRUE(code(one, models, levels.coarse, nullptr));
        const size_t coarse = one.finish().size();
        RangeEncoder two;
        BorderModels fresh;
        ASSERT_TRUE(code(two, fresh, levels.fine, nullptr));
        alone += two.finish().size();
        guided += encoded(levels, nullptr).size() - coarse;
    }
    EXPECT_LT(2 * guided, alone);
}

TEST(ChartBorder, DamagedStreamsStayInBounds) {
    Random random(3);
    const auto check = [](const TwoLevels& levels, const Bytes& bytes) {
        TwoLevels back = without_borders(levels);
        RangeDecoder decoder(bytes);
        Glued glued;
        if (!code(decoder, back, &glued)) return;
        for (const Level* level : {&back.coarse, &back.fine}) {
            for (const Walk& walk : level->walks) {
                ASSERT_GE(walk.samples.size(), 3u);
                for (const uint32_t i : walk.samples) ASSERT_LT(i, walk.columns * walk.rows);
            }
        }
    };
    for (int round = 0; round < 60; ++round) {
        const TwoLevels levels = random_levels(random);
        const Bytes whole = encoded(levels, nullptr);
        for (size_t n = 0; n < whole.size(); ++n)
            check(levels, {whole.begin(), whole.begin() + static_cast<ptrdiff_t>(n)});
        for (size_t bit = 0; bit < whole.size() * 8; ++bit) {
            Bytes bytes = whole;
            bytes[bit / 8] ^= static_cast<uint8_t>(1 << bit % 8);
            check(levels, bytes);
        }
    }
    for (int round = 0; round < 300; ++round) {
        const TwoLevels levels = random_levels(random);
        Bytes noise(random.below(80));
        for (uint8_t& b : noise) b = static_cast<uint8_t>(random.below(256));
        check(levels, noise);
    }
}

// A box of 4 x 3, one path or two.
bool accepted(const std::function<void(test::RawBorderWriter&)>& write, std::vector<uint32_t> mates = {kNoMate}) {
    RangeEncoder encoder;
    test::RawBorderWriter writer(&encoder);
    write(writer);
    const Bytes bytes = encoder.finish();
    Level level;
    level.walks = {{4, 3, {}, ""}};
    level.path_counts = {static_cast<uint32_t>(mates.size())};
    for (const uint32_t mate : mates) level.paths.push_back({mate, 0, 0, 0, 0, 0});
    RangeDecoder decoder(bytes);
    BorderModels models;
    return code(decoder, models, level, nullptr) && decoder.intact();
}

TEST(ChartBorder, WhatIsNoBorderIsRefused) {
    using Writer = test::RawBorderWriter;
    const auto walk = [](uint32_t column, uint32_t row, const std::string& directions) {
        return [=](Writer& w) {
            w.begin_chart(4, 3, column, row);
            w.length(static_cast<uint32_t>(directions.size()));
            w.steps(directions);
        };
    };
    EXPECT_TRUE(accepted(walk(0, 0, "0002244466")));
    EXPECT_FALSE(accepted(walk(0, 0, "035")));               // ends elsewhere
    EXPECT_TRUE(accepted(walk(1, 1, "036")));                // three samples
    EXPECT_FALSE(accepted(walk(0, 3, "036")));               // begins outside the box
    EXPECT_FALSE(accepted(walk(1, 1, "0002244466")));        // leaves it on the right,
    EXPECT_FALSE(accepted(walk(0, 1, "0002244466")));        // at the high end,
    EXPECT_FALSE(accepted(walk(0, 0, "6000224442")));        // at the low end,
    EXPECT_FALSE(accepted(walk(1, 0, "0244440660")));        // on the left
    EXPECT_FALSE(accepted(walk(0, 0, "000224446")));         // not closed
    EXPECT_TRUE(accepted(walk(0, 0, "024602460246")));       // as long as the box has samples: still valid
    EXPECT_FALSE(accepted(walk(0, 0, "0246024602460246")));  // longer
    const auto two = [](uint32_t first, uint32_t coded) {
        return [=](Writer& w) {
            w.begin_chart(4, 3, 0, 0);
            w.length(first);
            w.steps(std::string("0002244466").substr(0, first));
            w.number_of_second(coded);
            w.steps(std::string("0002244466").substr(std::min(first, 10u)));
            w.zipper(5, 5, "00000");
        };
    };
    EXPECT_TRUE(accepted(two(5, 0), {1, 0}));
    EXPECT_FALSE(accepted(two(5, 10), {1, 0}));              // 5 - 5
    EXPECT_FALSE(accepted(two(5, 12), {1, 0}));              // 5 - 6
    EXPECT_FALSE(accepted(two(5, 5), {1, 0}));               // 5 + 3: one more than the box has samples
    EXPECT_FALSE(accepted(two(5, (1u << 25) - 2), {1, 0}));  // the greatest number
    EXPECT_FALSE(accepted(two(5, (1u << 25) - 1), {1, 0}));  // one more
    EXPECT_FALSE(accepted([](Writer& w) {
        w.begin_chart(4, 3, 0, 0);
        w.length((1u << 25) - 1);
    }));
}

}  // namespace
}  // namespace gim
