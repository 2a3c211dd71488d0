#include "solver/observables/histogram.hpp"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

using namespace grainsweep;

TEST(Histogram, SharesOfBinsThatHoldSomething) {
    const std::vector<double> values = {0, 0.4, 0.5, 0.99, 7.2};
    const auto shares = observables::histogram(values, 0.5);
    ASSERT_EQ(shares.size(), 3U);
    EXPECT_EQ(shares[0], (std::pair{0.25, 0.4}));
    EXPECT_EQ(shares[1], (std::pair{0.75, 0.4}));
    EXPECT_EQ(shares[2], (std::pair{7.25, 0.2}));
    EXPECT_TRUE(observables::histogram({}, 1).empty());
}
