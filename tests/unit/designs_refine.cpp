#include "sweep/designs/refine.hpp"

#include "stats/random.hpp"
#include "tests/support/ask_design.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace grainsweep::tests::designs_refine_test {

using designs::Bracket;
using designs::DesignRequest;
using ::testing::ElementsAre;

double uniform_at(std::uint64_t seed, std::uint64_t stream, std::uint64_t counter) {
    return stats::to_unit(stats::bits_at(seed, stream, counter));
}

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// A factor from 10 to 90 along which "y" passes a threshold, and others with levels.
DesignRequest request(std::vector<std::size_t> levels, double threshold, double width, std::int64_t replicates = 1) {
    DesignRequest asked{.levels = levels,
                        .options = {{"factor", std::string("f0")},
                                    {"observable", std::string("y")},
                                    {"threshold", threshold},
                                    {"width", width},
                                    {"replicates", replicates}}};
    for (std::size_t j = 0; j < levels.size(); ++j) {
        auto& factor = asked.factors.emplace_back();
        factor.name = "f" + std::to_string(j);
        factor.range = designs::Between{10, 90};
        if (levels[j] > 0) factor.range = designs::Levels{std::vector<Value>(levels[j], 0.0)};
    }
    return asked;
}

const designs::DesignInfo& refine() {
    return designs::design_named("refine");
}

/// Answers round by round until nothing is asked any more; returns how many rounds there were.
int run(DesignRequest& asked, const std::function<double(std::span<const double>, std::uint32_t, std::uint32_t)>& y) {
    for (int rounds = 0;; ++rounds) {
        const auto points = refine().sample(asked);
        auto& answers = asked.answers["y"];
        if (points.size() == answers.size()) return rounds;
        for (std::size_t p = answers.size(); p < points.size(); ++p)
            answers.emplace_back(y(points.point(p), points.part[p], points.repeat[p]));
    }
}

double step(double u, double at) {
    return u < at ? 0.0 : 1.0;
}

TEST(Refine, BracketsAStepInNineRunsToOnePartIn128) {
    for (const double at : {0.003, 0.25, 0.3337, 0.77, 0.999}) {
        auto asked = request({0}, 0.5, 80.0 / 128);
        EXPECT_EQ(run(asked, [&](auto u, auto, auto) { return step(u[0], at); }), 8);
        const auto found = designs::brackets(asked).at(0);
        EXPECT_EQ(found.state, Bracket::State::found);
        EXPECT_EQ(found.runs, 9U);
        EXPECT_LT(found.low.coordinate, at);
        EXPECT_GE(found.high.coordinate, at);
        EXPECT_NEAR(found.high.value - found.low.value, 80.0 / 128, 1e-12);
    }
}

TEST(Refine, ALaterRoundLeavesThePointsOfTheEarlierOnesWhereTheyWere) {
    auto asked = request({0, 3}, 0.5, 1, 4);
    designs::PointSet before;
    for (;;) {
        const auto points = refine().sample(asked);
        ASSERT_GE(points.size(), before.size());
        for (std::size_t p = 0; p < before.size(); ++p) {
            EXPECT_EQ(points.point(p)[0], before.point(p)[0]);
            EXPECT_EQ(points.part[p], before.part[p]);
            EXPECT_EQ(points.repeat[p], before.repeat[p]);
        }
        if (points.size() == before.size()) break;
        for (std::size_t p = before.size(); p < points.size(); ++p)
            asked.answers["y"].emplace_back(points.point(p)[0] + 0.3 * uniform_at(1, 0, p) - 0.15);
        before = points;
    }
    EXPECT_GT(before.size(), 30U);
}

TEST(Refine, ARoundIsTheSameHoweverManyOfItsAnswersAreKnown) {
    auto asked = request({0, 2}, 0.5, 5, 2);
    const auto first = refine().sample(asked);
    ASSERT_EQ(first.size(), 8U);  // both ends, twice, of two combinations
    asked.answers["y"] = {0.0, 0.0, std::nullopt, 1.0, std::nullopt};
    EXPECT_EQ(refine().sample(asked).coordinates, first.coordinates);
    asked.answers["y"] = {0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 1.0};
    EXPECT_EQ(refine().sample(asked).size(), 12U);
}

TEST(Refine, EachCombinationHasAPassageOfItsOwn) {
    auto asked = request({0, 2, 2}, 0.5, 1);
    run(asked, [](auto u, auto, auto) { return step(u[0], 0.2 + 0.4 * u[1] + 0.2 * u[2]); });
    const auto found = designs::brackets(asked);
    ASSERT_EQ(found.size(), 4U);
    for (std::size_t c = 0; c < 4; ++c) {
        EXPECT_THAT(found[c].levels, ElementsAre(c / 2, c % 2));
        const double at = 0.2 + 0.4 * (c / 2 == 0 ? 0.25 : 0.75) + 0.2 * (c % 2 == 0 ? 0.25 : 0.75);
        EXPECT_LT(found[c].low.coordinate, at);
        EXPECT_GE(found[c].high.coordinate, at);
    }
}

