// Counts: the binomial without errors, its average over the beta distribution with them.
#include "stats/count_likelihood.hpp"

#include <gtest/gtest.h>
#include <boost/math/distributions/beta.hpp>
#include <boost/math/distributions/binomial.hpp>

#include <cmath>
#include <stdexcept>
#include <vector>

namespace grainsweep::tests::stats_count_likelihood_test {

using namespace stats;

double likelihood(const CountTarget& target, const Prediction& prediction) {
    return std::exp(log_likelihood_of_count(target, std::vector{prediction}).front());
}

double implausibility(const CountTarget& target, const Prediction& prediction) {
    return implausibilities_of_count(target, std::vector{prediction}).front();
}

TEST(CountLikelihood, WithoutErrorsIsTheBinomial) {
    for (const double p : {1e-6, 0.2, 0.5, 0.999})
        for (const std::size_t k : {0U, 3U, 10U}) {
            const double exact = pdf(boost::math::binomial(10, p), static_cast<double>(k));
            EXPECT_NEAR(likelihood({k, 10}, {.mean = p, .mean_error = 0}), exact, 1e-13 * exact) << p << ' ' << k;
        }
    EXPECT_EQ(likelihood({0, 10}, {.mean = 0, .mean_error = 0}), 1);
    EXPECT_EQ(likelihood({1, 10}, {.mean = 0, .mean_error = 0}), 0);
    EXPECT_EQ(likelihood({10, 10}, {.mean = 1, .mean_error = 0}), 1);
}

TEST(CountLikelihood, WithErrorsIsTheAverageOverTheBetaDistribution) {
    constexpr std::size_t n = 12;
    for (const auto& [p, error, discrepancy] :
         {std::tuple(0.3, 0.1, 0.0), std::tuple(0.3, 0.0, 0.1), std::tuple(0.75, 0.05, 0.15)}) {
        const Prediction prediction{.mean = p, .mean_error = error};
        const double run = p * (1 - p);
        const double variance = error * error + 4 * discrepancy * discrepancy * (run - error * error);
        const boost::math::beta_distribution<> shares(p * (run / variance - 1), (1 - p) * (run / variance - 1));
        double total = 0;
        for (std::size_t k = 0; k <= n; ++k) {
            constexpr int steps = 2000;
            double average = 0;
            for (int i = 0; i < steps; ++i) {
                const double q = (i + 0.5) / steps;
                average += pdf(shares, q) * pdf(boost::math::binomial(n, q), static_cast<double>(k)) / steps;
            }
            const double found = likelihood({k, n, discrepancy}, prediction);
            EXPECT_NEAR(found, average, 1e-3 * average) << p << ' ' << k;
            total += found;
        }
        EXPECT_NEAR(total, 1, 1e-12);
    }
}

TEST(CountLikelihood, ItsImplausibilityIsTheDistanceInStandardDeviationsOfManyRuns) {
    const CountTarget many{400, 1000};
    for (const double p : {0.36, 0.43}) {
        const double sd = std::sqrt(0.4 * 0.6 / 1000);
        EXPECT_NEAR(implausibility(many, {.mean = p, .mean_error = 0}), std::abs(p - 0.4) / sd, 0.05);
    }
    EXPECT_EQ(implausibility(many, {.mean = 0.4, .mean_error = 0.03}), 0);
    EXPECT_LT(implausibility(many, {.mean = 0.5, .mean_error = 0.05}), 2.5) << "6.3 sd of the count alone";
    EXPECT_EQ(implausibility({0, 10}, {.mean = 0, .mean_error = 0}), 0);
    EXPECT_LT(implausibility({1, 10}, {.mean = 0.008, .mean_error = 0}), 2) << "one of ten has the probability 0.07";
    EXPECT_TRUE(std::isinf(implausibility({1, 10}, {.mean = 0, .mean_error = 0})));
}

TEST(CountLikelihood, RefusesWhatIsNoCount) {
    EXPECT_THROW((void)likelihood({3, 2}, {.mean = 0.5, .mean_error = 0}), std::invalid_argument);
    EXPECT_THROW((void)likelihood({0, 0}, {.mean = 0.5, .mean_error = 0}), std::invalid_argument);
    EXPECT_THROW((void)likelihood({1, 2, 0.5}, {.mean = 0.5, .mean_error = 0}), std::invalid_argument);
}

}  // namespace grainsweep::tests::stats_count_likelihood_test
