#include "sweep/designs/calibration.hpp"

#include "stats/random.hpp"
#include "tests/support/ask_calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grainsweep::tests::designs_calibration_test {

using designs::MeasuredTarget;
using ::testing::HasSubstr;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
using Point = std::span<const double>;

double noise(std::uint64_t stream, std::size_t point) {
    return stats::to_unit(stats::bits_at(7, stream, point)) - 0.5;
}

// Two responses, both linear in two factors: the posterior is Gaussian, z = A u + e, covariance (A^T V^-1 A)^-1.
TEST(CalibrationWaves, OfLinearResponsesHasTheGaussianPosterior) {
    // A = ((1, 0.5), (-0.4, 1)), truth (0.45, 0.55), V = diag(0.03^2, 0.02^2)
    const auto first = [](Point u) { return u[0] + 0.5 * u[1]; };
    const auto second = [](Point u) { return -0.4 * u[0] + u[1]; };
    auto asked = calibration_request(2, {{"a", 0.45 + 0.5 * 0.55, 0.03, 0, {}}, {"b", -0.4 * 0.45 + 0.55, 0, 0.02, {}}},
                                     {{"waves", std::int64_t{2}}, {"points_per_wave", std::int64_t{16}}});
    const auto found = answered(asked, {{"a", first}, {"b", second}});
    ASSERT_TRUE(found.waves_end);
    ASSERT_TRUE(found.shape);
    const double determinant = 1 + 0.5 * 0.4;
    const double sd_x = std::hypot(0.03, 0.5 * 0.02) / determinant;  // u = A^-1 z
    const double sd_y = std::hypot(0.4 * 0.03, 0.02) / determinant;
    const double covariance = (0.4 * 0.03 * 0.03 - 0.5 * 0.02 * 0.02) / (determinant * determinant);
    EXPECT_NEAR(found.shape->mean[0], 0.45, 0.1 * sd_x);
    EXPECT_NEAR(found.shape->mean[1], 0.55, 0.1 * sd_y);
    EXPECT_NEAR(found.shape->sd[0], sd_x, 0.05 * sd_x);
    EXPECT_NEAR(found.shape->sd[1], sd_y, 0.05 * sd_y);
    EXPECT_NEAR(found.shape->correlation[1], covariance / (sd_x * sd_y), 0.06);
    EXPECT_LT(found.posterior->scale_reduction, 1.05);
    ASSERT_EQ(found.check.size(), 2U);
    for (std::size_t k = 0; k < found.checked.size() / 2; ++k)
        EXPECT_DOUBLE_EQ(found.check[0][k], first(Point(found.checked).subspan(2 * k, 2)));
}

TEST(CalibrationWaves, ClosesInWaveByWaveAndLeavesEarlierPointsWhereTheyWere) {
    const auto bowl = [](Point u) { return std::pow(u[0] - 0.3, 2) + std::pow(u[1] - 0.8, 2) + u[0]; };
    const auto wave = [](Point u) { return std::sin(4 * u[0]) + u[1] * u[1]; };
    auto asked = calibration_request(2, {{"a", 0.35, 0.01, 0.005, {}}, {"b", 1.5, 0.01, 0.005, {}}},
                                     {{"waves", std::int64_t{4}}, {"points_per_wave", std::int64_t{20}}});
    designs::PointSet before;
    std::vector<double> kept;
    for (;;) {
        const auto found = designs::calibration_of(asked);
        ASSERT_GE(found.points.coordinates.size(), before.coordinates.size());
        EXPECT_TRUE(std::ranges::equal(before.coordinates,
                                       std::span(found.points.coordinates).first(before.coordinates.size())));
        if (found.points.size() == before.size()) break;
        before = found.points;
        answer(asked, found.points, {{"a", bowl}, {"b", wave}});
    }
    const auto found = designs::calibration_of(asked);
    for (std::size_t w = 1; w < found.waves.size(); ++w) EXPECT_LT(found.waves[w].kept, found.waves[w - 1].kept);
    ASSERT_TRUE(found.shape);
    // Settings of the predictive check meet both targets.
    for (const auto& [target, answers] : {std::pair(0.35, found.check[0]), std::pair(1.5, found.check[1])})
        for (const double answer : answers) EXPECT_NEAR(answer, target, 4 * std::hypot(0.01, 0.005));
}

