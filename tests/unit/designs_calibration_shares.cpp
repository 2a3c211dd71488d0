// Calibration to the share of measured runs without a value, such as jams.
#include "stats/confidence.hpp"
#include "stats/random.hpp"
#include "tests/support/ask_calibration.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace grainsweep::tests::designs_calibration_shares_test {

using designs::MeasuredTarget;
using Point = std::span<const double>;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Probability of a jam: rises from 0 to 1 about u = 1/2.
double probability(double u) {
    return stats::normal_cdf((u - 0.5) / 0.15);
}

bool jams(Point u, std::uint64_t seed) {
    return stats::to_unit(stats::bits_at(seed, std::bit_cast<std::uint64_t>(u[0]), 5)) < probability(u[0]);
}

MeasuredTarget jammed(std::size_t count, std::size_t of) {
    const double share = static_cast<double>(count) / static_cast<double>(of);
    return {"t!", share, 0.1, 0, {}, 0, {}, of};
}

struct Moments {
    double mean = 0, sd = 0;
};

/// Bayes's posterior of u, uniform before, by the midpoint rule.
Moments exact_posterior(const std::function<double(double)>& likelihood) {
    double sum = 0, first = 0, second = 0;
    for (int i = 0; i < 10'000; ++i) {
        const double u = (i + 0.5) / 10'000, density = likelihood(u);
        sum += density;
        first += u * density;
        second += u * u * density;
    }
    return {first / sum, std::sqrt(second / sum - first / sum * (first / sum))};
}

double binomial(std::size_t count, std::size_t of, double p) {
    return std::pow(p, static_cast<double>(count)) * std::pow(1 - p, static_cast<double>(of - count));
}

const Options two_waves = {{"waves", std::int64_t{2}}, {"points_per_wave", std::int64_t{40}}};

// Five levels, 800 runs at each: the model of the probability has hardly an error left, and Bayes's posterior follows
// from the shares of these runs.
TEST(CalibrationShares, LevelsHaveTheProbabilityOfBayes) {
    const std::vector<std::string> levels = {"1", "2", "3", "4", "5"};
    for (const auto& [count, of] :
         {std::pair<std::size_t, std::size_t>(3, 10), std::pair<std::size_t, std::size_t>(0, 5)}) {
        auto asked = calibration_request(1, {jammed(count, of)},
                                         {{"waves", std::int64_t{1}}, {"points_per_wave", std::int64_t{4000}}});
        asked.levels[0] = levels.size();
        asked.factors[0].range = designs::Levels{{levels.begin(), levels.end()}};
        std::uint64_t drawn = 0;
        std::vector<double> runs(levels.size(), 0), jams_of(levels.size(), 0);
        const auto jam = [&](Point u) {
            const auto level = asked.factors[0].part(u[0]);
            const bool one = stats::to_unit(stats::bits_at(9, ++drawn, 1)) < probability(u[0]);
            runs[level] += 1;
            jams_of[level] += one ? 1 : 0;
            return one ? 1.0 : 0.0;
        };
        const auto found = answered(asked, {{"t!", jam}});
        ASSERT_TRUE(found.posterior);
        std::vector<double> sampled(levels.size(), 0), exact;
        const auto rows = found.posterior->rows();
        for (std::size_t i = 0; i < rows.size(); ++i)
            sampled[asked.factors[0].part(rows.row(i)[0])] += 1 / static_cast<double>(rows.size());
        double all = 0;
        for (std::size_t k = 0; k < levels.size(); ++k)
            all += exact.emplace_back(binomial(count, of, jams_of[k] / runs[k]));
        for (std::size_t k = 0; k < levels.size(); ++k) EXPECT_NEAR(sampled[k], exact[k] / all, 0.04) << levels[k];
    }
}

// Of a continuous factor the model has an error, that of some ten cases nearby, which widens the posterior.
TEST(CalibrationShares, HavePosteriorsAsWideAsBayesOrWider) {
    const auto exact = exact_posterior([](double u) { return binomial(3, 10, probability(u)); });
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
        auto asked = calibration_request(1, {jammed(3, 10)}, two_waves, seed);
        const auto found = answered(asked, {{"t!", [&](Point u) { return jams(u, seed) ? 1.0 : 0.0; }}});
        ASSERT_TRUE(found.shape);
        EXPECT_NEAR(found.shape->mean[0], exact.mean, exact.sd) << seed;
        EXPECT_GT(found.shape->sd[0], 0.9 * exact.sd) << seed;
        EXPECT_LT(found.shape->sd[0], 1.8 * exact.sd) << seed;
        ASSERT_EQ(found.check.size(), 1U);
        for (const double one : found.check[0]) EXPECT_TRUE(one == 0 || one == 1);
    }
}

