// A calibration over several experiments: every setting in all of them, one posterior.
#include "stats/random.hpp"
#include "tests/support/ask_calibration.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::tests::designs_calibration_experiments_test {

using designs::MeasuredTarget;
using Point = std::span<const double>;

const std::map<std::string, ResponseFunctions> responses = {
    {"heap", {{"angle", [](Point u) { return u[0] + u[1]; }}}},
    {"rate", {{"time", [](Point u) { return 2 + u[0] - u[1]; }}}}};

std::vector<MeasuredTarget> measured(const std::vector<double>& truth, double angle_off = 0, double time_off = 0) {
    return {{"angle", truth[0] + truth[1] + angle_off, 0.03, 0, {}, 0, "heap"},
            {"time", 2 + truth[0] - truth[1] + time_off, 0.02, 0, {}, 0, "rate"}};
}

const Options small = {{"waves", std::int64_t{3}}, {"points_per_wave", std::int64_t{16}}};

// z = (u0 + u1, u0 - u1), errors s and t: both factors have the variance (s^2 + t^2)/4, covariance (s^2 - t^2)/4.
TEST(CalibrationExperiments, OfLinearResponsesHaveTheGaussianPosteriorOfBoth) {
    auto requests = joint_requests(2, measured({0.4, 0.6}), responses, small);
    const auto found = answered_in_turn(requests, responses);
    ASSERT_TRUE(found.shape);
    const double sd = std::hypot(0.03, 0.02) / 2;
    for (const std::size_t j : {0U, 1U}) {
        EXPECT_NEAR(found.shape->mean[j], j == 0 ? 0.4 : 0.6, 0.1 * sd);
        EXPECT_NEAR(found.shape->sd[j], sd, 0.05 * sd);
    }
    EXPECT_NEAR(found.shape->correlation[1], (9. - 4) / (9 + 4), 0.06);
    EXPECT_EQ(found.waves.back().cases, 2 * found.settings.size() / 2) << "every setting in both experiments";
    // Every experiment comes to the same.
    const auto other = designs::calibration_of(requests.back());
    EXPECT_EQ(found.posterior->points, other.posterior->points);
    EXPECT_EQ(found.points.coordinates, other.points.coordinates);
}

TEST(CalibrationExperiments, WaitForTheAnswersOfAll) {
    auto requests = joint_requests(2, measured({0.4, 0.6}), responses, small);
    const auto first = designs::calibration_of(requests[0]);
    EXPECT_EQ(first.points.size(), 16U);
    auto& known = requests[0].answers["heap/angle"];
    for (std::size_t p = 0; p < first.points.size(); ++p) known.emplace_back(1.0);
    EXPECT_EQ(designs::calibration_of(requests[0]).points.size(), 16U) << "the rate is not known yet";
}

TEST(CalibrationExperiments, AFactorMayBeMissingInOneOfThem) {
    const std::map<std::string, ResponseFunctions> narrow = {{"heap", responses.at("heap")},
                                                             {"rate", {{"time", [](Point u) { return u[0]; }}}}};
    auto requests =
        joint_requests(2, {{"angle", 1, 0.03, 0, {}, 0, "heap"}, {"time", 0.4, 0.02, 0, {}, 0, "rate"}}, narrow, small);
    // The second experiment has the second factor alone.
    requests[1].factors.erase(requests[1].factors.begin());
    requests[1].levels.pop_back();
    const auto found = answered_in_turn(requests, narrow);
    ASSERT_TRUE(found.shape);
    EXPECT_NEAR(found.shape->mean[1], 0.4, 0.005);
    EXPECT_NEAR(found.shape->mean[0], 0.6, 0.01);
    const auto other = designs::calibration_of(requests[1]);
    ASSERT_EQ(other.points.dimensions, 1U);
    for (std::size_t p = 0; p < found.points.size(); ++p) EXPECT_EQ(found.points.point(p)[1], other.points.point(p)[0]);
}