TEST(CalibrationWaves, StartsTheNextWaveOnlyWhenEveryAnswerIsKnown) {
    auto asked = calibration_request(1, {{"a", 0.5, 0.01, 0.01, {}}}, {{"points_per_wave", std::int64_t{12}}});
    const auto first = designs::calibration_of(asked);
    EXPECT_EQ(first.points.size(), 12U);
    EXPECT_TRUE(first.waves.empty());
    answer(asked, first.points, {{"a", [](Point u) { return u[0]; }}});
    asked.answers["a"][3] = std::nullopt;
    EXPECT_EQ(designs::calibration_of(asked).points.size(), 12U);
    asked.answers["a"][3] = none;  // settled without an answer: left out, and counted
    const auto next = designs::calibration_of(asked);
    EXPECT_GT(next.points.size(), 12U);
    ASSERT_EQ(next.waves.size(), 1U);
    EXPECT_EQ(next.waves[0].failed, 1U);
}

TEST(CalibrationWaves, TwoFactorsThatTheTargetsCannotTellApartAreARidge) {
    const auto sum = [](Point u) { return u[0] + u[1]; };
    auto asked = calibration_request(2, {{"a", 1, 0.02, 0.01, {}}}, {{"points_per_wave", std::int64_t{16}}});
    const auto found = answered(asked, {{"a", sum}});
    ASSERT_TRUE(found.shape);
    EXPECT_LT(found.shape->correlation[1], -0.98);
    EXPECT_NEAR(found.shape->widths[0], std::sqrt(2.0 / 12), 0.03) << "along the diagonal of the box";
    EXPECT_NEAR(found.shape->widths[1], std::hypot(0.02, 0.01) / std::sqrt(2.0), 0.002);
}

TEST(CalibrationWaves, TargetsThatContradictEachOtherOrLieOutOfReachAreKnown) {
    const auto same = [](Point u) { return u[0]; };
    auto asked = calibration_request(1, {{"a", 0.2, 0.01, 0.01, {}}, {"b", 0.8, 0.01, 0.01, {}}},
                                     {{"points_per_wave", std::int64_t{12}}, {"waves", std::int64_t{2}}});
    const auto against = answered(asked, {{"a", same}, {"b", same}});
    EXPECT_EQ(against.waves.back().kept, 0);
    EXPECT_GT(against.least_implausibility, 10);

    auto far = calibration_request(1, {{"a", 1.5, 0.01, 0.01, {}}},
                                   {{"points_per_wave", std::int64_t{12}}, {"waves", std::int64_t{2}}});
    const auto beyond = answered(far, {{"a", same}});
    EXPECT_GT(beyond.beyond[0], 20);
}

TEST(CalibrationWaves, ATargetThatNoCaseAnswersEndsThemWithoutAPosterior) {
    const auto slope = [](Point u) { return u[0]; };
    const auto silent = [](Point) { return none; };
    auto asked = calibration_request(1, {{"a", 0.5, 0.01, 0.01, {}}, {"c@2", 0.5, 0.01, 0.01, {}, 1}},
                                     {{"points_per_wave", std::int64_t{12}}, {"waves", std::int64_t{3}}});
    const auto found = answered(asked, {{"a", slope}, {"c@2", silent}});
    EXPECT_TRUE(found.waves_end);
    EXPECT_EQ(found.waves.size(), 1U);
    EXPECT_FALSE(found.posterior);
    EXPECT_EQ(found.points.without_result, "no case has an answer to c@2");
    EXPECT_EQ(found.why_they_end, found.points.without_result);
}

