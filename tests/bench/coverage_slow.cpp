// Coverage of the 95 % intervals of mean, sd, Pearson's skewness, g1 and kurtosis over campaigns of known responses,
// plain and with a model, and how often the rule `replicates` stops too early; minutes: slow_coverage.
// GRAINSWEEP_CAMPAIGNS sets another number of campaigns than 200. One line of JSON for each figure. With
// GRAINSWEEP_WRITE_DOCUMENTS the tables of docs/coverage.md are written to tests/reference/measured.
#include "stats/assisted_moments.hpp"
#include "stats/convergence.hpp"
#include "stats/response_model.hpp"
#include "tests/support/judged_responses.hpp"
#include "tests/support/measured.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <span>
#include <string>
#include <variant>
#include <vector>

using namespace grainsweep::stats;
using namespace grainsweep::tests;

namespace {

constexpr double rounding = 1e-9;

std::uint64_t campaigns() {
    const char* text = std::getenv("GRAINSWEEP_CAMPAIGNS");
    return text == nullptr ? 200 : std::strtoull(text, nullptr, 10);
}

bool chosen(const std::string& name) {
    const char* text = std::getenv("GRAINSWEEP_RESPONSE");
    return text == nullptr || name == text;
}

/// Of one interval over the campaigns.
struct Tally {
    std::uint64_t given = 0, held = 0;
    double width = 0;

    void add(double value, double error, double truth) {
        if (!std::isfinite(value) || !std::isfinite(error)) return;
        ++given;
        held += std::abs(value - truth) <= error + rounding * std::abs(truth) ? 1 : 0;
        width += error;
    }
    [[nodiscard]] std::string text() const {
        if (given == 0) return "none";
        const double share = static_cast<double>(held) / static_cast<double>(given);
        const double part = static_cast<double>(given) / static_cast<double>(campaigns());
        return part == 1 ? fmt::format("{:.3g}", share) : fmt::format("{:.2g} of {:.2g}", share, part);
    }
    void print(const std::string& what, Statistic statistic, double truth) const {
        std::printf(
            "{%s, \"statistic\": \"%s\", \"given\": %.3f, \"held\": %.3f, \"half_width\": %.4g, \"truth\": %.5g}\n",
            what.c_str(), std::string(to_string(statistic)).c_str(),
            static_cast<double>(given) / static_cast<double>(campaigns()),
            given == 0 ? NAN : static_cast<double>(held) / static_cast<double>(given),
            given == 0 ? NAN : width / static_cast<double>(given), truth);
    }
    void expect(double least, const std::string& what) const {
        const auto n = static_cast<double>(given);
        if (n < 20) return;
        EXPECT_GE(static_cast<double>(held) / n, least - 2.5 * std::sqrt(least * (1 - least) / n)) << what;
    }
};

Checkpoint check_of(const JudgedCampaign& campaign) {
    std::vector<std::int64_t> points(campaign.values.size());
    std::iota(points.begin(), points.end(), 0);
    const auto n = static_cast<std::int64_t>(points.size());
    return judge_convergence({.block = n, .sequences = 8}, points, campaign.values, n).front();
}

void count_plain(const JudgedResponse& response, const std::string& design, std::int64_t n) {
    std::array<Tally, statistics.size()> tallies;
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        const auto check = check_of(ask_judged(response, design, n, seed));
        for (std::size_t k = 0; k < statistics.size(); ++k)
            tallies[k].add(check.of(statistics[k]).value, check.of(statistics[k]).error, response.truth[k]);
    }
    std::vector<std::string> row = {response.name, fmt::format("{}", n)};
    for (std::size_t k = 0; k < statistics.size(); ++k) {
        const auto what =
            fmt::format("\"response\": \"{}\", \"design\": \"{}\", \"cases\": {}", response.name, design, n);
        tallies[k].print(what, statistics[k], response.truth[k]);
        tallies[k].expect(0.92, what + ' ' + std::string(to_string(statistics[k])));
        row.push_back(tallies[k].text());
    }
    std::fflush(stdout);
    if (design == "halton" && (n == 128 || n == 512 || n == 2048))
        remember_measured("moments", {"response", "cases", "mean", "sd", "skewness", "g1", "kurtosis"}, {row}, 2);
}

