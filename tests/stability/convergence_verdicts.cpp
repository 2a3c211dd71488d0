// Verdicts over many campaigns: how often a campaign is found to have converged on a mean that is off by more than the
// tolerance. Samples over levels that are few runs asked again and again, rare events, responses that are constant over
// a stretch of the design, and, to compare with, ordinary responses.
#include "stats/random.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/schedule/judge.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace grainsweep::tests::convergence_verdicts_test {

constexpr int campaigns = 200;
const std::string halton = R"({"kind": "halton", "sequences": 8, "points": 4096})";

using Response = std::function<double(const Inputs&, std::uint64_t seed)>;

double number(const Inputs& inputs, std::string_view name) {
    return std::get<double>(inputs.find(name)->second);
}

/// Scatter of a single run: uniform, of standard deviation sigma.
double scatter(std::uint64_t seed, double sigma) {
    return sigma * std::sqrt(12.0) * (stats::Stream(seed, 0).uniform(0) - 0.5);
}

struct Tally {
    int converged = 0, wrong = 0;
};

/// Runs the design to its verdict, with one answer for each case, under seeds 1, 2, ...
Tally count_verdicts(const std::string& factors, const std::string& rule, double tolerance, double truth,
                     const Response& response) {
    Tally tally;
    for (int seed = 1; seed <= campaigns; ++seed) {
        const auto campaign = campaign::parse_campaign(
            fmt::format(R"({{"campaign": "v", "scene": "rehearsal", "seed": {}, "factors": {}, "design": {},
                "convergence": {{"observable": "y", "rule": "{}", "gates": ["mean"], "tolerance": {}, "block": 32}}}})",
                        seed, factors, halton, rule, tolerance),
            std::filesystem::temp_directory_path());
        const auto cases = campaign::unfold(campaign, {});
        std::vector<double> values;
        for (std::size_t i = 0; i < cases.size(); ++i) {
            const auto question = cases.question(i);
            values.push_back(response(question.inputs, question.seed));
        }
        const auto sequences = designs::independent_sequences(campaign.design, campaign.request);
        schedule::Judge judge(*campaign.convergence, cases, static_cast<std::size_t>(sequences), values);
        const auto rows = judge.judge(cases.size());
        if (!judge.converged_at()) continue;
        ++tally.converged;
        if (std::abs(rows.back().mean - truth) > tolerance * std::abs(truth)) ++tally.wrong;
    }
    testing::Test::RecordProperty("converged", tally.converged);
    testing::Test::RecordProperty("wrong", tally.wrong);
    return tally;
}

const std::string two_ranges = R"([{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}])";
const std::string six_cases = R"([{"name": "x1", "levels": [0, 1]}, {"name": "x2", "levels": [0, 0.5, 1]}])";

TEST(Verdicts, SixRunsAreNeverKnownToAFewPercent) {
    const Response noisy = [](const Inputs&, std::uint64_t seed) { return 1 + scatter(seed, 0.5); };
    for (const auto* rule : {"replicates", "any_change", "all_change"})
        EXPECT_EQ(count_verdicts(six_cases, rule, 0.05, 1, noisy).converged, 0) << rule;
}

TEST(Verdicts, ARareEventIsNotMissedForWantOfScatter) {
    const Response rare = [](const Inputs& inputs, std::uint64_t) {
        return number(inputs, "x1") > 0.995 ? 101.0 : 1.0;
    };
    const auto tally = count_verdicts(two_ranges, "replicates", 0.2, 1.5, rare);
    EXPECT_LE(tally.wrong, campaigns / 20) << tally.converged << " converged";
}

TEST(Verdicts, AConstantStretchIsNoVerdict) {
    // Two per cent of the box alone answer otherwise, and there the runs scatter. Repeated looks at 95 % intervals of
    // so skewed a response raise the error rate above 5 %.
    const Response corner = [](const Inputs& inputs, std::uint64_t seed) {
        return number(inputs, "x1") + number(inputs, "x2") > 1.8 ? 50 + scatter(seed, 20) : 0.0;
    };
    const auto tally = count_verdicts(two_ranges, "replicates", 0.2, 1, corner);
    EXPECT_LE(tally.wrong, campaigns / 10) << tally.converged << " converged";
}

TEST(Verdicts, OrdinaryResponsesConvergeAndAreRight) {
    const Response smooth = [](const Inputs& inputs, std::uint64_t seed) {
        return 1 + number(inputs, "x1") * number(inputs, "x2") + scatter(seed, 0.2);
    };
    const auto tally = count_verdicts(two_ranges, "replicates", 0.05, 1.25, smooth);
    EXPECT_EQ(tally.converged, campaigns);
    EXPECT_LE(tally.wrong, campaigns / 20);
}

}  // namespace grainsweep::tests::convergence_verdicts_test
