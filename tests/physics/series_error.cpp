// Coverage of the standard error of the mean of a correlated series: how often 1.96 of it on both sides hold the truth.
#include "solver/observables/series.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grainsweep::tests::series_error_test {

/// Autoregressive series of order one, mean 0.
std::vector<double> series(double a, std::size_t n, std::uint64_t seed) {
    const stats::Stream random(seed, 7);
    std::vector<double> values;
    double x = 0;
    for (std::uint64_t i = 0; i < n + 200; ++i) {
        double normal = -6;  // of variance 1
        for (std::uint64_t k = 0; k < 12; ++k) normal += random.uniform(12 * i + k);
        x = a * x + normal;
        if (i >= 200) values.push_back(x);
    }
    return values;
}

struct Coverage {
    double held = 0, given = 0;  // shares: of the intervals given, and of all series
};

Coverage coverage(double a, std::size_t n) {
    constexpr std::uint64_t all = 200;
    double held = 0, given = 0;
    for (std::uint64_t seed = 0; seed < all; ++seed) {
        const auto values = series(a, n, seed);
        const double error = observables::standard_error_of_mean(values);
        if (std::isnan(error)) continue;
        double mean = 0;
        for (const double x : values) mean += x / static_cast<double>(n);
        ++given;
        if (std::abs(mean) < 1.96 * error) ++held;
    }
    return {held / given, given / static_cast<double>(all)};
}

TEST(SeriesError, HoldsTheMeanOfCorrelatedValues) {
    // 200 series: 0.95 is seen within 0.03.
    for (const double a : {-0.5, 0.0, 0.5, 0.8}) {
        for (const std::size_t n : {100U, 300U}) {
            const Coverage seen = coverage(a, n);
            EXPECT_GT(seen.held, 0.91) << a << " " << n;
            EXPECT_GT(seen.given, 0.85) << a << " " << n;
        }
    }
    EXPECT_GT(coverage(0.9, 300).held, 0.9);
    for (const double a : {-0.5, 0.0, 0.5})
        for (const std::size_t n : {12U, 19U}) EXPECT_GT(coverage(a, n).held, 0.85) << a << " " << n;
}

TEST(SeriesError, IsNotZeroWhereFewValuesAlternate) {
    std::vector<double> values;
    for (int k = 0; k < 10; ++k) values.push_back(k % 2);
    EXPECT_GT(observables::standard_error_of_mean(values), 0.05);
}

TEST(SeriesError, IsAbsentWhereTheSeriesIsOneValue) {
    // Correlated over a third of its length: the error is refused more often than given.
    EXPECT_LT(coverage(0.99, 100).given, 0.5);
    EXPECT_TRUE(std::isnan(observables::standard_error_of_mean(std::vector<double>(9, 1.0))));
    EXPECT_EQ(observables::standard_error_of_mean(std::vector<double>(20, 1.0)), 0);
}

}  // namespace grainsweep::tests::series_error_test