void count_assisted(const JudgedResponse& response, std::int64_t n) {
    const auto integration = integration_of(response, 13, 4);
    std::array<Tally, assisted_statistics.size()> with, taken;
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        const auto campaign = ask_judged(response, "halton", n, seed);
        AssistedSettings settings;
        settings.low = integration.low;
        settings.high = integration.high;
        const auto answer = assisted_moments({{campaign.features, response.dimensions},
                                              campaign.values,
                                              campaign.sequences,
                                              {integration.features, response.dimensions},
                                              4},
                                             settings);
        const auto* moments = std::get_if<AssistedMoments>(&answer);
        if (moments == nullptr) continue;
        for (std::size_t k = 0; k < assisted_statistics.size(); ++k) {
            const auto& one = moments->statistics[k];
            const double truth = response.truth[static_cast<std::size_t>(assisted_statistics[k])];
            if (one.withdrawn) continue;
            with[k].add(one.assisted.value, one.assisted.half_width, truth);
            if (one.takes_assisted) taken[k].add(one.assisted.value, one.assisted.half_width, truth);
        }
    }
    std::vector<std::string> row = {response.name, fmt::format("{}", n)};
    for (std::size_t k = 0; k < assisted_statistics.size(); ++k) {
        const double truth = response.truth[static_cast<std::size_t>(assisted_statistics[k])];
        const auto what = fmt::format("\"response\": \"{}\", \"cases\": {}", response.name, n);
        with[k].print(what + ", \"with\": \"model\"", assisted_statistics[k], truth);
        taken[k].print(what + ", \"with\": \"model taken\"", assisted_statistics[k], truth);
        with[k].expect(0.92, what + " with a model " + std::string(to_string(assisted_statistics[k])));
        row.push_back(with[k].text());
    }
    std::fflush(stdout);
    remember_measured("assisted_moments", {"response", "cases", "mean", "sd", "g1", "kurtosis"}, {row}, 2);
}

/// Levels whose intervals are counted: two probabilities beyond a quantile of the truth, and quantiles.
struct CountedLevel {
    Level level;
    double truth = 0;
    std::string name;
};

std::vector<CountedLevel> counted_levels(const JudgedResponse& response) {
    auto values = dense_values(response);
    std::ranges::sort(values);
    std::vector<CountedLevel> counted;
    const auto at = [&](double q) { return values[static_cast<std::size_t>(q * static_cast<double>(values.size()))]; };
    for (const double q : {0.05, 0.5, 0.95}) counted.push_back({Quantile{q}, at(q), fmt::format("{}", q)});
    for (const double q : {0.5, 0.9}) {
        const auto beyond = std::ranges::end(values) - std::ranges::upper_bound(values, at(q));
        counted.push_back({Exceedance{at(q), true}, static_cast<double>(beyond) / static_cast<double>(values.size()),
                           fmt::format("P(y > q{})", q)});
    }
    return counted;
}

void print_level(const Tally& tally, const JudgedResponse& response, std::int64_t n, const CountedLevel& one,
                 const std::string& how) {
    std::printf(
        "{\"response\": \"%s\", \"cases\": %lld, \"how\": \"%s\", \"level\": \"%s\", \"given\": %.3f, \"held\": %.3f, "
        "\"half_width\": %.4g, \"truth\": %.5g}\n",
        response.name.c_str(), static_cast<long long>(n), how.c_str(), one.name.c_str(),
        static_cast<double>(tally.given) / static_cast<double>(campaigns()),
        tally.given == 0 ? NAN : static_cast<double>(tally.held) / static_cast<double>(tally.given),
        tally.given == 0 ? NAN : tally.width / static_cast<double>(tally.given), one.truth);
    std::fflush(stdout);
    tally.expect(0.92, response.name + ' ' + how + ' ' + one.name + fmt::format(" at {} cases", n));
}

std::vector<std::string> level_columns(std::span<const CountedLevel> counted) {
    std::vector<std::string> columns = {"response", "cases"};
    for (const auto& one : counted) columns.push_back(one.name);
    return columns;
}