// The settings that fit best all fail: the chains begin among those that answer, and end near the border of 0.6, not
// at the fit of 0.9. The model of failures has an error, so the mean may lie a little beyond the border.
TEST(CalibrationWaves, ChainsBeginWhereCasesAnswer) {
    const auto slope = [](Point u) { return u[0] < 0.6 ? u[0] : none; };
    auto asked = calibration_request(1, {{"a", 0.9, 0.01, 0.01, {}}},
                                     {{"points_per_wave", std::int64_t{24}}, {"waves", std::int64_t{1}}});
    const auto found = answered(asked, {{"a", slope}});
    ASSERT_TRUE(found.posterior);
    EXPECT_TRUE(found.points.without_result.empty());
    EXPECT_GT(found.shape->mean[0], 0.5);
    EXPECT_LT(found.shape->mean[0], 0.7);
}

TEST(CalibrationWaves, AResponseThatNoModelFollowsDecidesNothing) {
    const auto flat = [](Point u) { return 0 * u[0] + 2; };
    const auto slope = [](Point u) { return u[0]; };
    auto asked = calibration_request(1, {{"a", 2, 0.1, 0.1, {}}, {"b", 0.5, 0.01, 0.01, {}}},
                                     {{"points_per_wave", std::int64_t{12}}, {"waves", std::int64_t{1}}});
    const auto found = answered(asked, {{"a", flat}, {"b", slope}});
    EXPECT_FALSE(found.models[0]);
    EXPECT_FALSE(found.waves[0].refusals[0].empty());
    ASSERT_TRUE(found.shape);
    EXPECT_NEAR(found.shape->mean[0], 0.5, 0.01);
}

TEST(CalibrationWaves, EveryTargetIsAskedUnderItsOwnCondition) {
    // Factor 1 states the condition, of three levels; targets stand at levels 0 and 2.
    auto asked = calibration_request(2, {{"a", 0.5, 0.02, 0, {{"f1", 0}}}, {"a", 1.1, 0.02, 0, {{"f1", 2}}}},
                                     {{"points_per_wave", std::int64_t{12}}, {"waves", std::int64_t{1}}});
    asked.levels[1] = 3;
    asked.factors[1].range = designs::Levels{{0.0, 1.0, 2.0}};
    const auto response = [](Point u) { return u[0] + 0.6 * (std::floor(3 * u[1]) / 2); };
    const auto found = answered(asked, {{"a", response}});
    ASSERT_TRUE(found.shape);
    ASSERT_EQ(found.factors.size(), 1U);
    EXPECT_EQ(found.factors[0].name, "f0");
    EXPECT_NEAR(found.shape->mean[0], 0.5, 0.01);
    EXPECT_NEAR(found.shape->sd[0], 0.02 / std::sqrt(2.0), 0.002);
    for (std::size_t p = 0; p < found.points.size(); ++p)
        EXPECT_NE(std::floor(3 * found.points.point(p)[1]), 1) << "nothing is asked at the level of no target";
}

// y = A (u, level) + e with known sds: the probability of a level is an integral of one dimension over u.
std::vector<double> level_probabilities(const std::function<double(double, std::size_t)>& first,
                                        const std::function<double(double, std::size_t)>& second, std::size_t levels,
                                        const MeasuredTarget& a, const MeasuredTarget& b) {
    std::vector<double> sums(levels, 0);
    double all = 0;
    for (std::size_t k = 0; k < levels; ++k)
        for (std::size_t i = 0; i < 20'000; ++i) {
            const double u = (static_cast<double>(i) + 0.5) / 20'000;
            const double x = (first(u, k) - a.value) / a.error, y = (second(u, k) - b.value) / b.error;
            const double density = std::exp(-(x * x + y * y) / 2);
            sums[k] += density;
            all += density;
        }
    for (double& sum : sums) sum /= all;
    return sums;
}

struct LevelCase {
    std::string name;
    std::vector<std::string> levels;
    std::vector<double> shift;  ///< of the first response
};

