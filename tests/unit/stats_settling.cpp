#include "stats/random.hpp"
#include "stats/settling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace grainsweep::tests::stats_settling_test {

using namespace stats;

/// x_k = a x_(k-1) + noise: the standard error of its mean is that of independent samples times
/// sqrt((1 + a)/(1 - a)), for long series.
std::vector<double> autoregressive(std::size_t n, double a, std::uint64_t seed) {
    Generator generator(seed);
    std::vector<double> series(n);
    double x = 0;
    for (int k = 0; k < 200; ++k) x = a * x + generator.uniform() - 0.5;
    for (auto& value : series) {
        x = a * x + generator.uniform() - 0.5;
        value = 10 + x;
    }
    return series;
}

TEST(Settling, FirstIndexInsideTheBandForGood) {
    EXPECT_EQ(settled_from(std::vector{0.0, 5.0, 9.0, 10.5, 8.0, 10.2, 9.9, 10.0}, 0.5), 5U);
    EXPECT_EQ(settled_from(std::vector{1.0, 1.0, 1.0}, 0), 0U);
    EXPECT_EQ(settled_from(std::vector{1.0, 2.0, 3.0}, 0), 2U);
    EXPECT_EQ(settled_from(std::vector<double>{}, 1), 0U);
    const double missing = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(settled_from(std::vector{1.0, missing}, 1), 2U);
    EXPECT_EQ(settled_from(std::vector{missing, 1.0, 1.0}, 1), 1U);
}

TEST(BlockedMean, IndependentSamplesNeedNoBlocks) {
    const auto series = autoregressive(4096, 0, 3);
    const auto result = blocked_mean(series);
    EXPECT_TRUE(result.plateau);
    EXPECT_NEAR(result.standard_error, std::sqrt(1.0 / 12 / 4096), 0.25 * std::sqrt(1.0 / 12 / 4096));
    EXPECT_NEAR(result.mean, 10, 4 * result.standard_error);
}

TEST(BlockedMean, CorrelatedSamplesGetTheirTrueError) {
    for (const double a : {0.5, 0.9, 0.97}) {
        // Averaged over 40 series: the single estimate scatters by some 20 %.
        double ratio = 0;
        for (std::uint64_t seed = 0; seed < 40; ++seed) {
            const auto result = blocked_mean(autoregressive(16'384, a, seed));
            EXPECT_TRUE(result.plateau);
            const double spread = std::sqrt(1.0 / 12 / (1 - a * a));
            ratio += result.standard_error / (spread / std::sqrt(16'384.0) * std::sqrt((1 + a) / (1 - a))) / 40;
        }
        EXPECT_NEAR(ratio, 1, 0.1) << "a = " << a;
    }
}

TEST(BlockedMean, TooShortASeriesSaysSo) {
    EXPECT_FALSE(blocked_mean(autoregressive(32, 0.99, 1)).plateau);
    EXPECT_TRUE(std::isnan(blocked_mean(std::vector{1.0}).standard_error));
    const auto constant = blocked_mean(std::vector<double>(100, 0.1));
    EXPECT_EQ(constant.mean, 0.1);
    EXPECT_EQ(constant.standard_error, 0);
    EXPECT_TRUE(constant.plateau);
}

}  // namespace grainsweep::tests::stats_settling_test
