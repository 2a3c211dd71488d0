// Coverage and actual errors of plain and model-assisted moments: five responses with known moments, 100 campaigns
// each; minutes: slow_assisted. GRAINSWEEP_CAMPAIGNS sets another number, GRAINSWEEP_CASES another size.
// With GRAINSWEEP_WRITE_DOCUMENTS the table of docs/coverage.md is written to tests/reference/measured/assisted.csv.
#include "tests/support/known_responses.hpp"
#include "tests/support/measured.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <variant>
#include <vector>

using namespace grainsweep::stats;
using namespace grainsweep::tests;

namespace {

/// Of one estimator of one statistic over the campaigns.
struct Tally {
    int covered = 0, asked = 0;
    std::vector<double> misses, widths;
    void add(const AssistedEstimate& e, double truth) {
        if (std::isnan(e.value)) return;
        ++asked;
        covered += std::abs(e.value - truth) <= e.half_width ? 1 : 0;
        misses.push_back(std::abs(e.value - truth));
        widths.push_back(e.half_width);
    }
    [[nodiscard]] double coverage() const { return static_cast<double>(covered) / asked; }
    /// 95 % quantile of the actual errors.
    [[nodiscard]] double actual() {
        std::ranges::sort(misses);
        return misses[std::min(misses.size() - 1, static_cast<std::size_t>(0.95 * static_cast<double>(misses.size())))];
    }
    [[nodiscard]] double mean_width() const {
        double sum = 0;
        for (const double w : widths) sum += w / static_cast<double>(widths.size());
        return sum;
    }
};

std::int64_t setting(const char* name, std::int64_t otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::atoll(text);
}

void count(const KnownResponse& response, std::int64_t n, std::uint64_t campaigns) {
    const auto with = true_statistics(response, true), without = true_statistics(response, false);
    auto integration = integration_points(response.dimensions, 12);
    const std::vector<double> noise{response.noise * response.noise};
    std::array<std::array<Tally, 4>, 4> tallies;  // plain, assisted, without scatter, chosen
    for (std::uint64_t seed = 1; seed <= campaigns; ++seed) {
        const auto c = ask_known(response, n, seed);
        if (response.noise == 0) integration = integration_points(response.dimensions, 12, seed);  // their error counts
        const auto answer = assisted_moments(
            {{c.points, response.dimensions}, c.values, c.sequences, {integration, response.dimensions}, 8, noise, 0});
        ASSERT_TRUE(std::holds_alternative<AssistedMoments>(answer));
        const auto& a = std::get<AssistedMoments>(answer);
        for (std::size_t k = 0; k < 4; ++k) {
            tallies[0][k].add(a.statistics[k].plain, with[k]);
            tallies[1][k].add(a.statistics[k].assisted, with[k]);
            if (response.name != "noise") tallies[2][k].add(a.statistics[k].without_scatter, without[k]);
            tallies[3][k].add(a.statistics[k].chosen(), with[k]);
        }
    }
    const char* const estimators[] = {"plain", "assisted", "without_scatter", "chosen"};
    for (std::size_t e = 0; e < tallies.size(); ++e)
        for (std::size_t k = 0; k < 4; ++k) {
            auto& t = tallies[e][k];
            if (t.asked == 0) continue;
            std::printf(
                "{\"response\": \"%s\", \"cases\": %lld, \"estimator\": \"%s\", \"statistic\": \"%s\", \"campaigns\": "
                "%d, "
                "\"covered\": %d, \"actual_95\": %.5f, \"half_width\": %.5f, \"truth\": %.5f}\n",
                response.name.c_str(), static_cast<long long>(n), estimators[e],
                std::string(to_string(assisted_statistics[k])).c_str(), t.asked, t.covered, t.actual(), t.mean_width(),
                e == 2 ? without[k] : with[k]);
            std::fflush(stdout);
            // Three standard errors of a share of 0.95 over the campaigns.
            if (e == 1 || e == 2) {
                EXPECT_GE(t.coverage(), 0.95 - 3 * std::sqrt(0.95 * 0.05 / t.asked)) << response.name << " " << k;
            }
        }
    std::vector<std::string> row = {response.name, fmt::format("{}", n)};
    for (std::size_t k = 0; k < 4; ++k) {
        auto &plain = tallies[0][k], &assisted = tallies[1][k];
        row.push_back(fmt::format("{:.2g} ({}) / {:.2g} ({})", plain.actual(), plain.covered, assisted.actual(),
                                  assisted.covered));
    }
    remember_measured("assisted", {"response", "cases", "mean", "sd", "g1", "kurtosis"}, {row}, 2);
}

}  // namespace

class Coverage : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Coverage, OfAssistedMomentsHolds) {
    const auto campaigns = static_cast<std::uint64_t>(setting("GRAINSWEEP_CAMPAIGNS", 100));
    const std::int64_t only = setting("GRAINSWEEP_CASES", 0);
    for (const std::int64_t n : {104, 400})
        if (only == 0 || only == n) count(known_responses()[GetParam()], n, campaigns);
}

INSTANTIATE_TEST_SUITE_P(AssistedMoments, Coverage, ::testing::Range(std::size_t{0}, std::size_t{6}),
                         [](const auto& response) { return known_responses()[response.param].name; });