class CalibrationLevels : public ::testing::TestWithParam<LevelCase> {};

TEST_P(CalibrationLevels, HaveTheProbabilityOfBayes) {
    const auto& [name, levels, shift] = GetParam();
    const auto first = [&](double u, std::size_t k) { return u + shift[k]; };
    const auto second = [&](double u, std::size_t k) { return u - 0.3 * shift[k]; };
    const MeasuredTarget a{"a", 0.85, 0.1, 0, {}}, b{"b", 0.35, 0.1, 0, {}};
    auto asked = calibration_request(2, {a, b}, {{"waves", std::int64_t{2}}, {"points_per_wave", std::int64_t{32}}});
    asked.levels[1] = levels.size();
    asked.factors[1].range = designs::Levels{{levels.begin(), levels.end()}};
    const auto level = [&](double u) { return asked.factors[1].part(u); };
    const auto found = answered(asked, {{"a", [&](Point u) { return first(u[0], level(u[1])); }},
                                        {"b", [&](Point u) { return second(u[0], level(u[1])); }}});
    ASSERT_TRUE(found.posterior);
    std::vector<double> sampled(levels.size(), 0);
    const auto rows = found.posterior->rows();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        sampled[level(rows.row(i)[1])] += 1 / static_cast<double>(rows.size());
        EXPECT_EQ(rows.row(i)[1], asked.factors[1].middle(rows.row(i)[1]));
    }
    const auto exact = level_probabilities(first, second, levels.size(), a, b);
    for (std::size_t k = 0; k < levels.size(); ++k) EXPECT_NEAR(sampled[k], exact[k], 0.04) << levels[k];
    for (std::size_t p = 0; p < found.points.size(); ++p)
        EXPECT_EQ(found.points.point(p)[1], asked.factors[1].middle(found.points.point(p)[1]));
}

INSTANTIATE_TEST_SUITE_P(Kinds, CalibrationLevels,
                         ::testing::Values(LevelCase{"numbers", {"1", "2", "4"}, {0.1, 0.4, 0.7}},
                                           LevelCase{"numbers_in_another_order", {"4", "1", "2"}, {0.7, 0.1, 0.4}},
                                           LevelCase{"two_words", {"sjkr", "paper"}, {0.2, 0.5}},
                                           LevelCase{"words_in_no_order", {"low", "high", "middle"}, {0.1, 0.8, 0.4}}),
                         [](const auto& one) { return one.param.name; });

// y = a; cases fail where a > 0.5, the measured value. b acts on nothing: it stays uniform, whatever the pattern of the
// failures.
TEST(CalibrationWaves, FailuresThatOneFactorDecidesLeaveTheOtherAlone) {
    const auto half = [](Point u) { return u[0] > 0.5 ? none : u[0]; };
    for (const std::uint64_t seed : {1U, 4U}) {
        auto asked = calibration_request(2, {{"a", 0.5, 0.02, 0.01, {}}},
                                         {{"points_per_wave", std::int64_t{30}}, {"waves", std::int64_t{1}}}, seed);
        const auto found = answered(asked, {{"a", half}});
        ASSERT_TRUE(found.shape);
        EXPECT_EQ(found.answering.factors(), std::vector<std::size_t>{0}) << seed;
        EXPECT_NEAR(found.shape->mean[1], 0.5, 0.05) << seed;
        EXPECT_NEAR(found.shape->sd[1], std::sqrt(1.0 / 12), 0.03) << seed;
        EXPECT_LT(found.shape->mean[0], 0.5) << "above it no case answers";
    }
}

