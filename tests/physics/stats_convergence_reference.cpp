// The stopping rules on the spreading-like response they were chosen with: where they stop and how often that
// is too early, over 200 randomisations, against the study of the reference numbers.
#include "stats/convergence.hpp"
#include "tests/support/ask_design.hpp"
#include "tests/support/reference_table.hpp"
#include "tests/support/spreading_response.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <vector>

namespace grainsweep::tests::stats_convergence_reference_test {

using namespace stats;

constexpr int randomisations = 200;

const std::vector<Statistic> three = {Statistic::mean, Statistic::sd, Statistic::kurtosis};
const std::vector<Statistic> four = {Statistic::mean, Statistic::sd, Statistic::kurtosis, Statistic::g1};

Summary truth(double onset) {
    const auto set = ask_design("sobol", 4, {{"points", 1 << 18}}, 99);
    std::vector<double> values;
    for (std::size_t p = 0; p < set.size(); ++p) values.push_back(spreading_response(set.point(p), onset));
    return summarise(values);
}

struct Stops {
    double median = 0;
    double late = 0;         ///< 95 % of the stops are no later
    double false_share = 0;  ///< stopped with a gate further off than the tolerance
};

/// Share of the tolerance measure by which a value is off the truth.
double off(Statistic statistic, const Checkpoint& check, const Summary& true_values) {
    const double error = std::abs(check.of(statistic).value - true_values.of(statistic));
    if (statistic == Statistic::skewness) return error / 3;
    const double expected = std::abs(true_values.of(statistic));
    return error / (statistic == Statistic::g1 ? std::max(1.0, expected) : expected);
}

/// The response over a scrambled Halton design, once for each randomisation.
std::vector<std::vector<double>> responses(double onset, std::int64_t sequences, std::int64_t points) {
    std::vector<std::vector<double>> all(randomisations);
    for (std::size_t r = 0; r < all.size(); ++r) {
        const auto set = ask_design("halton", 4, {{"points", points}, {"sequences", sequences}}, 5000 + r);
        for (std::size_t p = 0; p < set.size(); ++p) all[r].push_back(spreading_response(set.point(p), onset));
    }
    return all;
}

Stops stops(const ConvergenceSettings& settings, const std::vector<std::vector<double>>& all,
            const Summary& true_values, const std::vector<Statistic>& judged) {
    std::vector<double> stopped;
    int wrong = 0;
    for (const auto& values : all) {
        Convergence convergence(settings);
        for (std::size_t p = 0; p < values.size() && convergence.converged() == nullptr; ++p)
            convergence.add(static_cast<std::int64_t>(p), values[p]);
        convergence.settle(static_cast<std::int64_t>(values.size()));
        const Checkpoint* stop = convergence.converged();
        if (stop == nullptr) continue;
        stopped.push_back(static_cast<double>(stop->points));
        const auto far = [&](Statistic s) { return off(s, *stop, true_values) > settings.tolerance; };
        if (std::ranges::any_of(judged, far)) ++wrong;
    }
    EXPECT_GE(stopped.size(), randomisations * 0.98);
    std::ranges::sort(stopped);
    return {.median = stopped[stopped.size() / 2],
            .late = stopped[stopped.size() * 95 / 100],
            .false_share = wrong / static_cast<double>(stopped.size())};
}

struct Expected {
    std::string gate, model, tolerance;
    double median = 0, late = 0, false_share = 0;
};

Expected from_study(const std::string& gate, const std::string& model, const std::string& tolerance) {
    const ReferenceTable table("designs/stopping_rules_rqmc_gates.csv");
    for (std::size_t r = 0; r < table.size(); ++r)
        if (table.cell(r, "rule") == "ci_x2" && table.cell(r, "gate") == gate && table.cell(r, "design") == "rhalton" &&
            table.cell(r, "R") == "8" && table.cell(r, "model") == model && table.cell(r, "tol") == tolerance)
            return {gate,
                    model,
                    tolerance,
                    table.number(r, "n_stop_median"),
                    table.number(r, "n_stop_p95"),
                    table.number(r, "false_stop_rate_gate")};
    throw std::runtime_error("no such row in the study");
}

TEST(ConvergenceReference, TheResponseHasTheKnownMoments) {
    const Summary a = truth(1.0);
    EXPECT_NEAR(a.mean, spreading_mean, 2e-6);
    EXPECT_NEAR(a.sd, spreading_sd, 2e-6);
    EXPECT_NEAR(a.kurtosis, spreading_kurtosis, 1e-5);
    EXPECT_NEAR(a.skewness, spreading_skewness, 1e-3);
}

TEST(ConvergenceReference, ReplicatesStopWhereTheStudyStopped) {
    for (const std::string model : {"A", "B"}) {
        const double onset = model == "A" ? 1.0 : 1.25;
        const Summary true_values = truth(onset);
        const auto all = responses(onset, 8, 8000);
        for (const auto& [gate, gates] : {std::pair{"mean+sd+kurt", three}, std::pair{"mean+sd+kurt+g1", four}})
            for (const std::string tolerance : {"0.02", "0.01"}) {
                const Expected expected = from_study(gate, model, tolerance);
                const Stops got = stops({.rule = ConvergenceRule::replicates,
                                         .gates = {gates.begin(), gates.end()},
                                         .tolerance = std::stod(tolerance),
                                         .block = 400,
                                         .sequences = 8},
                                        all, true_values, gates);
                const std::string what = std::string(gate) + " model " + model + " tolerance " + tolerance;
                std::cout << what << ": median " << got.median << " (" << expected.median << "), 95 % " << got.late
                          << " (" << expected.late << "), false " << got.false_share << " (" << expected.false_share
                          << ")\n";
                // Other randomisations, and stops come in steps of a block: one block either way. False
                // stops are at most 1.5 % in the study; 4 % of 200 is four binomial standard errors above that.
                EXPECT_NEAR(got.median, expected.median, 400) << what;
                EXPECT_NEAR(got.late, expected.late, 800) << what;
                EXPECT_LE(got.false_share, 0.04) << what;
            }
    }
}

TEST(ConvergenceReference, PearsonsSkewnessTakesLonger) {
    const std::vector<Statistic> gates = {Statistic::mean, Statistic::sd, Statistic::kurtosis, Statistic::skewness};
    const Expected expected = from_study("mean+sd+kurt+pearson2/3", "A", "0.02");
    const Stops got = stops({.rule = ConvergenceRule::replicates,
                             .gates = {gates.begin(), gates.end()},
                             .tolerance = 0.02,
                             .block = 400,
                             .sequences = 8},
                            responses(1.0, 8, 8000), truth(1.0), gates);
    // The stops scatter widely (95 % at 6000): their median is known to two blocks or so.
    EXPECT_NEAR(got.median, expected.median, 800);
    EXPECT_NEAR(got.late, expected.late, 1200);
    EXPECT_LE(got.false_share, 0.04);
}

TEST(ConvergenceReference, HalfWidthsCoverTheTruthAsOftenAsTheyClaim) {
    // Nominal 95 %; the study found 94-96 % for each statistic. 400 tries: standard error 1.1 %.
    const Summary true_values = truth(1.0);
    std::array<int, statistics.size()> covered{};
    constexpr int tries = 400;
    for (int randomisation = 0; randomisation < tries; ++randomisation) {
        const auto set = ask_design("halton", 4, {{"points", 2400}, {"sequences", 8}},
                                    static_cast<std::uint64_t>(20'000 + randomisation));
        Convergence convergence({.rule = ConvergenceRule::replicates,
                                 .gates = {four.begin(), four.end()},
                                 .tolerance = 0.01,
                                 .block = 2400,
                                 .sequences = 8});
        for (std::size_t p = 0; p < set.size(); ++p)
            convergence.add(static_cast<std::int64_t>(p), spreading_response(set.point(p)));
        convergence.settle(2400);
        const Checkpoint& check = convergence.checkpoints()[0];
        for (std::size_t s = 0; s < statistics.size(); ++s)
            if (std::abs(check.estimates[s].value - true_values.of(statistics[s])) <= check.estimates[s].error)
                ++covered[s];
    }
    for (std::size_t s = 0; s < statistics.size(); ++s) {
        const double share = static_cast<double>(covered[s]) / tries;
        std::cout << to_string(statistics[s]) << " covered " << share << "\n";
        EXPECT_GE(share, 0.91) << to_string(statistics[s]);
        EXPECT_LE(share, 0.99) << to_string(statistics[s]);
    }
}

TEST(ConvergenceReference, TheThesisRuleStopsAtOnceAndOftenTooEarly) {
    // Study: stops at 800, the first possible check, with 54-56 % false stops over 200 runs (standard error 3.5 %).
    const std::vector<Statistic> thesis = {Statistic::mean, Statistic::sd, Statistic::skewness, Statistic::kurtosis};
    const Stops got = stops({.rule = ConvergenceRule::any_change,
                             .gates = {thesis.begin(), thesis.end()},
                             .tolerance = 0.01,
                             .block = 400,
                             .sequences = 1},
                            responses(1.0, 1, 2400), truth(1.0), thesis);
    std::cout << "any_change: median " << got.median << ", false " << got.false_share << "\n";
    EXPECT_EQ(got.median, 800);
    EXPECT_NEAR(got.false_share, 0.555, 0.14);
}

TEST(ConvergenceReference, PredictionsMadeEarlyAreOfTheRightSize) {
    // At 1200 points, tolerance 1 %, four gates: the predicted number of points over the one that it took, whose
    // study median is 3200. Half-widths of 8 sequences scatter by 27 %, so single predictions do, too.
    std::vector<double> ratios;
    for (int randomisation = 0; randomisation < 100; ++randomisation) {
        const auto set = ask_design("halton", 4, {{"points", 8000}, {"sequences", 8}},
                                    static_cast<std::uint64_t>(9000 + randomisation));
        Convergence convergence({.rule = ConvergenceRule::replicates,
                                 .gates = {four.begin(), four.end()},
                                 .tolerance = 0.01,
                                 .block = 400,
                                 .sequences = 8});
        for (std::size_t p = 0; p < set.size(); ++p)
            convergence.add(static_cast<std::int64_t>(p), spreading_response(set.point(p)));
        convergence.settle(8000);
        ASSERT_NE(convergence.converged(), nullptr);
        const auto predicted = convergence.checkpoints()[2].points_needed;
        ASSERT_TRUE(predicted);
        ratios.push_back(static_cast<double>(*predicted) / static_cast<double>(convergence.converged()->points));
    }
    std::ranges::sort(ratios);
    std::cout << "predicted / needed: 10 % " << ratios[10] << ", median " << ratios[50] << ", 90 % " << ratios[90]
              << "\n";
    EXPECT_GT(ratios[50], 0.7);
    EXPECT_LT(ratios[50], 1.5);
    EXPECT_GT(ratios[10], 0.4);
    EXPECT_LT(ratios[90], 4.0);
}

}  // namespace grainsweep::tests::stats_convergence_reference_test