TEST(Refine, AFallingAnswerIsBracketedToo) {
    auto asked = request({0}, 0.5, 1);
    run(asked, [](auto u, auto, auto) { return 1 - step(u[0], 0.6); });
    const auto found = designs::brackets(asked).at(0);
    EXPECT_GE(found.low.mean(), 0.5);
    EXPECT_LT(found.high.mean(), 0.5);
    EXPECT_NEAR(found.high.value, 10 + 80 * 0.6, 1);
}

TEST(Refine, WhatNeverPassesIsSaidAfterTheEnds) {
    auto below = request({0}, 0.5, 1), above = request({0}, 0.5, 1);
    run(below, [](auto, auto, auto) { return 0.1; });
    run(above, [](auto, auto, auto) { return 0.5; });  // at the threshold is above it
    EXPECT_EQ(designs::brackets(below).at(0).state, Bracket::State::below);
    EXPECT_EQ(designs::brackets(above).at(0).state, Bracket::State::above);
    EXPECT_EQ(designs::brackets(above).at(0).runs, 2U);
}

TEST(Refine, RepeatsStopWhereTheirIntervalExcludesTheThreshold) {
    auto asked = request({0}, 0.5, 45, 16);
    // Nearly no scatter at the ends, much in the middle.
    run(asked, [](auto u, std::uint32_t, std::uint32_t repeat) {
        const double scatter = u[0] > 0 && u[0] < 1 ? 0.4 : 0.001;
        return u[0] + scatter * (uniform_at(7, 0, repeat) - 0.5);
    });
    const auto found = designs::brackets(asked).at(0);
    EXPECT_EQ(found.low.asked == 2 || found.high.asked == 2, true);
    EXPECT_GT(std::max(found.low.asked, found.high.asked), 4U);
    EXPECT_LE(std::max(found.low.asked, found.high.asked), 16U);
}

TEST(Refine, ThePassageOfANoisyAnswerLiesInItsBracket) {
    int inside = 0;
    constexpr int campaigns = 200;
    for (int seed = 0; seed < campaigns; ++seed) {
        auto asked = request({0}, 0.5, 5, 8);
        const double at = 0.1 + 0.8 * uniform_at(3, 0, static_cast<std::uint64_t>(seed));
        run(asked, [&](auto u, std::uint32_t, std::uint32_t repeat) {
            const auto level = static_cast<std::uint64_t>(std::llround(u[0] * 65536));
            const double scatter = uniform_at(static_cast<std::uint64_t>(seed), level, repeat) - 0.5;
            return 0.5 + 0.5 * std::tanh((u[0] - at) / 0.05) + 0.3 * scatter;
        });
        const auto found = designs::brackets(asked).at(0);
        if (found.low.coordinate < at && at <= found.high.coordinate) ++inside;
    }
    EXPECT_GE(inside, 180);
}

TEST(Refine, ARepeatWithoutAnAnswerIsLeftOutAndALevelWithoutAnyEndsTheSearch) {
    auto asked = request({0}, 0.5, 1, 4);
    run(asked, [](auto u, std::uint32_t, std::uint32_t repeat) { return repeat == 1 ? none : step(u[0], 0.4); });
    const auto found = designs::brackets(asked).at(0);
    EXPECT_EQ(found.state, Bracket::State::found);
    EXPECT_LT(found.low.coordinate, 0.4);
    EXPECT_GE(found.high.coordinate, 0.4);

    auto broken = request({0}, 0.5, 1, 4);
    run(broken, [](auto u, auto, auto) { return u[0] == 0.5 ? none : step(u[0], 0.4); });
    EXPECT_EQ(designs::brackets(broken).at(0).state, Bracket::State::unanswered);
    EXPECT_EQ(designs::brackets(broken).at(0).runs, 2 + 2 + 4U);
}

TEST(Refine, SaysWhatCannotBe) {
    const auto refused = [](const DesignRequest& asked) -> std::string {
        try {
            (void)refine().sample(asked);
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_THAT(refused(request({0, 0}, 0.5, 1)), ::testing::HasSubstr("'f1' must be given by levels"));
    EXPECT_THAT(refused(request({0}, 0.5, 80)), ::testing::HasSubstr("whole range"));
    EXPECT_THAT(refused(request({0, 2000, 2000}, 0.5, 1)), ::testing::HasSubstr("combinations"));
    EXPECT_THAT(refused(request({2}, 0.5, 1)), ::testing::HasSubstr("does not vary"));
}

}  // namespace grainsweep::tests::designs_refine_test
