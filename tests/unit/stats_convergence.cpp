#include "stats/batches.hpp"
#include "stats/confidence.hpp"
#include "stats/convergence.hpp"
#include "stats/random.hpp"
#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace grainsweep::tests::stats_convergence_test {

using namespace stats;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::vector<double> uniform(std::size_t n, std::uint64_t seed) {
    Generator generator(seed);
    std::vector<double> values(n);
    for (auto& value : values) value = generator.uniform();
    return values;
}

std::vector<std::int64_t> numbers(std::size_t n) {
    std::vector<std::int64_t> points(n);
    std::iota(points.begin(), points.end(), 0);
    return points;
}

ConvergenceSettings replicates(std::vector<Gate> gates, double tolerance, std::int64_t block = 400) {
    return {.rule = ConvergenceRule::replicates,
            .gates = std::move(gates),
            .tolerance = tolerance,
            .block = block,
            .sequences = 8};
}

TEST(Confidence, StudentHalfWidthAsTabulated) {
    // t(7, 0.975) = 2.364624; values 1 ... 8: s = sqrt(6).
    const std::vector<double> values = {1, 2, 3, 4, 5, 6, 7, 8};
    EXPECT_NEAR(student_half_width(values), 2.364624252 * std::sqrt(6.0 / 8), 1e-8);
    EXPECT_TRUE(std::isnan(student_half_width(std::vector{1.0})));
    EXPECT_TRUE(std::isnan(student_half_width(std::vector{1.0, missing, 2.0})));
}

TEST(Confidence, JackknifeOfTheMeanIsTheStudentHalfWidth) {
    const std::vector<double> values = {1, 2, 4, 8, 16};
    std::vector<double> leave_one_out;
    for (const double value : values) leave_one_out.push_back((31 - value) / 4);
    EXPECT_NEAR(jackknife_half_width(leave_one_out), student_half_width(values), 1e-12);
    for (const double unit : {1e-200, 1e160, 1e300}) {  // squares of these vanish or overflow
        std::vector<double> scaled = values;
        for (double& value : scaled) value *= unit;
        EXPECT_NEAR(student_half_width(scaled) / unit, student_half_width(values), 1e-12) << unit;
    }
}