// A fifth of the cases fails by chance. The posterior is as wide as without failures: 0.5 +- hypot(0.03, 0.01).
TEST(CalibrationWaves, FailuresThatDependOnNothingCarryNoInformation) {
    for (const std::uint64_t seed : {1U, 2U}) {
        std::size_t count = 0;
        const auto some = [&](Point u) { return noise(seed, count++) < -0.3 ? none : u[0]; };
        auto asked = calibration_request(2, {{"a", 0.5, 0.03, 0.01, {}}},
                                         {{"points_per_wave", std::int64_t{30}}, {"waves", std::int64_t{2}}}, seed);
        const auto found = answered(asked, {{"a", some}});
        ASSERT_TRUE(found.shape);
        EXPECT_GT(found.waves.back().failed, 2U);
        EXPECT_FALSE(found.answering.decides()) << seed;
        EXPECT_NEAR(found.shape->mean[0], 0.5, 0.01);
        EXPECT_NEAR(found.shape->sd[0], std::hypot(0.03, 0.01), 0.003);
        EXPECT_NEAR(found.shape->sd[1], std::sqrt(1.0 / 12), 0.02);
    }
}

TEST(CalibrationWaves, NoDrawBreaksTheConditionAndExcludedPointsAreNoFailures) {
    auto asked = calibration_request(2, {{"y", 0.5, 0.05, 0.02, {}}},
                                     {{"points_per_wave", std::int64_t{30}}, {"waves", std::int64_t{2}}});
    asked.admits = [](Point u) { return u[0] < u[1]; };
    const auto mean = [](Point u) { return u[0] < u[1] ? (u[0] + u[1]) / 2 : none; };
    const auto found = answered(asked, {{"y", mean}});
    ASSERT_TRUE(found.posterior);
    EXPECT_EQ(found.waves[0].failed, 0U);
    EXPECT_NEAR(static_cast<double>(found.waves[0].excluded), 15, 2);
    EXPECT_EQ(found.waves[0].cases, 30 - found.waves[0].excluded);
    const auto draws = found.posterior->rows();
    for (std::size_t i = 0; i < draws.size(); ++i) ASSERT_LT(draws.row(i)[0], draws.row(i)[1]) << i;
    for (std::size_t i = 60; i < found.settings.size(); i += 2)
        EXPECT_LT(found.settings[i], found.settings[i + 1]) << "of the second wave on, no setting is wasted";
    for (std::size_t i = 0; i < found.checked.size(); i += 2) EXPECT_LT(found.checked[i], found.checked[i + 1]);
}

TEST(CalibrationWaves, KeepsAwayFromWhereCasesFail) {
    // The target is met at 0.3 and at 0.8; above 0.6 no case answers.
    const auto half = [](Point u) { return u[0] > 0.6 ? none : std::abs(u[0] - 0.55); };
    auto asked = calibration_request(1, {{"a", 0.25, 0.01, 0.01, {}}},
                                     {{"points_per_wave", std::int64_t{16}}, {"waves", std::int64_t{3}}});
    const auto found = answered(asked, {{"a", half}});
    ASSERT_TRUE(found.shape);
    EXPECT_NEAR(found.shape->mean[0], 0.3, 0.01);
    EXPECT_LT(found.shape->sd[0], 0.03);
    for (const double u : found.checked) EXPECT_LT(u, 0.6);
}

TEST(CalibrationWaves, ScatterOfRunsWidensThePosterior) {
    const auto sloped = [](Point u) { return u[0]; };
    const auto posterior_sd = [&](double amplitude) {
        auto asked = calibration_request(1, {{"a", 0.5, 0.01, 0, {}}},
                                         {{"points_per_wave", std::int64_t{40}}, {"waves", std::int64_t{2}}});
        std::size_t count = 0;
        const auto found = answered(
            asked, {{"a", [&](Point u) { return sloped(u) + amplitude * std::sqrt(12.0) * noise(1, count++); }}});
        return found.shape->sd[0];
    };
    EXPECT_NEAR(posterior_sd(0), 0.01, 0.001);
    // Eight degrees of freedom of the model's errors: Student's variance is 8/6 of the normal one.
    EXPECT_NEAR(posterior_sd(0.03), std::hypot(0.01, 0.03 * std::sqrt(8.0 / 6)), 0.006);
}

