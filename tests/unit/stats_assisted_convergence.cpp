#include "stats/assisted_convergence.hpp"
#include "tests/support/known_responses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

namespace grainsweep::tests::stats_assisted_convergence_test {

using namespace stats;

ConvergenceSettings settings(double tolerance, std::int64_t block = 8) {
    return {.rule = ConvergenceRule::assisted,
            .gates = {Statistic::mean, Statistic::sd},
            .tolerance = tolerance,
            .block = block,
            .sequences = 8};
}

KnownResponse hill() {
    return {"hill", 2, [](std::span<const double> u) { return 1 + std::sin(3 * u[0]) * (0.5 + u[1]); }, 0.02, 1000};
}

ModelSpace space() {
    return {.dimensions = 2, .low = {}, .high = {}, .integration = integration_points(2, 9), .scramblings = 8};
}

std::vector<std::int64_t> numbers(std::size_t n) {
    std::vector<std::int64_t> points(n);
    for (std::size_t i = 0; i < n; ++i) points[i] = static_cast<std::int64_t>(i);
    return points;
}

/// The next check, over the beginning of a campaign.
const Checkpoint& look(AssistedConvergence& convergence, const KnownCampaign& c) {
    const auto n = static_cast<std::size_t>(convergence.next_check());
    convergence.check(numbers(n), std::span(c.values).first(n), std::span(c.points).first(2 * n));
    return convergence.checkpoints().back();
}

TEST(AssistedConvergence, StopsWhereThePlainRuleDoesNotAndTheTruthIsWithinItsErrors) {
    const auto response = hill();
    const auto truth = true_statistics(response, true);
    int covered = 0, plain_stops = 0;
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const auto campaign = ask_known(response, 192, seed);
        AssistedConvergence assisted(settings(0.025), space());
        while (assisted.converged() == nullptr && assisted.next_check() <= 192) (void)look(assisted, campaign);
        ASSERT_NE(assisted.converged(), nullptr);
        ASSERT_GE(assisted.checkpoints().size(), 2U);  // in a row
        EXPECT_TRUE(assisted.checkpoints()[assisted.checkpoints().size() - 2].passes);
        const Checkpoint& last = *assisted.converged();
        EXPECT_EQ(last.points_needed, last.points);
        for (const auto& [statistic, expected] : {std::pair(Statistic::mean, truth[0]), {Statistic::sd, truth[1]}})
            covered += std::abs(last.of(statistic).value - expected) <= last.of(statistic).error ? 1 : 0;

        auto plain = settings(0.025);
        plain.rule = ConvergenceRule::replicates;
        const auto checks = judge_convergence(plain, numbers(192), campaign.values, 192);
        plain_stops += std::ranges::any_of(checks, &Checkpoint::converged) ? 1 : 0;
    }
    EXPECT_LE(plain_stops, 1);
    EXPECT_GE(covered, 9);  // of 12; coverage over hundreds of campaigns is counted by slow_assisted
}

TEST(AssistedConvergence, ChecksAreAFifthApartAtLeast) {
    const AssistedConvergence fine(settings(0.01, 8), space()), coarse(settings(0.01, 400), space());
    EXPECT_EQ(fine.next_check(), 104);
    EXPECT_EQ(fine.next_check(104), 128);
    EXPECT_EQ(fine.next_check(1000), 1200);
    EXPECT_EQ(coarse.next_check(), 400);
    EXPECT_EQ(coarse.next_check(400), 800);
    EXPECT_EQ(coarse.next_check(2000), 2400);
    EXPECT_EQ(coarse.next_check(4000), 4800);
    int checks = 0;
    for (std::int64_t n = fine.next_check(); n <= 1'000'000; n = fine.next_check(n)) ++checks;
    EXPECT_LE(checks, 1 + std::log(1e6 / 104) / std::log(1.2));
}

TEST(AssistedConvergence, AModelThatIsRefusedDecidesNothing) {
    auto campaign = ask_known(hill(), 160, 1);
    for (std::size_t i = 0; i < campaign.values.size(); ++i)
        campaign.values[i] = i % 13 == 0 ? 1 + 1e-6 * static_cast<double>(i) : 0;
    AssistedConvergence convergence(settings(0.999), space());
    for (int k = 0; k < 2; ++k) {
        const Checkpoint& check = look(convergence, campaign);
        EXPECT_FALSE(check.passes);
        EXPECT_TRUE(std::isnan(check.of(Statistic::mean).error));
        EXPECT_TRUE(std::isfinite(check.of(Statistic::mean).value));
        EXPECT_FALSE(check.points_needed);
        EXPECT_TRUE(check.remark.starts_with("no moments with an error that holds: only "));
    }
    EXPECT_EQ(convergence.converged(), nullptr);
}

TEST(AssistedConvergence, WhereTheModelSaysNothingThePlainErrorsAreJudged) {
    KnownResponse noise{"noise", 2, [](std::span<const double>) { return 1.0; }, 0.2, 1};
    const auto campaign = ask_known(noise, 104, 1);
    AssistedConvergence convergence(settings(0.01), space());
    const Checkpoint& check = look(convergence, campaign);
    auto plain = settings(0.01, 104);
    plain.rule = ConvergenceRule::replicates;
    const auto expected = judge_convergence(plain, numbers(104), campaign.values, 104).front();
    EXPECT_EQ(check.of(Statistic::mean).error, expected.of(Statistic::mean).error);
    EXPECT_EQ(check.of(Statistic::sd).error, expected.of(Statistic::sd).error);
    EXPECT_TRUE(check.remark.starts_with("the plain estimates stand: "));
}

TEST(AssistedConvergence, WrongSettingsAreRefused) {
    const auto refused = [](auto change) {
        auto wrong = settings(0.01);
        auto what = space();
        change(wrong, what);
        EXPECT_THROW(AssistedConvergence(wrong, what), std::invalid_argument);
    };
    refused([](auto& s, auto&) { s.rule = ConvergenceRule::replicates; });
    refused([](auto& s, auto&) { s.sequences = 3; });
    refused([](auto& s, auto&) { s.gates = {Statistic::skewness}; });
    refused([](auto& s, auto&) { s.gates.clear(); });
    refused([](auto& s, auto&) { s.tolerance = 0; });
    refused([](auto&, auto& what) { what.dimensions = 0; });
    EXPECT_THROW(Convergence{settings(0.01)}, std::invalid_argument);
}

}  // namespace grainsweep::tests::stats_assisted_convergence_test