TEST(Confidence, NothingSeenIsNoProofOfNothing) {
    EXPECT_NEAR(std::pow(1 - largest_unseen_share(59), 59), 0.05, 1e-12);
    EXPECT_NEAR(largest_unseen_share(10'000), 3e-4, 1e-6);
    EXPECT_EQ(largest_unseen_share(0), 1);
}

TEST(StretchedSample, AgreesWithSummariesOfTheRest) {
    for (const std::size_t n : {16U, 17U, 23U, 1001U, 4000U}) {
        auto values = uniform(n, n);
        for (auto& value : values) value = value < 0.3 ? 0 : std::round(50 * value);  // many ties
        StretchedSample sample;
        for (std::size_t i = 0; i < n; ++i) {
            sample.add(values[i]);
            if (i == n / 2 && n > 40) (void)sample.leave_one_out();
        }
        const auto parts = sample.leave_one_out();
        for (std::size_t g = 0; g < 8; ++g) {
            std::vector<double> rest;
            for (std::size_t i = 0; i < n; ++i)
                if (i < n * g / 8 || i >= n * (g + 1) / 8) rest.push_back(values[i]);
            const Summary plain = summarise(rest);
            EXPECT_EQ(parts[g].count, plain.count);
            EXPECT_EQ(parts[g].median, plain.median) << n << " without stretch " << g;
            for (const Statistic statistic : statistics)
                EXPECT_NEAR(parts[g].of(statistic), plain.of(statistic), 1e-12) << n << " " << to_string(statistic);
        }
    }
}

TEST(Convergence, StatisticsAndErrorsAtEachCheckAreThoseOfThePrefix) {
    const auto values = uniform(2000, 1);
    const auto checks = judge_convergence(replicates({Statistic::mean}, 0.01), numbers(2000), values, 2000);
    ASSERT_EQ(checks.size(), 5U);
    for (const auto& check : checks) {
        const auto prefix = std::span(values).first(static_cast<std::size_t>(check.points));
        const Summary plain = summarise(prefix);
        std::vector<std::vector<double>> of_sequence(8);
        for (std::size_t p = 0; p < prefix.size(); ++p) of_sequence[p % 8].push_back(prefix[p]);
        for (const Statistic statistic : statistics) {
            std::vector<double> repetitions, jackknifed;
            for (std::size_t s = 0; s < 8; ++s) {
                repetitions.push_back(summarise(of_sequence[s]).of(statistic));
                std::vector<double> others;
                for (std::size_t p = 0; p < prefix.size(); ++p)
                    if (p % 8 != s) others.push_back(prefix[p]);
                jackknifed.push_back(summarise(others).of(statistic));
            }
            double expected = student_half_width(repetitions);
            if (statistic == Statistic::g1 || statistic == Statistic::kurtosis)
                expected = std::hypot(std::max(expected, jackknife_half_width(jackknifed)),
                                      plain.of(statistic) - std::reduce(repetitions.begin(), repetitions.end()) / 8);
            EXPECT_NEAR(check.of(statistic).value, plain.of(statistic), 1e-13);
            EXPECT_NEAR(check.of(statistic).error, expected, 1e-11);
        }
    }
}

TEST(Convergence, ReplicatesNeedTwoConsecutivePasses) {
    const auto values = uniform(40'000, 5);
    const auto checks = judge_convergence(replicates({Statistic::sd}, 0.02), numbers(40'000), values, 40'000);
    for (std::size_t k = 0; k < checks.size(); ++k)
        EXPECT_EQ(checks[k].converged, checks[k].passes && k > 0 && checks[k - 1].passes);
    EXPECT_TRUE(checks.back().converged);
    EXPECT_FALSE(checks.front().converged);
}

TEST(Convergence, VerdictDoesNotDependOnHowItIsFollowed) {
    const auto values = uniform(4000, 2);
    const auto settings = replicates({Statistic::mean, Statistic::kurtosis}, 0.01);
    const auto at_once = judge_convergence(settings, numbers(4000), values, 4000);
    Convergence followed(settings);
    for (std::size_t p = 0; p < values.size(); ++p) {
        followed.add(static_cast<std::int64_t>(p), values[p]);
        if (p % 37 == 0) followed.settle(static_cast<std::int64_t>(p + 1));
    }
    followed.settle(4000);
    ASSERT_EQ(followed.checkpoints().size(), at_once.size());
    for (std::size_t k = 0; k < at_once.size(); ++k)
        for (const Statistic statistic : statistics) {
            EXPECT_EQ(followed.checkpoints()[k].of(statistic).value, at_once[k].of(statistic).value);
            EXPECT_EQ(followed.checkpoints()[k].of(statistic).error, at_once[k].of(statistic).error);
        }
}

TEST(Convergence, PointsThatWereFilteredOutKeepTheSequencesApart) {
    // Sequence s answers s: the pooled mean follows what is left, the sequences' own values never mix.
    Convergence convergence(replicates({Statistic::mean}, 0.01, 80));
    for (std::int64_t p = 0; p < 80; ++p)
        if (p % 3 != 0) convergence.add(p, static_cast<double>(p % 8));
    convergence.settle(80);
    ASSERT_EQ(convergence.checkpoints().size(), 1U);
    const auto& check = convergence.checkpoints()[0];
    EXPECT_EQ(check.count, 53);
    EXPECT_NEAR(check.of(Statistic::mean).error, student_half_width(std::vector{0., 1., 2., 3., 4., 5., 6., 7.}),
                1e-12);
}

TEST(Convergence, UndefinedNeverPasses) {
    const std::vector<double> constant(1600, 2.5);
    const auto flat = judge_convergence(replicates({Statistic::kurtosis}, 0.5), numbers(1600), constant, 1600);
    EXPECT_FALSE(flat.back().passes);
    EXPECT_EQ(flat.back().held_back, Gate{Statistic::kurtosis});
    EXPECT_FALSE(flat.back().points_needed);
    EXPECT_FALSE(judge_convergence(replicates({Statistic::mean}, 0.5), numbers(1600), constant, 1600).back().converged);
    const std::vector<double> failed(1600, missing);
    const auto nothing = judge_convergence(replicates({Statistic::mean}, 0.5), numbers(1600), failed, 1600);
    EXPECT_FALSE(nothing.back().passes);
    EXPECT_EQ(nothing.back().excluded, 1600);
}

// The kurtosis of two values is 1, of three 1.5, whatever they are: their agreement is no small error.
TEST(Convergence, EqualValuesSoFarAreNoVerdict) {
    for (const auto rule : {ConvergenceRule::replicates, ConvergenceRule::any_change, ConvergenceRule::all_change}) {
        auto settings = replicates({Statistic::mean}, 0.05, 64);
        settings.rule = rule;
        std::vector<double> values(512, 1.0);
        values[300] = 101;
        const auto checks = judge_convergence(settings, numbers(512), values, 512);
        ASSERT_EQ(checks.size(), 8U);
        for (std::size_t k = 0; k < 4; ++k) {
            EXPECT_TRUE(checks[k].all_equal);
            EXPECT_EQ(checks[k].of(Statistic::mean).value, 1);
            EXPECT_TRUE(std::isnan(checks[k].of(Statistic::mean).error)) << k;
            EXPECT_FALSE(checks[k].passes) << to_string(rule) << k;
            EXPECT_FALSE(checks[k].points_needed);
        }
        EXPECT_FALSE(checks[4].all_equal);
        EXPECT_GT(checks[4].of(Statistic::mean).error, 0.05);
        EXPECT_FALSE(checks[4].passes) << to_string(rule);
    }
}

TEST(Convergence, EqualRepetitionsOfAStatisticTellNoError) {
    // Half of the values of every sequence are 1: eight equal means, of a share that is known to a tenth at best.
    std::vector<double> values(64);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = i / 8 % 2 == 0 ? 0 : 1;
    const auto checks = judge_convergence(replicates({Statistic::mean}, 0.05, 32), numbers(64), values, 64);
    ASSERT_EQ(checks.size(), 2U);
    EXPECT_TRUE(std::isnan(checks[1].of(Statistic::mean).error));
    EXPECT_FALSE(checks[1].converged);
}

TEST(Convergence, RepetitionsThatDifferByRoundingTellNoError) {
    // Each sequence lies evenly about its middle: its skewness is 0 up to rounding, and no gate passes by that.
    const std::vector<double> offsets = {0.1, -0.3, 0.2, -0.1, 0.3, -0.2};
    Convergence convergence(replicates({Statistic::skewness}, 0.01, 48));
    for (std::int64_t point = 0; point < 48; ++point)
        convergence.add(point,
                        0.41 + 0.0137 * static_cast<double>(point % 8) + offsets[static_cast<std::size_t>(point / 8)]);
    convergence.settle(48);
    ASSERT_EQ(convergence.checkpoints().size(), 1U);
    const auto& check = convergence.checkpoints().front();
    EXPECT_TRUE(std::isnan(check.of(Statistic::skewness).error)) << check.of(Statistic::skewness).error;
    EXPECT_FALSE(check.passes);
    EXPECT_GT(check.of(Statistic::mean).error, 0.001);
}

TEST(Convergence, ACheckWithoutANewValueConfirmsNothing) {
    // A design of 40 different values that asks for the same again: rows of point numbers without values.
    const auto values = uniform(40, 3);
    for (const auto rule : {ConvergenceRule::replicates, ConvergenceRule::any_change, ConvergenceRule::all_change}) {
        auto settings = replicates({Statistic::mean}, 10, 40);
        settings.rule = rule;
        const auto checks = judge_convergence(settings, numbers(40), values, 400);
        ASSERT_EQ(checks.size(), 10U);
        EXPECT_EQ(checks[0].passes, rule == ConvergenceRule::replicates);
        for (std::size_t k = 1; k < checks.size(); ++k) {
            EXPECT_EQ(checks[k].fresh, 0);
            EXPECT_FALSE(checks[k].passes) << to_string(rule) << k;
            EXPECT_TRUE(std::isnan(checks[k].of(Statistic::mean).measure));
        }
    }
}

TEST(Convergence, AFewFarValuesCarryNoErrorOfTheShape) {
    // Values to the fourth power: a tenth of them makes most of the fourth moment.
    auto values = uniform(1600, 8);
    for (auto& value : values) value = std::pow(value, 8);
    const auto checks = judge_convergence(replicates({Statistic::kurtosis}, 10, 80), numbers(1600), values, 1600);
    for (const auto& check : checks) {
        const auto& kurtosis = check.of(Statistic::kurtosis);
        double sum = 0, squares = 0;
        for (std::size_t i = 0; i < static_cast<std::size_t>(check.points); ++i) {
            const double fourth = std::pow(values[i] - check.of(Statistic::mean).value, 4);
            sum += fourth;
            squares += fourth * fourth;
        }
        const double carriers = sum * sum / squares;
        EXPECT_EQ(std::isnan(kurtosis.error), kurtosis.carriers.has_value()) << check.points;
        EXPECT_GE(carriers, kurtosis.carriers ? 0 : 50) << check.points;
        if (!kurtosis.carriers) continue;
        EXPECT_NEAR(kurtosis.carriers->count, carriers, 1e-9);
        EXPECT_LT(carriers, kurtosis.carriers->needed);
        EXPECT_TRUE(std::isfinite(check.of(Statistic::sd).error));
        EXPECT_FALSE(kurtosis.carriers && check.passes);
    }
    EXPECT_TRUE(checks.front().of(Statistic::kurtosis).carriers);
    EXPECT_FALSE(checks.back().of(Statistic::kurtosis).carriers);
    EXPECT_TRUE(checks.back().converged);
}

TEST(Convergence, RunsThatCarryTheShapeCountOnce) {
    // 40 different values, each at 10 places.
    const auto values = uniform(40, 9);
    Convergence convergence(replicates({Statistic::kurtosis}, 10, 400));
    for (std::int64_t p = 0; p < 400; ++p) convergence.add(p, values[static_cast<std::size_t>(p % 40)], p / 40);
    convergence.settle(400);
    EXPECT_LT(convergence.checkpoints()[0].of(Statistic::kurtosis).carriers->count, 40);
}

TEST(Convergence, ErrorsOfSdAndSkewnessNeedFourValuesInEachSequence) {
    const auto values = uniform(40, 6);
    const auto checks = judge_convergence(replicates({Statistic::mean}, 0.01, 8), numbers(40), values, 40);
    ASSERT_EQ(checks.size(), 5U);
    for (const auto& check : checks) {
        EXPECT_TRUE(std::isfinite(check.of(Statistic::mean).error)) << check.points;
        for (const auto statistic : {Statistic::sd, Statistic::skewness})
            EXPECT_EQ(std::isfinite(check.of(statistic).error), check.points >= 32) << check.points;
    }
}

TEST(Convergence, PearsonIsRefusedWhereHalfTheValuesAreZero) {
    auto values = uniform(8000, 4);
    for (auto& value : values) value = value < 0.5 ? 0 : value;
    const auto checks = judge_convergence(replicates({Statistic::skewness}, 0.9), numbers(8000), values, 8000);
    EXPECT_NEAR(checks.back().zero_share, 0.5, 0.02);
    EXPECT_FALSE(checks.back().passes);
    EXPECT_EQ(checks.back().held_back, Gate{Statistic::skewness});
    EXPECT_FALSE(std::isnan(checks.back().of(Statistic::skewness).error));  // shown all the same
    EXPECT_TRUE(judge_convergence(replicates({Statistic::skewness}, 0.9), numbers(8000), uniform(8000, 4), 8000)
                    .back()
                    .converged);
}

TEST(Convergence, ChangeRulesCompareWithTheCheckBefore) {
    // Two blocks with the same mean and another spread: the mean does not change, the sd does.
    std::vector<double> values;
    for (int i = 0; i < 100; ++i) values.push_back(i % 2 == 0 ? 1 : 3);
    for (int i = 0; i < 100; ++i) values.push_back(i % 2 == 0 ? 0 : 4);
    ConvergenceSettings settings{.rule = ConvergenceRule::any_change,
                                 .gates = {Statistic::mean, Statistic::sd},
                                 .tolerance = 0.01,
                                 .block = 100,
                                 .sequences = 1};
    const auto any = judge_convergence(settings, numbers(200), values, 200);
    EXPECT_FALSE(any[0].passes);
    EXPECT_TRUE(any[1].converged);
    EXPECT_NEAR(any[1].of(Statistic::sd).measure, 1 - 1 / std::sqrt(2.5), 1e-12);
    settings.rule = ConvergenceRule::all_change;
    const auto all = judge_convergence(settings, numbers(200), values, 200);
    EXPECT_FALSE(all[1].passes);
    EXPECT_EQ(all[1].held_back, Gate{Statistic::sd});
}

TEST(Convergence, JackknifeErrorsOfOneSequenceAreHonestForIndependentPoints) {
    // The 95 % half-width must cover the true mean, sd and kurtosis of uniform values in about 95 % of 400
    // tries (standard error 1.1 %; t-intervals of 8 groups run slightly low for the kurtosis).
    const std::array truth = {0.5, 1 / std::sqrt(12.0), missing, 0.0, 1.8};
    std::array<int, 5> covered{};
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        ConvergenceSettings settings{.rule = ConvergenceRule::all_change,
                                     .gates = {Statistic::mean},
                                     .tolerance = 0.01,
                                     .block = 800,
                                     .sequences = 1};
        const auto check = judge_convergence(settings, numbers(800), uniform(800, 1000 + seed), 800).back();
        for (std::size_t s = 0; s < 5; ++s)
            if (std::abs(check.estimates[s].value - truth[s]) <= check.estimates[s].error) ++covered[s];
    }
    for (const std::size_t s : {0U, 1U, 3U, 4U}) {
        EXPECT_GE(covered[s], 365) << to_string(statistics[s]);
        EXPECT_LE(covered[s], 394) << to_string(statistics[s]);
    }
}

TEST(Convergence, PredictsWhatIsStillNeeded) {
    // Sequence s differs in its first value only, so the error of the mean falls exactly as 1/n and the
    // prediction must name the very check at which the rule then stops.
    Convergence convergence(replicates({Statistic::mean}, 1e-4, 80));
    std::int64_t predicted = 0;
    std::int64_t p = 0;
    for (; convergence.converged() == nullptr && p < 100'000; ++p) {
        convergence.add(p, p < 8 ? 1 + 0.1 * (static_cast<double>(p) - 3.5) : 1.0);
        if (convergence.checkpoints().size() == 4) predicted = convergence.checkpoints().back().points_needed.value();
    }
    ASSERT_NE(convergence.converged(), nullptr);
    EXPECT_GT(predicted, 10'000);
    EXPECT_EQ(convergence.converged()->points, predicted);
    EXPECT_EQ(convergence.converged()->points_needed, predicted);
}

TEST(Convergence, WrongSettingsAreRefused) {
    auto settings = replicates({Statistic::mean}, 0.01);
    settings.sequences = 3;
    EXPECT_THROW(Convergence{settings}, std::invalid_argument);
    EXPECT_THROW(Convergence{replicates({}, 0.01)}, std::invalid_argument);
    EXPECT_THROW(Convergence{replicates({Statistic::mean}, 0.0)}, std::invalid_argument);
    EXPECT_THROW(Convergence{replicates({Statistic::mean}, 0.01, 0)}, std::invalid_argument);
    for (const auto& rule : convergence_rules) {
        EXPECT_EQ(&info_of(rule.rule), &rule);
        EXPECT_EQ(find_rule(rule.name), &rule);
    }
    EXPECT_EQ(find_rule("no rule"), nullptr);
}

TEST(Convergence, SequencesThatAgreeByCountingAreNoEvidence) {
    // Each sequence of 16 points has 3 or 4 below 0.2: in one campaign of six all 8 have 3. The true mean is 0.25.
    int held = 0, agreed = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const auto set = ask_design("halton", 2, {{"points", 128}, {"sequences", 8}}, seed);
        std::vector<double> values;
        for (std::size_t i = 0; i < set.size(); ++i)
            values.push_back((set.point(i)[0] < 0.2 ? 1 : 0) + 0.1 * set.point(i)[1]);
        const auto mean =
            judge_convergence({.block = 128, .sequences = 8}, numbers(128), values, 128).front().of(Statistic::mean);
        held += std::abs(mean.value - 0.25) <= mean.error ? 1 : 0;
        agreed += std::abs(mean.value - 0.2375) < 0.002 ? 1 : 0;
    }
    EXPECT_GT(agreed, 4);
    EXPECT_GE(held, 52) << "0.93 less two standard errors";
}

}  // namespace grainsweep::tests::stats_convergence_test