TEST(CalibrationWaves, TargetsSurviveBeingTextAndOtherTextIsRefused) {
    const std::vector<MeasuredTarget> targets = {{"angle", 40.9, 0.5, 1, {{"rpm", 0}}},
                                                 {"area", 2.861e-3, 1e-5, 0, {{"fill", 3}, {"rpm", 1}}}};
    EXPECT_EQ(designs::targets_in(designs::text_of(targets)), targets);
    const std::vector<MeasuredTarget> curve = {{"surface@-0.0042", 1, 0.1, 0, {{"rpm", 1}}, 7},
                                               {"surface@0.1", 2, 0.1, 0, {{"rpm", 1}}, 7}};
    EXPECT_EQ(designs::targets_in(designs::text_of(curve)), curve);
    EXPECT_THROW((void)designs::targets_in("surface@1 1 2 3 #x"), std::invalid_argument);
    EXPECT_THROW((void)designs::targets_in("angle 1 2"), std::invalid_argument);
    EXPECT_THROW((void)designs::targets_in("angle 1 2 3 rpm"), std::invalid_argument);
    EXPECT_THROW((void)designs::targets_in("angle 1 2 3 rpm:x"), std::invalid_argument);
}

TEST(CalibrationWaves, RefusesWavesThatNoModelCanBeMadeOf) {
    auto asked = calibration_request(3, {{"a", 1, 0.1, 0, {}}}, {{"points_per_wave", std::int64_t{12}}});
    try {
        (void)designs::calibration_of(asked);
        FAIL();
    } catch (const std::invalid_argument& refused) {
        EXPECT_THAT(refused.what(), HasSubstr("at least 16 points"));
    }
}

TEST(CalibrationWaves, PointsOfOneCurveAreOffTogether) {
    // Of a curve over [0, 1] and a scalar: correlation of the discrepancies exp(-4 |x - x'|).
    const std::vector<MeasuredTarget> targets = {{"c@0", 1, 0.3, 0.5, {}, 1},
                                                 {"y", 1, 0.1, 0.2, {}, 0},
                                                 {"c@0.5", 1, 0.3, 0.5, {}, 1},
                                                 {"c@1", 1, 0.3, 0.5, {}, 1}};
    const auto c = designs::covariance_of(targets);
    ASSERT_EQ(c.size(), 16U);
    EXPECT_DOUBLE_EQ(c[0], 0.09 + 0.25);
    EXPECT_DOUBLE_EQ(c[5], 0.01 + 0.04);
    EXPECT_DOUBLE_EQ(c[2], 0.25 * std::exp(-2));
    EXPECT_DOUBLE_EQ(c[3], 0.25 * std::exp(-4));
    EXPECT_EQ(c[1], 0);
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t j = 0; j < 4; ++j) EXPECT_EQ(c[4 * i + j], c[4 * j + i]);
}

TEST(CalibrationWaves, ACurveOfManyPointsIsNoMoreCertainThanWhatItLeavesOut) {
    // The same shift along the whole curve: twelve points determine it little better than the discrepancy of one.
    const auto sd_of = [](std::size_t points) {
        std::vector<MeasuredTarget> targets;
        grainsweep::tests::ResponseFunctions responses;
        for (std::size_t k = 0; k < points; ++k) {
            const auto name = "c@" + std::to_string(static_cast<double>(k) / static_cast<double>(points - 1));
            targets.push_back({name, 0.5, 0.01, 0.05, {}, 1});
            responses[name] = [](Point u) { return u[0]; };
        }
        auto asked =
            calibration_request(1, targets, {{"points_per_wave", std::int64_t{12}}, {"waves", std::int64_t{1}}});
        return answered(asked, responses).shape->sd[0];
    };
    const double six = sd_of(6), twelve = sd_of(12);
    EXPECT_GT(twelve, 0.5 * 0.05);
    EXPECT_NEAR(twelve, six, 0.005);
}

}  // namespace grainsweep::tests::designs_calibration_test
