// The model of a probability: its approximation against exact integrals, its gradient, and whether its probabilities
// and intervals hold on truths that are known.
#include "stats/probability_model.hpp"
#include "stats/random.hpp"
#include "stats/response/likely_hyperparameters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

namespace grainsweep::tests::stats_probability_model_test {

using namespace stats;
using response::Hyperparameters;
using response::Trials;
using Truth = std::function<double(std::span<const double>)>;

double phi(double f) {
    return 0.5 * std::erfc(-f / std::numbers::sqrt2);
}

double drawn(std::uint64_t seed, std::uint64_t stream, std::uint64_t i) {
    return to_unit(bits_at(seed, stream, i));
}

Trials small_trials() {
    Trials trials{Eigen::MatrixXd(6, 2), Eigen::VectorXd(6), Eigen::VectorXd(6)};
    for (Eigen::Index i = 0; i < 6; ++i)
        for (Eigen::Index j = 0; j < 2; ++j)
            trials.points(i, j) = drawn(3, static_cast<std::uint64_t>(j), static_cast<std::uint64_t>(i));
    trials.count << 1, 1, 4, 1, 12, 1;
    trials.successes << 1, 0, 3, 1, 0, 1;
    return trials;
}

Hyperparameters of(double log_length, double other, double log_signal) {
    return {Eigen::Vector2d(log_length, other), log_signal, 0, Eigen::MatrixXd::Identity(2, 2)};
}

TEST(ProbabilityModel, LogarithmOfTheNormalDistributionFarFromItsMiddle) {
    // Abramowitz & Stegun 1964, table 26.2: -log10 Q(x).
    for (const auto& [x, digits] :
         {std::pair{5.0, 6.54265}, {10.0, 23.11805}, {20.0, 88.56010}, {40.0, 349.43701}, {100.0, 2173.87154}})
        EXPECT_NEAR(response::log_normal_cdf(-x) / std::numbers::ln10, -digits, 1e-5) << x;
    EXPECT_NEAR(response::log_normal_cdf(-20 - 1e-9), response::log_normal_cdf(-20 + 1e-9), 1e-6) << "where forms meet";
}

TEST(ProbabilityModel, OnePlaceIsIntegratedExactly) {
    // One place: the posterior of f has the moments of its integral, whatever was counted there.
    for (const auto& [count, successes] : {std::pair{1.0, 1.0}, {1.0, 0.0}, {12.0, 3.0}, {500.0, 499.0}}) {
        Trials trials{Eigen::MatrixXd::Constant(1, 2, 0.5), Eigen::VectorXd::Constant(1, count),
                      Eigen::VectorXd::Constant(1, successes)};
        const auto found = response::propagate(of(0, 0, std::log(6.0)), trials);
        ASSERT_TRUE(found);
        const double variance = 6 + 4;
        double size = 0, mean = 0, square = 0;
        for (double f = -30; f < 30; f += 1e-3) {
            const double w = std::exp(-f * f / (2 * variance) + successes * response::log_normal_cdf(f) +
                                      (count - successes) * response::log_normal_cdf(-f)) *
                             1e-3 / std::sqrt(2 * std::numbers::pi * variance);
            size += w, mean += w * f, square += w * f * f;
        }
        mean /= size;
        const auto latent = response::predict(*found, found->points);
        EXPECT_NEAR(latent.mean(0), mean, 1e-4) << count;
        EXPECT_NEAR(latent.variance(0), square / size - mean * mean, 2e-4) << count;
        EXPECT_NEAR(found->log_evidence, std::log(size), 1e-4) << count;
    }
}

TEST(ProbabilityModel, EvidenceHasTheGradientOfItsDifferences) {
    const auto trials = small_trials();
    const auto found = response::propagate(of(-0.5, 0.3, 1.2), trials);
    ASSERT_TRUE(found);
    const auto gradient = response::evidence_gradient(*found);
    const auto difference = [&](double a, double b, double s) {
        const auto up = response::propagate(of(-0.5 + a, 0.3 + b, 1.2 + s), trials);
        const auto down = response::propagate(of(-0.5 - a, 0.3 - b, 1.2 - s), trials);
        return (up->log_evidence - down->log_evidence) / 0.02;
    };
    EXPECT_NEAR(gradient(0), difference(0.01, 0, 0), 1e-3);
    EXPECT_NEAR(gradient(1), difference(0, 0.01, 0), 1e-3);
    EXPECT_NEAR(gradient(2), difference(0, 0, 0.01), 1e-3);
}

struct Seen {
    std::vector<double> rows, values;
};

Seen seen_of(const Truth& truth, std::size_t d, std::size_t n, std::size_t repeats, std::uint64_t seed) {
    Seen seen;
    for (std::size_t i = 0; i < n; ++i) {
        std::vector<double> x;
        for (std::size_t j = 0; j < d; ++j) x.push_back(drawn(seed, j, i));
        for (std::size_t r = 0; r < repeats; ++r) {
            seen.rows.insert(seen.rows.end(), x.begin(), x.end());
            seen.values.push_back(drawn(seed, 100 + r, i) < truth(x) ? 1 : 0);
        }
    }
    return seen;
}

ProbabilityModel fitted_model(const Seen& seen, std::size_t d) {
    const std::vector<double> low(d, 0), high(d, 1);
    return std::get<ProbabilityModel>(fit_probability({seen.rows, d}, seen.values, low, high));
}

TEST(ProbabilityModel, ReplicatesCountAndNarrowTheInterval) {
    const Truth half = [](auto) { return 0.3; };
    const auto few = fitted_model(seen_of(half, 1, 12, 2, 1), 1), many = fitted_model(seen_of(half, 1, 12, 40, 1), 1);
    const std::array at = {0.4};
    const auto wide = few.predict({at, 1}).front(), narrow = many.predict({at, 1}).front();
    EXPECT_EQ(many.quality().cases, 480U);
    EXPECT_LT(narrow.mean_error, 0.5 * wide.mean_error);
    EXPECT_NEAR(narrow.mean, 0.3, 3 * narrow.mean_error);
    EXPECT_LT(narrow.mean_low(), 0.3);
    EXPECT_GT(narrow.mean_high(), 0.3);
    EXPECT_DOUBLE_EQ(narrow.scatter, std::sqrt(narrow.mean * (1 - narrow.mean)));
    EXPECT_GT(many.quality().brier, 0.9 * many.quality().brier_of_share) << "no feature predicts it";
}

TEST(ProbabilityModel, ABorderIsFoundAndRepeatsItself) {
    const Truth corner = [](auto x) { return x[0] < 0.4 && x[2] > 0.6 ? 0.0 : 1.0; };
    const auto seen = seen_of(corner, 4, 120, 1, 9);
    const auto model = fitted_model(seen, 4);
    EXPECT_LT(model.quality().brier, 0.5 * model.quality().brier_of_share);
    EXPECT_LT(model.quality().lengths[0], model.quality().lengths[1]);
    EXPECT_LT(model.quality().lengths[2], model.quality().lengths[3]);
    const std::vector<double> at = {0.1, 0.5, 0.9, 0.5, 0.9, 0.5, 0.1, 0.5};
    const auto p = model.probabilities({at, 4});
    EXPECT_LT(p[0], 0.1);
    EXPECT_GT(p[1], 0.97);
    EXPECT_EQ(fitted_model(seen, 4).probabilities({at, 4}), p) << "the same bits again";
    const auto longer = model.with_cases({std::span(at).first(4), 4}, std::array{1.0});
    EXPECT_GT(longer.probabilities({at, 4})[0], p[0]);
    EXPECT_EQ(longer.quality().cases, 121U);
}

TEST(ProbabilityModel, LikelyHyperparametersAreThePriorWhereOneTrialDecidesNothing) {
    // P(1) = 1/2 whatever l and s: the maximum is the prior's, the weights along log l are those of a normal density.
    const Trials trials{Eigen::MatrixXd::Constant(1, 1, 0.5), Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1)};
    const auto likely = response::likely_hyperparameters(trials, response::Wanted::places_about_it);
    ASSERT_EQ(likely.size(), 5U);
    EXPECT_NEAR(likely[0].h.log_length(0), 0, 0.2);
    EXPECT_NEAR(likely[0].h.log_signal, std::log(400.0), 0.3);
    double sum = 0;
    int along_length = 0;
    for (const auto& one : likely) {
        sum += one.weight;
        if (std::abs(one.h.log_length(0) - likely[0].h.log_length(0)) < 1) continue;
        ++along_length;
        EXPECT_NEAR(std::abs(one.h.log_length(0) - likely[0].h.log_length(0)), 2 * 1.5, 0.25);
        EXPECT_NEAR(one.weight / likely[0].weight, 0.25, 0.05);
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_EQ(along_length, 2);
}

TEST(ProbabilityModel, WeightsSumToOneAndOneMaximumStandsAloneWhereItIsWanted) {
    const auto trials = small_trials();
    const auto likely = response::likely_hyperparameters(trials, response::Wanted::places_about_it);
    ASSERT_EQ(likely.size(), 7U);
    double sum = 0;
    for (const auto& one : likely) {
        EXPECT_GT(one.weight, 0);
        sum += one.weight;
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    const auto alone = response::likely_hyperparameters(trials, response::Wanted::maximum);
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_EQ(alone[0].weight, 1);
    EXPECT_EQ(alone[0].h.log_length, likely[0].h.log_length);
}

TEST(ProbabilityModel, AllOneFailureAndNoFailure) {
    const auto seen = seen_of([](auto) { return 1.0; }, 2, 40, 1, 5);
    Seen none = seen, one = seen;
    for (double& value : none.values) value = 0;
    one.values[7] = 0;
    const std::vector<double> at = {0.5, 0.5, 0.1, 0.9, one.rows[14], one.rows[15]};
    const auto all_answer = fitted_model(seen, 2).predict({at, 2}), all_fail = fitted_model(none, 2).predict({at, 2}),
               one_fails = fitted_model(one, 2).predict({at, 2});
    for (std::size_t i = 0; i < all_answer.size(); ++i) {
        EXPECT_GT(all_answer[i].mean, 0.95);
        EXPECT_NEAR(all_fail[i].mean, 1 - all_answer[i].mean, 1e-6);
        EXPECT_NEAR(all_fail[i].mean_high(), 1 - all_answer[i].mean_low(), 1e-6);
        EXPECT_LT(one_fails[i].mean, all_answer[i].mean);
        EXPECT_LT(one_fails[i].mean_low(), all_answer[i].mean_low());
    }
    EXPECT_LT(one_fails[2].mean, one_fails[0].mean) << "where it failed";
}

TEST(ProbabilityModel, AChosenSettingBesideASharpBorderKeepsItsPromise) {
    // Eight slanted borders, 60 cases each; the largest x + y of 400 settings that answer surely, as `window` chooses.
    const std::vector<double> grid = [] {
        std::vector<double> points;
        for (int i = 0; i < 400; ++i) points.insert(points.end(), {(i % 20 + 0.5) / 20, (i / 20 + 0.5) / 20});
        return points;
    }();
    double covered = 0, broken = 0;
    for (std::uint64_t campaign = 0; campaign < 8; ++campaign) {
        const double slope = drawn(71, 0, campaign), offset = 0.5 + 0.4 * drawn(71, 1, campaign);
        const Truth truth = [&](auto x) { return slope * x[0] + (1 - slope) * x[1] < offset ? 1.0 : 0.0; };
        const auto found = fitted_model(seen_of(truth, 2, 60, 1, 700 + campaign), 2).predict({grid, 2});
        double largest = 0, there = 1;
        for (std::size_t i = 0; i < found.size(); ++i) {
            const auto x = std::span(grid).subspan(2 * i, 2);
            covered += truth(x) >= found[i].mean_low() - 0.05 && truth(x) <= found[i].mean_high() + 0.05 ? 1 : 0;
            if (found[i].mean_low() < 0.95 || x[0] + x[1] <= largest) continue;
            largest = x[0] + x[1];
            there = truth(x);
        }
        broken += 1 - there;
    }
    EXPECT_LE(broken, 1);
    EXPECT_GE(covered / (8 * 400), 0.93);
}

TEST(ProbabilityModel, AnIntervalHoldsItsMean) {
    // Far below 0 and very uncertain: the mean is the rare large values', beyond the 97.5 % quantile.
    for (const double at : {-30.0, 30.0}) {
        Prediction prediction;
        prediction.latent = Prediction::Latent{at, 10};
        prediction.mean = std::erfc(-at / std::hypot(1, 10) / std::numbers::sqrt2) / 2;
        EXPECT_LE(prediction.mean_low(), prediction.mean);
        EXPECT_GE(prediction.mean_high(), prediction.mean);
        EXPECT_GE(prediction.mean_low(), 0);
        EXPECT_LE(prediction.mean_high(), 1);
    }
}

TEST(ProbabilityModel, IsOfZeroAndOneAlone) {
    EXPECT_TRUE(only_zero_and_one(std::array{0.0, 1.0, std::nan("")}));
    EXPECT_FALSE(only_zero_and_one(std::array{0.0, 0.0}));
    EXPECT_FALSE(only_zero_and_one(std::array{0.0, 0.5, 1.0}));
    const std::array rows = {0.1, 0.2, 0.3}, values = {0.0, 1.0, 0.5};
    const std::array low = {0.0}, high = {1.0};
    EXPECT_THROW((void)fit_probability({rows, 1}, values, low, high), std::invalid_argument);
    EXPECT_THROW((void)fit_probability({rows, 1}, std::span(values).first(2), low, high), std::invalid_argument);
    const std::array broken = {0.1, std::nan(""), 0.3}, answers = {0.0, 1.0, 1.0};
    EXPECT_TRUE(std::holds_alternative<Refusal>(fit_probability({broken, 1}, answers, low, high)));
}

}  // namespace grainsweep::tests::stats_probability_model_test
