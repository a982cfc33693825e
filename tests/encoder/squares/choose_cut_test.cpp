#include "encoder/squares/choose_cut.h"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include "corpus/generators.h"
#include "encoder/squares/coding_trial.h"
#include "encoder/surface/clean.h"

namespace gim {
namespace {

EncodeOptions options_for(RateTarget rate) {
    EncodeOptions options;
    options.side = 33;
    options.node_side = 5;
    options.rate = rate;
    return options;
}

Mesh blob() { return clean(corpus::limbed_blob(24)).value().mesh; }

TEST(ChooseCut, TheChosenImageCostsNoMoreThanTheUsualOne) {
    const Mesh mesh = blob();
    for (const RateTarget rate : {RateTarget{RateTarget::Kind::kPsnr, 40}, RateTarget{RateTarget::Kind::kBytes, 700}}) {
        const EncodeOptions options = options_for(rate);
        ASSERT_TRUE(may_choose_cut(options));
        StageClock clock({});
        const auto chosen = choose_cut(mesh, options, clock);
        ASSERT_TRUE(chosen);
        const MadeSquare usual = make_square(mesh, options, {}, clock).value();
        const CodingTrial trial(mesh, options, usual.image);
        EXPECT_LE(trial.log_bytes(chosen->square.image).value(), trial.log_bytes(usual.image).value());
        const MadeSquare again = make_square(mesh, options, chosen->preference, clock).value();
        EXPECT_EQ(again.image.positions, chosen->square.image.positions);
    }
}

TEST(ChooseCut, SameChoiceOnOneThread) {
    const Mesh mesh = blob();
    const EncodeOptions options = options_for({RateTarget::Kind::kPsnr, 40});
    StageClock clock({});
    const auto many = choose_cut(mesh, options, clock);
    tbb::task_arena one(1);
    const auto single = one.execute([&] { return choose_cut(mesh, options, clock); });
    EXPECT_EQ(many->preference, single->preference);
    EXPECT_EQ(many->square.image.positions, single->square.image.positions);
}

TEST(ChooseCut, IsForTargetsThatAFitCanMeet) {
    EXPECT_FALSE(may_choose_cut(options_for({RateTarget::Kind::kLossless, 0})));
    EXPECT_FALSE(may_choose_cut(options_for({RateTarget::Kind::kQuality, 50})));
    EncodeOptions plain = options_for({RateTarget::Kind::kPsnr, 40});
    plain.fit = FitStrength::kOff;
    EXPECT_FALSE(may_choose_cut(plain));
}

}  // namespace
}  // namespace gim
