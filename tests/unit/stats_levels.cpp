// Quantiles and probabilities with their errors: closed forms, few values, ties, jumps, failures.
#include "stats/assisted_moments.hpp"
#include "stats/confidence.hpp"
#include "stats/convergence.hpp"
#include "stats/levels.hpp"
#include "tests/support/judged_responses.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace grainsweep::stats;

namespace grainsweep::tests::stats_levels_test {

const JudgedResponse line{"line", 2, [](JudgedResponse::Point u) { return u[0] + 0.5 * u[1]; }};
const JudgedResponse jump{"jump", 2, [](JudgedResponse::Point u) { return (u[0] < 0.47 ? 1 : 0) + 0.1 * u[1]; }};

Checkpoint check_of(const JudgedResponse& response, const std::vector<Gate>& gates, std::int64_t n,
                    std::uint64_t seed) {
    std::vector<std::int64_t> points(static_cast<std::size_t>(n));
    std::iota(points.begin(), points.end(), 0);
    const ConvergenceSettings settings{.gates = gates, .block = n, .sequences = 8};
    return judge_convergence(settings, points, ask_judged(response, "sobol", n, seed).values, n).front();
}

TEST(Levels, HaveNamesThatAreReadBack) {
    for (const Level& level : {Level{Quantile{0.05}}, Level{Exceedance{-1.5e-6, true}}, Level{Exceedance{2, false}}})
        EXPECT_EQ(level_named(to_string(level)), level) << to_string(level);
    EXPECT_EQ(to_string(Level{Quantile{0.9}}), "quantile:0.9");
    for (const char* wrong : {"quantile:0", "quantile:1", "quantile:", "above:x", "above:1 mm", "beyond:1", "mean", ""})
        EXPECT_FALSE(level_named(wrong)) << wrong;
}

// u0 + u1/2: P(y > 1) = 1/4, P(y < 1/2) = 1/4, quantile 3/4 at 1, all exactly.
TEST(Levels, HoldTheTruthOfATrapezoid) {
    const std::vector<std::pair<Gate, double>> truths = {{Level{Exceedance{1, true}}, 0.25},
                                                         {Level{Exceedance{0.5, false}}, 0.25},
                                                         {Level{Quantile{0.75}}, 1},
                                                         {Level{Quantile{0.5}}, 0.75}};
    std::vector<Gate> gates;
    for (const auto& [gate, truth] : truths) gates.push_back(gate);
    int held = 0, all = 0;
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const auto check = check_of(line, gates, 256, seed);
        for (const auto& [gate, truth] : truths) {
            ASSERT_GT(check.of(gate).error, 0);
            EXPECT_LT(check.of(gate).error, 0.06) << to_string(gate);
            held += std::abs(check.of(gate).value - truth) <= check.of(gate).error ? 1 : 0;
            ++all;
        }
    }
    EXPECT_GE(held, 0.93 * all);
}

// Eight sequences of 16 Sobol points count 7 or 8 points below 0.47: where all count 8 their shares do not differ.
TEST(Levels, SequencesThatCountAlikeAreNoEvidence) {
    int held = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        const auto check = check_of(jump, {Level{Exceedance{0.5, true}}}, 128, seed);
        const auto& share = check.of(Gate{Level{Exceedance{0.5, true}}});
        ASSERT_GT(share.error, 0);
        held += std::abs(share.value - 0.47) <= share.error ? 1 : 0;
    }
    EXPECT_GE(held, 56);
}

TEST(Levels, RareOnesHaveTheBinomialInterval) {
    const auto campaign = ask_judged(line, "halton", 400, 5);
    auto sorted = campaign.values;
    std::ranges::sort(sorted);
    GroupedSample sample{.sorted = sorted, .groups = batches_of(campaign.values)};
    const auto none = level_of(Exceedance{2, true}, sample);
    EXPECT_EQ(none.value, 0);
    // Clopper & Pearson of 0 in 400, one side: 1 - 0.025^(1/400).
    EXPECT_NEAR(none.error, 1 - std::pow(0.025, 1.0 / 400), 1e-12);
    EXPECT_TRUE(std::isnan(level_of(Quantile{0.999}, sample).error));
    std::vector<std::vector<double>> sequences(8);
    for (std::size_t i = 0; i < 400; ++i) sequences[i % 8].push_back(campaign.values[i]);
    sample.groups.assign(sequences.begin(), sequences.end());
    const auto rare = level_of(Quantile{0.98}, sample);  // 8 values lie above: the order statistics 2 to 14 enclose it
    EXPECT_GE(rare.error, rare.value - sorted[400 - 14]);
    sample.groups = {std::span(campaign.values).first(2), std::span(campaign.values).subspan(2)};
    EXPECT_TRUE(std::isnan(level_of(Quantile{0.5}, sample).error));
}

TEST(Levels, AboveAndBelowShareTiesOut) {
    const std::vector<double> values = {0, 1, 1, 1, 2, 2, 3, 4, 0, 1, 1, 1, 2, 2, 3, 4, 0, 1, 1, 1, 2, 2, 3, 4,
                                        0, 1, 1, 1, 2, 2, 3, 4, 0, 1, 1, 1, 2, 2, 3, 4, 0, 1, 1, 1, 2, 2, 3, 4};
    auto sorted = values;
    std::ranges::sort(sorted);
    const GroupedSample sample{.sorted = sorted, .groups = batches_of(values)};
    EXPECT_EQ(level_of(Exceedance{1, true}, sample).value, 0.5);
    EXPECT_EQ(level_of(Exceedance{1, false}, sample).value, 0.125);
    EXPECT_EQ(level_of(Quantile{0.25}, sample).value, 1);
}

TEST(Levels, AreGatesOfARule) {
    ConvergenceSettings settings{
        .gates = {Level{Quantile{0.75}}, Level{Exceedance{1, true}}}, .tolerance = 0.03, .block = 128, .sequences = 8};
    const auto campaign = ask_judged(line, "sobol", 2048, 3);
    std::vector<std::int64_t> points(2048);
    std::iota(points.begin(), points.end(), 0);
    const auto checks = judge_convergence(settings, points, campaign.values, 2048);
    const auto end = std::ranges::find(checks, true, &Checkpoint::converged);
    ASSERT_NE(end, checks.end());
    EXPECT_LT(end->of(settings.gates[1]).measure, 0.03);
    EXPECT_FALSE(checks.front().passes);
    ASSERT_TRUE(checks.front().held_back);
    EXPECT_TRUE(checks.front().points_needed);
}

TEST(Levels, WithAModelNeedFewerCases) {
    const std::vector<Level> levels = {Exceedance{1, true}, Quantile{0.75}};
    const std::vector<double> truths = {0.25, 1};
    const auto integration = integration_of(line, 11, 4);
    int held = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const auto campaign = ask_judged(line, "halton", 128, seed);
        AssistedSettings settings;
        settings.levels = levels;
        const auto answer = assisted_moments(
            {{campaign.features, 2}, campaign.values, campaign.sequences, {integration.features, 2}, 4}, settings);
        const auto& found = std::get<AssistedMoments>(answer).levels;
        ASSERT_EQ(found.size(), 2U);
        for (std::size_t k = 0; k < 2; ++k) {
            held += std::abs(found[k].value - truths[k]) <= found[k].error ? 1 : 0;
            EXPECT_LT(found[k].error, 0.02) << "without a model 0.04";
        }
    }
    EXPECT_GE(held, 37);
}

}  // namespace grainsweep::tests::stats_levels_test