void count_levels(const JudgedResponse& response, std::span<const CountedLevel> counted, const std::string& design,
                  std::int64_t n) {
    std::vector<Tally> tallies(counted.size());
    ConvergenceSettings settings{.block = n, .sequences = 8};
    for (const auto& one : counted) settings.gates.emplace_back(one.level);
    std::vector<std::int64_t> points(static_cast<std::size_t>(n));
    std::iota(points.begin(), points.end(), 0);
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        const auto check = judge_convergence(settings, points, ask_judged(response, design, n, seed).values, n).front();
        for (std::size_t k = 0; k < counted.size(); ++k) {
            const auto& estimate = check.of(Gate{counted[k].level});
            tallies[k].add(estimate.value, estimate.error, counted[k].truth);
        }
    }
    std::vector<std::string> row = {response.name, fmt::format("{}", n)};
    for (std::size_t k = 0; k < counted.size(); ++k) {
        print_level(tallies[k], response, n, counted[k], design);
        row.push_back(tallies[k].text());
    }
    if (design == "halton") remember_measured("levels", level_columns(counted), {row}, 2);
}

void count_assisted_levels(const JudgedResponse& response, std::int64_t n) {
    const auto integration = integration_of(response, 11, 4);
    const auto counted = counted_levels(response);
    std::vector<Level> levels;
    for (const auto& one : counted) levels.push_back(one.level);
    std::vector<Tally> tallies(counted.size());
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        const auto campaign = ask_judged(response, "halton", n, seed);
        AssistedSettings settings;
        settings.low = integration.low;
        settings.high = integration.high;
        settings.levels = levels;
        const auto answer = assisted_moments({{campaign.features, response.dimensions},
                                              campaign.values,
                                              campaign.sequences,
                                              {integration.features, response.dimensions},
                                              4},
                                             settings);
        const auto* moments = std::get_if<AssistedMoments>(&answer);
        if (moments == nullptr) continue;
        for (std::size_t k = 0; k < moments->levels.size(); ++k)
            tallies[k].add(moments->levels[k].value, moments->levels[k].error, counted[k].truth);
    }
    std::vector<std::string> row = {response.name, fmt::format("{}", n)};
    for (std::size_t k = 0; k < counted.size(); ++k) {
        print_level(tallies[k], response, n, counted[k], "model");
        row.push_back(tallies[k].text());
    }
    remember_measured("assisted_levels", level_columns(counted), {row}, 2);
}

/// Share of campaigns that stop with a gate farther from the truth than the tolerance, and of those that stop at all.
std::string count_stops(const JudgedResponse& response, std::int64_t block, double tolerance) {
    constexpr std::int64_t most = 4096;
    std::uint64_t stopped = 0, wrong = 0;
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        const auto campaign = ask_judged(response, "halton", most, seed);
        std::vector<std::int64_t> points(campaign.values.size());
        std::iota(points.begin(), points.end(), 0);
        const ConvergenceSettings settings{
            .gates = {Statistic::mean, Statistic::sd}, .tolerance = tolerance, .block = block, .sequences = 8};
        const auto checks = judge_convergence(settings, points, campaign.values, most);
        const auto end = std::ranges::find(checks, true, &Checkpoint::converged);
        if (end == checks.end()) continue;
        ++stopped;
        const bool misses = std::ranges::any_of(settings.gates, [&](const Gate& gate) {
            const double truth = response.truth[static_cast<std::size_t>(std::get<Statistic>(gate))];
            return measure_of(gate, std::abs(end->of(gate).value - truth), truth) > tolerance;
        });
        wrong += misses ? 1 : 0;
    }
    std::printf("{\"response\": \"%s\", \"block\": %lld, \"tolerance\": %.2g, \"stopped\": %.3f, \"false\": %.3f}\n",
                response.name.c_str(), static_cast<long long>(block), tolerance,
                static_cast<double>(stopped) / static_cast<double>(campaigns()),
                static_cast<double>(wrong) / static_cast<double>(campaigns()));
    std::fflush(stdout);
    const auto percent = [](std::uint64_t count) {
        return 100 * static_cast<double>(count) / static_cast<double>(campaigns());
    };
    return stopped == campaigns() ? fmt::format("{:.3g} %", percent(wrong))
                                  : fmt::format("{:.3g} % of {:.3g} %", percent(wrong), percent(stopped));
}

