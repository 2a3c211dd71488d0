// Two settings of the numerics: the corrected moments hold their intervals whatever the bias of the cheap one is.
#include "stats/two_levels.hpp"
#include "tests/support/two_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace grainsweep::tests::stats_two_levels_test {

using stats::Statistic;

// 200 campaigns of each: bench/two_levels_slow.cpp.
TEST(TwoLevels, StatedErrorsHoldOverCampaignsOfEachResponse) {
    constexpr int campaigns = 40, least = 37;
    for (const auto& response : known_responses()) {
        if (response.name == "noise" || response.name == "waves") continue;  // sd of noise alone needs all points
        const auto found = cover({.expensive = response, .common = 0.9}, {Statistic::mean}, 0.03, campaigns);
        const auto figures = found.figures(response.name);
        RecordProperty(response.name, figures);
        EXPECT_GE(found.mean_held, least) << figures;
        EXPECT_GE(found.within_goal, least) << figures;
        EXPECT_GT(found.alone, 1) << figures;
    }
}

TEST(TwoLevels, TheCheapSettingAloneIsOffByItsBias) {
    const auto response = known_responses().front();
    const TwoSettings settings{.expensive = response};
    const TwoSettingsCampaign campaign(settings, 1024, 1);
    const auto cheap = campaign.cheap(1024), expensive = campaign.expensive(256);
    const double truth = true_statistics(response, true)[0];
    const auto alone = stats::two_level_moment(Statistic::mean, {cheap, {}, 8, campaign.points(1024)});
    const auto corrected = stats::two_level_moment(Statistic::mean, {cheap, expensive, 8, campaign.points(1024)});
    EXPECT_GT(std::abs(alone.value - truth), 3 * alone.together);
    EXPECT_EQ(alone.numerics, 0);
    EXPECT_EQ(alone.value, corrected.cheap);
    EXPECT_LT(std::abs(corrected.value - truth), corrected.together);
    EXPECT_GE(corrected.together, std::hypot(corrected.numerics, corrected.statistics));
}

TEST(TwoLevels, EqualPairsSayNothingOfTheNumerics) {
    std::vector<double> cheap;
    for (int i = 0; i < 64; ++i) cheap.push_back(std::sin(i));
    const std::vector<double> equal(cheap.begin(), cheap.begin() + 32);
    const auto check = stats::two_level_check({{Statistic::mean}, 0.5, 640, 10}, {cheap, equal, 8});
    EXPECT_TRUE(std::isnan(check.moments[0].numerics));
    EXPECT_FALSE(check.passes);
    EXPECT_EQ(check.next_points, 128);
    EXPECT_EQ(check.next_pairs, 64);
}

TEST(TwoLevels, ValuesThatAreMissingAreLeftOut) {
    std::vector<double> cheap, expensive;
    for (int i = 0; i < 64; ++i) cheap.push_back(std::cos(i));
    for (int i = 0; i < 32; ++i) expensive.push_back(std::cos(i) + 0.1 * std::sin(3 * i));
    const auto full = stats::two_level_moment(Statistic::mean, {cheap, expensive, 8});
    expensive[5] = std::nan("");
    const auto less = stats::two_level_moment(Statistic::mean, {cheap, expensive, 8});
    EXPECT_EQ(less.cheap, full.cheap);
    EXPECT_NE(less.value, full.value);
    EXPECT_TRUE(std::isfinite(less.together));
}

TEST(TwoLevels, SizesNeverExceedTheDesignAndEndThere) {
    std::vector<double> cheap, expensive;
    for (int i = 0; i < 100; ++i) cheap.push_back(std::cos(i));
    for (int i = 0; i < 100; ++i) expensive.push_back(std::cos(i) + 0.1 * std::sin(3 * i));
    const stats::TwoLevelRule rule{{Statistic::mean}, 1e-6, 100, 10};
    const auto before = stats::two_level_check(rule, {cheap, std::span(expensive).first(40), 8});
    EXPECT_EQ(before.next_points, 100);
    EXPECT_EQ(before.next_pairs, 80);
    EXPECT_FALSE(before.last());
    EXPECT_TRUE(stats::two_level_check(rule, {cheap, expensive, 8}).last());
}

