// Two settings of the numerics: the corrected moments hold their intervals whatever the bias of the cheap one is.
#include "stats/two_levels.hpp"
#include "tests/support/known_responses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace grainsweep::tests::stats_two_levels_test {

using stats::Statistic;

constexpr double dear_cost = 20;

/// A cheap setting that is 4 % too high, more where the first factor is high, with scatter of its own.
struct TwoSettings {
    KnownResponse expensive;
    [[nodiscard]] double cheap(std::span<const double> u) const {
        return expensive.mean(u) * (1.04 + 0.05 * u[0]) + 0.02;
    }
};

/// Values of a campaign, made as they are asked for.
class Campaign {
public:
    Campaign(const TwoSettings& settings, std::int64_t most, std::uint64_t seed)
        : settings_(settings),
          set_(ask_design("halton", settings.expensive.dimensions, {{"points", most}, {"sequences", std::int64_t{8}}},
                          seed)),
          noise_(seed, 78) {}

    std::vector<double> cheap(std::int64_t n) const {
        std::vector<double> values;
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
            values.push_back(settings_.cheap(set_.point(i)) + settings_.expensive.noise * normal_at(noise_, 2 * i));
        return values;
    }
    std::vector<double> expensive(std::int64_t n) const {
        std::vector<double> values;
        for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i)
            values.push_back(settings_.expensive.mean(set_.point(i)) +
                             settings_.expensive.noise * normal_at(noise_, 2 * i + 1));
        return values;
    }

private:
    const TwoSettings& settings_;
    designs::PointSet set_;
    stats::Stream noise_;
};

struct Course {
    stats::TwoLevelCheck check;
    bool within = false;
};

/// As run_accurate does it.
Course follow(const Campaign& campaign, double tolerance, std::int64_t most) {
    const stats::TwoLevelRule rule{{Statistic::mean, Statistic::sd}, tolerance, most, dear_cost};
    std::int64_t points = 64, pairs = 32;
    bool passed = false;
    while (true) {
        const auto cheap = campaign.cheap(points), expensive = campaign.expensive(pairs);
        Course course{stats::two_level_check(rule, {cheap, expensive, 8}), false};
        course.within = passed && course.check.passes;
        if (course.within || course.check.last()) return course;
        passed = course.check.passes;
        points = course.check.next_points;
        pairs = course.check.next_pairs;
    }
}

struct Coverage {
    int campaigns = 0, stopped = 0, mean_held = 0, sd_held = 0, within_goal = 0;
    double points = 0, pairs = 0;
};

Coverage cover(const KnownResponse& response, double tolerance, int campaigns) {
    constexpr std::int64_t most = 6400;
    const TwoSettings settings{response};
    const auto truth = true_statistics(response, true);
    Coverage all;
    for (int seed = 1; seed <= campaigns; ++seed) {
        const Campaign campaign(settings, most, static_cast<std::uint64_t>(seed));
        const auto course = follow(campaign, tolerance, most);
        const auto& mean = course.check.moments[0];
        const auto& sd = course.check.moments[1];
        ++all.campaigns;
        all.stopped += course.within ? 1 : 0;
        all.mean_held += std::abs(mean.value - truth[0]) <= mean.together ? 1 : 0;
        all.sd_held += std::abs(sd.value - truth[1]) <= sd.together ? 1 : 0;
        all.within_goal +=
            std::abs(mean.value / truth[0] - 1) <= tolerance && std::abs(sd.value / truth[1] - 1) <= tolerance;
        all.points += static_cast<double>(course.check.points) / campaigns;
        all.pairs += static_cast<double>(course.check.pairs) / campaigns;
    }
    return all;
}

TEST(TwoLevels, StatedErrorsHoldOver200CampaignsOfEachResponse) {
    for (const auto& response : known_responses()) {
        if (response.name == "noise" || response.name == "waves") continue;  // sd of noise alone needs all points
        const auto found = cover(response, 0.03, 200);
        const std::string figures = response.name + ": mean " + std::to_string(found.mean_held) + ", sd " +
                                    std::to_string(found.sd_held) + ", goal " + std::to_string(found.within_goal) +
                                    " of " + std::to_string(found.campaigns) + "; stopped " +
                                    std::to_string(found.stopped) + ", points " + std::to_string(found.points) +
                                    ", pairs " + std::to_string(found.pairs);
        RecordProperty(response.name, figures);
        EXPECT_GE(found.mean_held, 186) << figures;
        EXPECT_GE(found.sd_held, 186) << figures;
        EXPECT_GE(found.within_goal, 190) << figures;
    }
}

TEST(TwoLevels, TheCheapSettingAloneIsOffByItsBias) {
    const auto response = known_responses().front();
    const TwoSettings settings{response};
    const Campaign campaign(settings, 1024, 1);
    const auto cheap = campaign.cheap(1024), expensive = campaign.expensive(256);
    const double truth = true_statistics(response, true)[0];
    const auto alone = stats::two_level_moment(Statistic::mean, {cheap, {}, 8});
    const auto corrected = stats::two_level_moment(Statistic::mean, {cheap, expensive, 8});
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
    const std::vector<Statistic> gates = {Statistic::mean, Statistic::sd};
    std::vector<double> close, far, reference;
    for (int i = 0; i < 16; ++i) {
        reference.push_back(2 + std::cos(i));
        close.push_back(2.1 + 1.02 * std::cos(i) + 0.01 * std::sin(7 * i));
        far.push_back(2 + std::cos(5 * i + 1));
    }
    const auto chosen = [&](double close_cost, double far_cost) {
        const std::vector<stats::PilotLevel> levels = {{far, far_cost}, {close, close_cost}, {reference, 10}};
        return stats::cheapest_level(gates, levels);
    };
    EXPECT_EQ(chosen(1, 0.5), 1U) << "one that follows the measure";
    EXPECT_EQ(chosen(9.9, 0.5), 2U) << "one that saves nothing needs no pairs";
    EXPECT_EQ(chosen(9.9, 1e-9), 2U) << "one that says nothing of the measure doubles its variance";
}

}  // namespace grainsweep::tests::stats_two_levels_test