// The flow time 1 + u of the runs that flow, and how many jam: a jam is no missing answer, and both decide.
TEST(CalibrationShares, CountsBesideValuesAreNoFailures) {
    const auto jam = [](Point u) { return jams(u, 2) ? 1.0 : 0.0; };
    const auto time = [](Point u) { return jams(u, 2) ? none : 1 + u[0]; };
    const MeasuredTarget flowing{"t", 1.45, 0.1, 0, {}};
    auto asked = calibration_request(1, {flowing, jammed(3, 10)}, two_waves);
    const auto found = answered(asked, {{"t", time}, {"t!", jam}});
    ASSERT_TRUE(found.shape);
    EXPECT_EQ(found.waves.back().failed, 0U);
    EXPECT_FALSE(found.answering.p_value());
    const auto exact = exact_posterior(
        [](double u) { return binomial(3, 10, probability(u)) * std::exp(-std::pow((1 + u - 1.45) / 0.1, 2) / 2); });
    EXPECT_NEAR(found.shape->mean[0], exact.mean, exact.sd);
    EXPECT_NEAR(found.shape->sd[0], exact.sd, 0.4 * exact.sd);
    // Without the count the same runs have no answer, which depends on u.
    auto alone = calibration_request(1, {flowing}, two_waves);
    const auto without = answered(alone, {{"t", time}});
    EXPECT_GT(without.waves.back().failed, 10U);
    EXPECT_TRUE(without.answering.decides());
}

TEST(CalibrationShares, AFailedCaseIsNeitherAJamNorAFlow) {
    std::size_t asked_points = 0;
    const auto some_fail = [&](Point u) { return asked_points++ % 5 == 0 ? none : jams(u, 3) ? 1.0 : 0.0; };
    auto asked = calibration_request(1, {jammed(3, 10)}, two_waves);
    const auto found = answered(asked, {{"t!", some_fail}});
    ASSERT_TRUE(found.shape);
    EXPECT_NEAR(static_cast<double>(found.waves.back().failed), static_cast<double>(asked_points) / 5, 3);
    EXPECT_FALSE(found.answering.decides());
    const auto exact = exact_posterior([](double u) { return binomial(3, 10, probability(u)); });
    EXPECT_NEAR(found.shape->mean[0], exact.mean, 1.2 * exact.sd);
}

TEST(CalibrationShares, TheDiscrepancyWidensThePosterior) {
    const auto sd_of = [](double discrepancy) {
        auto target = jammed(30, 100);
        target.discrepancy = discrepancy;
        auto asked = calibration_request(1, {target}, two_waves);
        return answered(asked, {{"t!", [](Point u) { return jams(u, 4) ? 1.0 : 0.0; }}}).shape->sd[0];
    };
    EXPECT_GT(sd_of(0.15), 1.3 * sd_of(0));
}

TEST(CalibrationShares, WithoutAnyJamTheModelSaysWhere) {
    auto asked =
        calibration_request(1, {jammed(9, 10)}, {{"waves", std::int64_t{2}}, {"points_per_wave", std::int64_t{40}}});
    const auto found = answered(asked, {{"t!", [](Point) { return 0.0; }}});
    EXPECT_GT(found.least_implausibility, 2) << "no setting has so many jams";
}

TEST(CalibrationShares, FreshRunsAreComparedByTheirShare) {
    const std::vector<double> three_of_eight = {1, 0, 0, 1, 0, 0, 1, 0};
    const double p = (3. + 3) / (8 + 10);
    EXPECT_NEAR(designs::miss_of(jammed(3, 10), three_of_eight).value(),
                (3. / 8 - 0.3) / std::sqrt(p * (1 - p) * (1. / 8 + 1. / 10)), 1e-12);
    EXPECT_EQ(designs::miss_of(jammed(0, 10), std::vector<double>(8, 0)).value(), 0);
    EXPECT_GT(designs::miss_of(jammed(0, 10), std::vector<double>(8, 1)).value(), 4);
    EXPECT_FALSE(designs::miss_of(jammed(0, 10), std::vector<double>{none, 1}));
}

TEST(CalibrationShares, SurviveBeingText) {
    const std::vector<MeasuredTarget> targets = {{"t!", 0.3, 0.14, 0.05, {{"rpm", 1}}, 0, "heap", 10},
                                                 {"t", 1, 0.14, 0.05, {{"rpm", 1}}, 0, "heap"}};
    EXPECT_EQ(designs::targets_in(designs::text_of(targets)), targets);
    EXPECT_EQ(targets[0].count(), 3U);
    EXPECT_EQ(targets[0].shown_observable(), "share without t");
    EXPECT_THROW((void)designs::targets_in("t! 0.3 0.1 0 *x"), std::invalid_argument);
}

}  // namespace grainsweep::tests::designs_calibration_shares_test
