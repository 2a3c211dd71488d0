// Coverage of the 95 % intervals of moments and indices where factors follow distributions: 200 campaigns each of a
// plane, the Ishigami function and the flow through a borehole; minutes: slow_distributions. GRAINSWEEP_CAMPAIGNS sets
// another number of campaigns. One line of JSON for each figure. With
// GRAINSWEEP_WRITE_DOCUMENTS the table of docs/coverage.md is written to tests/reference/measured/distributions.csv.
#include "stats/assisted_moments.hpp"
#include "stats/convergence.hpp"
#include "stats/distribution.hpp"
#include "stats/model_indices.hpp"
#include "stats/sensitivity.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/measured.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <map>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

using namespace grainsweep::stats;
using namespace grainsweep::tests;

namespace {

constexpr std::size_t parts = 8;

std::uint64_t campaigns() {
    const char* text = std::getenv("GRAINSWEEP_CAMPAIGNS");
    return text == nullptr ? 200 : std::strtoull(text, nullptr, 10);
}

struct Problem {
    std::string name;
    std::vector<Distribution> factors;
    std::function<double(std::span<const double>)> response;
    std::int64_t cases;

    [[nodiscard]] std::size_t dimensions() const { return factors.size(); }
    [[nodiscard]] std::vector<double> values_at(std::span<const double> points) const {
        std::vector<double> x;
        for (std::size_t i = 0; i < points.size(); ++i) x.push_back(factors[i % dimensions()].quantile(points[i]));
        return x;
    }
};

/// y of z = pi (2 x - 1).
double ishigami(std::span<const double> x) {
    const auto z = [&](std::size_t j) { return std::numbers::pi * (2 * x[j] - 1); };
    return std::sin(z(0)) + 7 * std::pow(std::sin(z(1)), 2) + 0.1 * std::pow(z(2), 4) * std::sin(z(0));
}

/// Water through a borehole, m3/year (Harper & Gupta 1983): radius of the borehole and of influence in m, heads of the
/// aquifers in m, length in m, conductivity in m/year; transmissivities 89,335 and 89.55 m2/year.
double borehole(std::span<const double> x) {
    constexpr double upper = 89335, lower = 89.55;
    const double ratio = std::log(x[1] / x[0]);
    return 2 * std::numbers::pi * upper * (x[2] - x[3]) /
           (ratio * (1 + 2 * x[4] * upper / (ratio * x[0] * x[0] * x[5]) + upper / lower));
}

std::vector<Problem> problems() {
    const Distribution normal(Normal{0.5, 0.12}, 0, 1), triangular(Triangular{0, 0.5, 1});
    return {{"plane: normal, triangular",
             {Distribution(Normal{0.5, 0.1}, 0, 1), Distribution(Triangular{0.2, 0.4, 0.9})},
             [](std::span<const double> x) { return 1 + 2 * x[0] + 3 * x[1]; },
             128},
            {"Ishigami: normal", {normal, normal, normal}, ishigami, 256},
            {"Ishigami: triangular", {triangular, triangular, triangular}, ishigami, 256},
            {"borehole: normal, lognormal, triangular, beta",
             {Distribution(Normal{0.1, 0.0161812}, 0.05, 0.15), Distribution(Lognormal{2226, 1.0056}, 100, 50'000),
              Distribution(Triangular{990, 1050, 1110}), Distribution(Triangular{700, 740, 820}),
              Distribution(Beta{1120, 1680, 2, 3}), Distribution(Normal{10'950, 400})},
             borehole,
             256}};
}

struct Truth {
    double mean = 0, sd = 0;
    std::vector<double> first, total;
};

/// By 2^17 base points of scrambled Sobol sequences and, for each factor, as many with its column from a second
/// sequence: 1.0e6 points for six factors (Saltelli et al. 2010, Jansen 1999).
Truth truth_of(const Problem& problem) {
    const std::size_t d = problem.dimensions();
    constexpr std::int64_t n = 1 << 17;
    const auto set = ask_design("sobol", 2 * d, {{"points", n}, {"scramble", std::string("random")}}, 12345);
    std::vector<double> a, b;
    for (std::size_t i = 0; i < set.size(); ++i) {
        const auto point = set.point(i);
        for (std::size_t j = 0; j < d; ++j) {
            a.push_back(problem.factors[j].quantile(point[j]));
            b.push_back(problem.factors[j].quantile(point[d + j]));
        }
    }
    std::vector<double> of_a, of_b;
    for (std::size_t i = 0; i < set.size(); ++i) {
        of_a.push_back(problem.response(std::span(a).subspan(i * d, d)));
        of_b.push_back(problem.response(std::span(b).subspan(i * d, d)));
    }
    Truth truth;
    for (const double y : of_a) truth.mean += y / static_cast<double>(n);
    double variance = 0;
    for (const double y : of_a) variance += (y - truth.mean) * (y - truth.mean) / static_cast<double>(n);
    truth.sd = std::sqrt(variance);
    for (std::size_t j = 0; j < d; ++j) {
        double first = 0, total = 0;
        for (std::size_t i = 0; i < set.size(); ++i) {
            std::vector<double> x(a.begin() + static_cast<std::ptrdiff_t>(i * d),
                                  a.begin() + static_cast<std::ptrdiff_t>((i + 1) * d));
            x[j] = b[i * d + j];
            const double y = problem.response(x);
            first += (of_b[i] - truth.mean) * (y - of_a[i]) / static_cast<double>(n);
            total += (y - of_a[i]) * (y - of_a[i]) / (2 * static_cast<double>(n));
        }
        truth.first.push_back(first / variance);
        truth.total.push_back(total / variance);
    }
    return truth;
}

struct Tally {
    int covered = 0, asked = 0;
    double truth = 0, miss = 0, width = 0;
};

/// Of the figures of one problem, by their name.
class Tallies {
public:
    void add(const std::string& name, double value, double half_width, double truth) {
        if (!std::isfinite(value) || !std::isfinite(half_width)) return;
        Tally& t = tallies_[name];
        ++t.asked;
        t.truth = truth;
        t.covered += std::abs(value - truth) <= half_width + 1e-12 ? 1 : 0;
        t.miss += value - truth;
        t.width += half_width;
    }
    void print(const Problem& problem) const {
        for (const auto& [name, t] : tallies_) {
            std::printf(
                "{\"response\": \"%s\", \"cases\": %lld, \"figure\": \"%s\", \"campaigns\": %d, \"covered\": %.3f, "
                "\"truth\": %.5g, \"mean_error\": %.3g, \"half_width\": %.3g}\n",
                problem.name.c_str(), static_cast<long long>(problem.cases), name.c_str(), t.asked,
                static_cast<double>(t.covered) / t.asked, t.truth, t.miss / t.asked, t.width / t.asked);
            EXPECT_GE(static_cast<double>(t.covered) / t.asked, 0.9 - 2 * std::sqrt(0.09 / t.asked)) << name;
        }
        std::fflush(stdout);
    }
    [[nodiscard]] std::string share(const std::string& name) const {
        const Tally& t = tallies_.at(name);
        return fmt::format("{:.2g}", static_cast<double>(t.covered) / t.asked);
    }

private:
    std::map<std::string, Tally> tallies_;
};

struct Asked {
    std::string design;
    std::vector<double> points, x, values;  ///< coordinates, factors, answers
    std::vector<std::size_t> groups;
    bool sequences = false;
};

Asked ask(const Problem& problem, const std::string& design, std::uint64_t seed) {
    const bool sequences = design == "halton" || design == "sobol";
    Options options = {{"points", problem.cases}};
    if (sequences) {
        options["sequences"] = std::int64_t{parts};
        options["scramble"] = std::string("random");
    }
    const auto set = ask_design(design, problem.dimensions(), options, seed);
    Asked asked{design, set.coordinates, problem.values_at(set.coordinates), {}, {}, sequences};
    for (std::size_t i = 0; i < set.size(); ++i) {
        asked.values.push_back(
            problem.response(std::span(asked.x).subspan(i * problem.dimensions(), problem.dimensions())));
        asked.groups.push_back(sequences ? i % parts : i * parts / set.size());
    }
    return asked;
}

void count_direct(Tallies& tallies, const Problem& problem, const Truth& truth, const Asked& asked) {
    ConvergenceSettings settings;
    settings.rule = asked.sequences ? ConvergenceRule::replicates : ConvergenceRule::all_change;
    settings.sequences = asked.sequences ? std::int64_t{parts} : 1;
    settings.block = problem.cases;
    std::vector<std::int64_t> points;
    for (std::int64_t i = 0; i < problem.cases; ++i) points.push_back(i);
    const auto all = judge_convergence(settings, points, asked.values, problem.cases).back();
    tallies.add(asked.design + " mean", all.of(Statistic::mean).value, all.of(Statistic::mean).error, truth.mean);
    tallies.add(asked.design + " sd", all.of(Statistic::sd).value, all.of(Statistic::sd).error, truth.sd);
    const auto bins = first_order_indices(asked.x, problem.dimensions(), asked.values, asked.groups,
                                          static_cast<std::size_t>(problem.cases) / 16);
    for (std::size_t j = 0; j < problem.dimensions(); ++j)
        tallies.add(asked.design + " first, bins", bins.first[j].value, bins.first[j].half_width, truth.first[j]);
}

/// The box of the factors' ranges, in which lengths are measured.
std::pair<std::vector<double>, std::vector<double>> box_of(const Problem& problem) {
    std::pair<std::vector<double>, std::vector<double>> box;
    for (const auto& factor : problem.factors) {
        box.first.push_back(factor.range().first);
        box.second.push_back(factor.range().second);
    }
    return box;
}

void count_models(Tallies& tallies, const Problem& problem, const Truth& truth, const Asked& asked) {
    const std::size_t d = problem.dimensions();
    ResponseModelOptions options;
    std::tie(options.low, options.high) = box_of(problem);
    const auto fit = fit_response({asked.x, d}, asked.values, options);
    if (const auto* model = std::get_if<ResponseModel>(&fit)) {
        const auto found = model_indices(*model, d, asked.groups, [&](Rows u) {
            std::vector<double> points;
            for (std::size_t i = 0; i < u.size(); ++i) points.insert(points.end(), u.row(i).begin(), u.row(i).end());
            return problem.values_at(points);
        });
        for (std::size_t j = 0; j < d; ++j) {
            tallies.add("model first", found.first[j].value, found.first[j].half_width, truth.first[j]);
            tallies.add("model total", found.total[j].value, found.total[j].half_width, truth.total[j]);
        }
    }
    std::vector<double> integration;
    for (std::uint64_t k = 0; k < 8; ++k) {
        const auto set =
            ask_design("sobol", d, {{"points", std::int64_t{1024}}, {"scramble", std::string("random")}}, 1000 + k);
        const auto x = problem.values_at(set.coordinates);
        integration.insert(integration.end(), x.begin(), x.end());
    }
    AssistedSettings settings;
    settings.low = options.low;
    settings.high = options.high;
    const auto moments = assisted_moments({.points = {asked.x, d},
                                           .values = asked.values,
                                           .sequences = asked.groups,
                                           .integration = {integration, d},
                                           .scramblings = 8},
                                          settings);
    if (const auto* assisted = std::get_if<AssistedMoments>(&moments)) {
        const auto &mean = assisted->of(Statistic::mean), &sd = assisted->of(Statistic::sd);
        tallies.add("assisted mean", mean.chosen().value, mean.chosen().half_width, truth.mean);
        tallies.add("assisted sd", sd.chosen().value, sd.chosen().half_width, truth.sd);
    }
}

TEST(SlowDistributions, PlainIntervalsReachTheTruth) {
    for (const auto& problem : problems()) {
        const auto truth = truth_of(problem);
        Tallies tallies;
        const std::vector<std::string> designs = {"halton", "sobol", "latin_hypercube", "random"};
        for (std::uint64_t seed = 1; seed <= campaigns(); ++seed)
            for (const auto& design : designs) count_direct(tallies, problem, truth, ask(problem, design, seed));
        tallies.print(problem);
        std::vector<std::string> row = {problem.name};
        for (const auto& design : designs)
            row.push_back(fmt::format("{}, {}, {}", tallies.share(design + " mean"), tallies.share(design + " sd"),
                                      tallies.share(design + " first, bins")));
        remember_measured(
            "distributions",
            {"response and distributions", "halton, 8 sequences", "sobol, 8 sequences", "latin_hypercube", "random"},
            {row}, 1);
    }
}

TEST(SlowDistributions, IntervalsOfModelsReachTheTruth) {
    for (const auto& problem : problems()) {
        const auto truth = truth_of(problem);
        Tallies tallies;
        for (std::uint64_t seed = 1; seed <= campaigns(); ++seed)
            count_models(tallies, problem, truth, ask(problem, "halton", seed));
        tallies.print(problem);
    }
}

}  // namespace