/// Share of 40 fresh settings a campaign at which the interval of the predicted mean holds the response.
/// `repeated`: so many settings are run twice.
void count_predictions(const JudgedResponse& response, std::int64_t n, std::size_t repeated) {
    const auto box = integration_of(response, 9, 1);
    ResponseModelOptions options;
    options.low = box.low;
    options.high = box.high;
    std::uint64_t fitted = 0, asked = 0, held = 0;
    for (std::uint64_t seed = 1; seed <= campaigns(); ++seed) {
        auto campaign = ask_judged(response, "halton", n, seed);
        for (std::size_t i = 0; i < repeated; ++i) {
            for (std::size_t j = 0; j < response.dimensions; ++j)
                campaign.features.push_back(campaign.features[i * response.dimensions + j]);
            campaign.values.push_back(campaign.values[i]);
        }
        const auto fit = fit_response({campaign.features, response.dimensions}, campaign.values, options);
        const auto* model = std::get_if<ResponseModel>(&fit);
        if (model == nullptr) continue;
        ++fitted;
        const auto fresh = ask_design("random", response.dimensions, {{"points", std::int64_t{40}}}, seed + 1000);
        for (std::size_t i = 0; i < fresh.size(); ++i) {
            const auto features = response.features(fresh.point(i));
            const auto predicted = model->predict(Rows{features, response.dimensions}).front();
            const double slip = rounding * std::max(std::abs(predicted.mean), 1.0);
            ++asked;
            held += std::abs(response.mean(features) - predicted.mean) <= predicted.mean_half_width() + slip ? 1 : 0;
        }
    }
    const double share = static_cast<double>(held) / static_cast<double>(asked);
    const double given = static_cast<double>(fitted) / static_cast<double>(campaigns());
    const std::string cell = fitted == 0             ? "none"
                             : fitted == campaigns() ? fmt::format("{:.3g}", share)
                                                     : fmt::format("{:.3g} of {:.2g}", share, given);
    const auto name = repeated == 0 ? response.name : fmt::format("{}, {} settings twice", response.name, repeated);
    std::printf("{\"response\": \"%s\", \"cases\": %lld, \"predicted means\": \"%s\"}\n", name.c_str(),
                static_cast<long long>(n), cell.c_str());
    remember_measured("predictions", {"response", "cases", "mean within its interval"},
                      {{name, fmt::format("{}", n), cell}}, 2);
}

TEST(SlowCoverage, OfPredictedMeans) {
    for (const auto& response : judged_responses()) {
        if (!chosen(response.name)) continue;
        for (const std::int64_t n : {64, 256})
            for (const std::size_t repeated : {0, 3})
                if (repeated == 0 || !(response.noise > 0)) count_predictions(response, n, repeated);
    }
}

TEST(SlowCoverage, OfPlainMoments) {
    for (const auto& response : judged_responses()) {
        if (!chosen(response.name)) continue;
        for (const std::int64_t n : {128, 512, 2048, 2400}) count_plain(response, "halton", n);
        for (const std::int64_t n : {256, 2048}) count_plain(response, "sobol", n);
    }
}

TEST(SlowCoverage, OfLevels) {
    for (const auto& response : judged_responses()) {
        if (!chosen(response.name)) continue;
        const auto counted = counted_levels(response);
        for (const std::int64_t n : {128, 512, 2048}) count_levels(response, counted, "halton", n);
        count_levels(response, counted, "sobol", 256);
    }
}

TEST(SlowCoverage, OfLevelsWithAModel) {
    for (const auto& response : judged_responses())
        if (chosen(response.name)) count_assisted_levels(response, 128);
}

TEST(SlowCoverage, OfMomentsWithAModel) {
    for (const auto& response : judged_responses()) {
        if (!chosen(response.name)) continue;
        for (const std::int64_t n : {std::getenv("N") ? std::atoll(std::getenv("N")) : 128})
            count_assisted(response, n);
    }
}

TEST(SlowCoverage, OfStopsByReplicates) {
    for (const auto& response : judged_responses()) {
        if (!chosen(response.name)) continue;
        std::vector<std::string> row = {response.name};
        for (const std::int64_t block : {64, 256})
            for (const double tolerance : {0.05, 0.02}) row.push_back(count_stops(response, block, tolerance));
        remember_measured("stops", {"response", "block 64, 5 %", "block 64, 2 %", "block 256, 5 %", "block 256, 2 %"},
                          {row}, 1);
    }
}

}  // namespace
