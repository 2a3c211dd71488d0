#include "solver/observables/histogram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grainsweep::tests::observables_histogram_test {

TEST(LogHistogram, SharesOfBinsThatHoldSomething) {
    const std::vector<double> values = {0, 0.005, 0.02, 0.0099, 0.5, 1.0, 3.0, 1.1};
    const auto shares = observables::log_histogram(values, 2, 0.01);
    ASSERT_EQ(shares.size(), 3U);
    EXPECT_NEAR(shares[0].first, std::pow(10, -1.75), 1e-15);  // 0.01 to 0.0316, with all that is less
    EXPECT_EQ(shares[0].second, 0.5);
    EXPECT_NEAR(shares[1].first, std::pow(10, -0.25), 1e-15);
    EXPECT_EQ(shares[1].second, 0.125);
    EXPECT_NEAR(shares[2].first, std::pow(10, 0.25), 1e-15);  // 1 to 3.16
    EXPECT_EQ(shares[2].second, 0.375);
    EXPECT_TRUE(observables::log_histogram({}, 10, 1).empty());
}

}  // namespace grainsweep::tests::observables_histogram_test