TEST(CalibrationExperiments, GoOnWhileTheCheckMissesAndWavesAreLeft) {
    const auto fits = [&](double off) {
        const std::map<std::string, ResponseFunctions> same = {{"heap", {{"angle", [](Point u) { return u[0]; }}}},
                                                               {"rate", {{"time", [](Point u) { return u[0]; }}}}};
        auto requests = joint_requests(
            1, {{"angle", 0.4, 0.02, 0, {}, 0, "heap"}, {"time", 0.4 + off, 0.02, 0, {}, 0, "rate"}}, same, small);
        return answered_in_turn(requests, same);
    };
    const auto sound = fits(0);
    EXPECT_LE(designs::largest_miss(sound.targets, sound.check)->size, 2);
    EXPECT_TRUE(std::ranges::none_of(sound.waves, &designs::CalibrationWave::of_checks));
    const auto against = fits(0.11);  // halfway is 2.75 sd off both: not ruled out, and not reproduced
    const auto miss = designs::largest_miss(against.targets, against.check);
    ASSERT_TRUE(miss);
    EXPECT_GT(miss->size, 2);
    EXPECT_EQ(std::ranges::count(against.waves, false, &designs::CalibrationWave::of_checks), 3) << "all waves";
    EXPECT_EQ(std::ranges::count(against.waves, true, &designs::CalibrationWave::of_checks), 2);
    EXPECT_TRUE(against.waves_end);
}

TEST(CalibrationExperiments, AMissIsThatOfTheMeanOverWhatSeparatesItFromTheMeasurement) {
    const MeasuredTarget scalar{"a", 1, 0.3, 0.4, {}, 0, {}};
    EXPECT_FALSE(designs::miss_of(scalar, std::vector{2.0}));
    EXPECT_DOUBLE_EQ(*designs::miss_of(scalar, std::vector{2.0, 2.0}), 1 / 0.5);
    EXPECT_DOUBLE_EQ(*designs::miss_of(scalar, std::vector{1.0, 3.0}), 1 / std::sqrt(0.25 + 2));
    // Places of one curve count together: root mean square.
    const std::vector<MeasuredTarget> targets = {
        {"c@0", 0, 1, 0, {}, 1, {}}, {"c@1", 0, 1, 0, {}, 1, {}}, {"b", 0, 1, 0, {}, 0, {}}};
    const std::vector<std::vector<double>> answers = {{3, 3}, {-1, -1}, {2, 2}};
    const auto largest = designs::largest_miss(targets, answers);
    ASSERT_TRUE(largest);
    EXPECT_DOUBLE_EQ(largest->size, std::sqrt(5.0));
    EXPECT_EQ(largest->target, 0U);
    EXPECT_FALSE(designs::largest_miss(targets, std::vector<std::vector<double>>(3, {NAN, NAN})));
}

TEST(CalibrationExperiments, TargetsKeepTheirExperimentAsText) {
    const auto targets = measured({0.4, 0.6});
    EXPECT_EQ(designs::targets_in(designs::text_of(targets)), targets);
    EXPECT_EQ(targets[0].answers_key(), "heap/angle");
}

// A small version of tests/bench/calibration_slow.cpp: 12 truths, region of 95 %.
TEST(CalibrationExperiments, TheJointRegionHoldsTheTruth) {
    int held = 0;
    constexpr int truths = 12;
    for (std::uint64_t e = 0; e < truths; ++e) {
        const auto uniform = [e](std::uint64_t k) { return stats::to_unit(stats::bits_at(31, e, k)); };
        const auto normal = [&](std::uint64_t k) {  // Box & Muller
            return std::sqrt(-2 * std::log(1 - uniform(k))) * std::cos(6.283185307179586 * uniform(k + 1));
        };
        const std::vector<double> truth = {0.1 + 0.8 * uniform(0), 0.1 + 0.8 * uniform(1)};
        auto requests = joint_requests(2, measured(truth, 0.03 * normal(2), 0.02 * normal(4)), responses,
                                       {{"waves", std::int64_t{1}}, {"points_per_wave", std::int64_t{12}}}, e + 1);
        const auto found = answered_in_turn(requests, responses);
        const auto distance = [&](double angle, double time) {
            return std::pow((angle - found.targets[0].value) / 0.03, 2) +
                   std::pow((time - found.targets[1].value) / 0.02, 2);
        };
        // The posterior is Gaussian: its 95 % region has a squared distance below 5.991, chi square of two freedoms.
        held += distance(truth[0] + truth[1], 2 + truth[0] - truth[1]) < 5.991 ? 1 : 0;
        double inside = 0;
        const auto rows = found.posterior->rows();
        for (std::size_t i = 0; i < rows.size(); ++i)
            inside += distance(rows.row(i)[0] + rows.row(i)[1], 2 + rows.row(i)[0] - rows.row(i)[1]) < 5.991 ? 1 : 0;
        EXPECT_NEAR(inside / static_cast<double>(rows.size()), 0.95, 0.02);
    }
    EXPECT_GE(held, 10);
}

}  // namespace grainsweep::tests::designs_calibration_experiments_test