TEST(TwoLevels, APilotChoosesPairsWhereTheyCostLess) {
    std::vector<double> close, far, reference;
    for (int i = 0; i < 16; ++i) {
        reference.push_back(2 + std::cos(i));
        close.push_back(2.1 + 1.02 * std::cos(i) + 0.01 * std::sin(7 * i));
        far.push_back(2 + std::cos(5 * i + 1));
    }
    const auto chosen = [&](double close_cost, double far_cost) {
        const stats::TwoLevelRule rule{{Statistic::mean, Statistic::sd}, 0.01, 100'000, 1};
        return stats::cheapest_level(rule, {{{far, far_cost}, {close, close_cost}, {reference, 10}}, 8, {}});
    };
    EXPECT_EQ(chosen(1, 0.5), 1U) << "one that follows the measure";
    EXPECT_EQ(chosen(9.9, 0.5), 2U) << "one that saves nothing needs no pairs";
    EXPECT_EQ(chosen(9.9, 1e-9), 2U) << "one that does not predict the measure";
}

TEST(TwoLevels, PairsAreGivenUpWhereTheExpensiveAloneCostsLess) {
    std::vector<double> far, close, reference;
    for (int i = 0; i < 64; ++i) {
        const double own = 2 + 0.2 * std::cos(37 * i);
        if (i < 32) reference.push_back(own);
        close.push_back(own + 0.1 + 0.001 * std::sin(23 * i));
        far.push_back(2 + 0.2 * std::cos(53 * i + 1));
    }
    const auto gives_up = [&](const std::vector<double>& cheap, double cost_ratio) {
        return stats::alone_costs_less({{Statistic::mean}, 0.01, 100'000, cost_ratio}, {cheap, reference, 8});
    };
    EXPECT_FALSE(gives_up(close, 10)) << "a cheap setting that predicts";
    EXPECT_TRUE(gives_up(far, 10)) << "one that does not";
    EXPECT_TRUE(gives_up(std::vector<double>(64, 2.0), 1e9)) << "one that is constant";
    auto equal = far;
    std::ranges::copy(reference, equal.begin());
    EXPECT_TRUE(gives_up(equal, 10)) << "pairs that are all equal never tell the numerics";
}

TEST(TwoLevels, PilotAndLaterChecksPredictTheSameCosts) {
    std::vector<double> cheap, reference;
    for (int i = 0; i < 16; ++i) {
        reference.push_back(2 + std::cos(i));
        cheap.push_back(2.1 + std::cos(i) + 0.1 * std::sin(7 * i));
    }
    bool both[2] = {false, false};
    for (double ratio = 1; ratio < 1000; ratio *= 1.3) {
        const stats::TwoLevelRule rule{{Statistic::mean}, 0.01, 100'000, ratio};
        const bool alone = stats::alone_costs_less(rule, {cheap, reference, 8});
        EXPECT_EQ(stats::cheapest_level(rule, {{{cheap, 1}, {reference, ratio}}, 8, {}}), alone ? 1U : 0U) << ratio;
        both[alone ? 1 : 0] = true;
    }
    EXPECT_TRUE(both[0] && both[1]) << "the price decides";
}

/// A response that is a line over the factor, which evenly spread points integrate, and a little scatter; the cheap one
/// scatters by itself.
TEST(TwoLevels, APilotCountsTheScatterThatEvenlySpreadPointsLeave) {
    std::vector<double> cheap, reference, factor;
    for (int i = 0; i < 16; ++i) {
        factor.push_back((i + 0.5) / 16);
        reference.push_back(1 + factor.back() + 0.05 * std::sin(3 * i));
        cheap.push_back(1 + factor.back() + 0.05 * std::sin(5 * i + 2));
    }
    const stats::TwoLevelRule rule{{Statistic::mean}, 0.01, 100'000, 1};
    EXPECT_EQ(stats::cheapest_level(rule, {{{cheap, 0.1}, {reference, 1}}, 8, {factor, 1}}), 1U);
    EXPECT_EQ(stats::cheapest_level(rule, {{{cheap, 0.1}, {reference, 1}}, 8, {}}), 0U)
        << "as independent points, the line would count as scatter";
}

TEST(TwoLevels, ADifferenceThatIsSmoothIsLearned) {
    std::vector<double> cheap, expensive, points;
    for (int i = 0; i < 256; ++i) {
        const double x = std::fmod(0.5 + 0.618'033'988'75 * i, 1);
        points.push_back(x);
        cheap.push_back(1 + std::cos(3 * x));
        if (i < 32) expensive.push_back(cheap.back() - 0.1 * std::sin(6 * x));
    }
    const double truth = 1 + std::sin(3.0) / 3 - 0.1 * (1 - std::cos(6.0)) / 6;
    const auto learned = stats::two_level_moment(Statistic::mean, {cheap, expensive, 8, {points, 1}});
    const auto plain = stats::two_level_moment(Statistic::mean, {cheap, expensive, 8, {}});
    EXPECT_EQ(learned.by, stats::PairPredictor::model) << to_string(learned.by);
    EXPECT_LT(learned.numerics, 0.1 * plain.numerics);
    EXPECT_LE(std::abs(learned.value - truth), learned.together);
}

/// Too many pairs for the model, and a difference that is no line.
TEST(TwoLevels, ADifferenceWithSquaresIsLearnedFromManyPairs) {
    std::vector<double> cheap, expensive, points;
    for (int i = 0; i < 1024; ++i) {
        const double x = std::fmod(0.5 + 0.618'033'988'75 * i, 1);
        points.push_back(x);
        cheap.push_back(1 + std::cos(3 * x));
        if (i < 640) expensive.push_back(cheap.back() - 0.1 * x * (1 - x) + 0.001 * std::sin(29 * i));
    }
    const double truth = 1 + std::sin(3.0) / 3 - 0.1 / 6;
    const auto learned = stats::two_level_moment(Statistic::mean, {cheap, expensive, 8, {points, 1}});
    EXPECT_EQ(learned.by, stats::PairPredictor::squares) << to_string(learned.by);
    EXPECT_LE(std::abs(learned.value - truth), learned.together);
    EXPECT_LT(learned.numerics, 2e-4);
}

TEST(TwoLevels, PairsThatDoNotPredictLeaveTheExpensiveMean) {
    std::vector<double> cheap, expensive;
    for (int i = 0; i < 128; ++i) cheap.push_back(std::sin(37 * i));
    for (int i = 0; i < 64; ++i) expensive.push_back(3 + std::cos(23 * i * i));
    const auto found = stats::two_level_moment(Statistic::mean, {cheap, expensive, 8});
    EXPECT_EQ(found.by, stats::PairPredictor::slope);
    EXPECT_NEAR(found.value, stats::summarise(expensive).mean, 0.1);
    EXPECT_LT(found.numerics, 0.3);
}

TEST(TwoLevels, PairsWithinHalfTheToleranceAreNotRefined) {
    std::vector<double> cheap, expensive;
    for (int i = 0; i < 64; ++i) cheap.push_back(1 + 0.1 * std::sin(37 * i));
    for (int i = 0; i < 16; ++i)
        expensive.push_back(cheap[static_cast<std::size_t>(i)] + 0.003 + 0.005 * std::sin(11 * i));
    const stats::TwoLevelRule rule{{Statistic::mean}, 0.05, 640, 10};
    const auto check = stats::two_level_check(rule, {cheap, expensive, 8});
    EXPECT_TRUE(check.passes);
    EXPECT_EQ(check.next_points, 72);
    EXPECT_EQ(check.next_pairs, 16);
}

}  // namespace grainsweep::tests::stats_two_levels_test
