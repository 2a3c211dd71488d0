// Coverage of the 95 % intervals of mean, sd, g1 and kurtosis in 8 random Halton sequences, 200 campaigns of each
// response; seconds: slow_moments. GRAINSWEEP_CAMPAIGNS sets another number of campaigns. One line of JSON for each
// figure: how often the interval is given, and how often one that is given misses the truth. With
// GRAINSWEEP_WRITE_DOCUMENTS the table of docs/coverage.md is written to tests/reference/measured/moments.csv.
#include "stats/convergence.hpp"
#include "tests/support/known_responses.hpp"
#include "tests/support/measured.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <span>
#include <vector>

using namespace grainsweep::stats;
using namespace grainsweep::tests;

namespace {

int campaigns() {
    const char* text = std::getenv("GRAINSWEEP_CAMPAIGNS");
    return text == nullptr ? 200 : std::atoi(text);
}

/// Those of known_responses(), and four whose shape a few values far from the mean decide.
std::vector<KnownResponse> judged_responses() {
    using Point = std::span<const double>;
    auto responses = known_responses();
    responses.push_back({"product", 3, [](Point u) { return u[0] * u[1] * u[2]; }, 0, 200});
    responses.push_back({"exponential", 4, [](Point u) { return std::exp(1.5 * (u[0] + u[1] + u[2] + u[3])); }, 0, 64});
    responses.push_back({"waiting time", 1, [](Point u) { return -std::log(u[0]); }, 0, 1 << 20});
    responses.push_back({"corner", 3, [](Point u) { return u[0] > 0.95 ? 1 + u[1] : 0.1 * u[2]; }, 0, 200});
    return responses;
}

struct ShapeTally {
    int given = 0, held = 0;
};

Checkpoint check_of(const KnownCampaign& campaign) {
    std::vector<std::int64_t> points(campaign.values.size());
    std::iota(points.begin(), points.end(), 0);
    const auto n = static_cast<std::int64_t>(points.size());
    return judge_convergence({.block = n, .sequences = 8}, points, campaign.values, n).front();
}

void count(const KnownResponse& response, std::int64_t each) {
    std::vector<std::string> row = {response.name, fmt::format("{}", each)};
    const auto truth = true_statistics(response, true);
    const std::array judged = {Statistic::mean, Statistic::sd, Statistic::g1, Statistic::kurtosis};
    std::array<ShapeTally, 4> tallies;
    for (int seed = 1; seed <= campaigns(); ++seed) {
        const auto check = check_of(ask_known(response, 8 * each, static_cast<std::uint64_t>(seed)));
        for (std::size_t k = 0; k < judged.size(); ++k) {
            const auto& estimate = check.of(judged[k]);
            if (std::isnan(estimate.error)) continue;
            ++tallies[k].given;
            tallies[k].held += std::abs(estimate.value - truth[k]) <= estimate.error ? 1 : 0;
        }
    }
    for (std::size_t k = 0; k < judged.size(); ++k) {
        const double given = static_cast<double>(tallies[k].given) / campaigns();
        const double missed = given - static_cast<double>(tallies[k].held) / campaigns();
        std::printf(
            "{\"response\": \"%s\", \"points_per_sequence\": %lld, \"statistic\": \"%s\", \"given\": %.3f, "
            "\"given_and_missed\": %.3f, \"truth\": %.5g}\n",
            response.name.c_str(), static_cast<long long>(each), std::string(to_string(judged[k])).c_str(), given,
            missed, truth[k]);
        EXPECT_LE(missed, 0.1 + 2 * std::sqrt(0.09 / campaigns())) << response.name << ' ' << to_string(judged[k]);
        row.push_back(given == 1 ? fmt::format("{:.3g} %", 100 * missed)
                                 : fmt::format("{:.3g} % of {:.3g} %", 100 * missed, 100 * given));
    }
    if (each == 32 || each == 300)
        remember_measured(
            "moments", {"response", "points per sequence", "mean misses", "sd misses", "g1 misses", "kurtosis misses"},
            {row}, 2);
    std::fflush(stdout);
}

TEST(SlowMoments, IntervalsThatAreGivenHold) {
    for (const auto& response : judged_responses())
        for (const std::int64_t each : {16, 32, 64, 300}) count(response, each);
}

}  // namespace
