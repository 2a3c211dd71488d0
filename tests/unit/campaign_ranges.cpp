// Ranges of factors: what a coordinate of the unit interval becomes.
#include "sweep/campaign/campaign.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <variant>

namespace grainsweep::tests::campaign_ranges_test {

using namespace campaign;

// Without care rounding misses the ends: 30000 (1e6/30000)^1 is 1000000.0000000001, and 0.2 + (0.9 - 0.2) is
// 0.8999999999999999.
TEST(ParameterSpace, EveryRangeHasItsEndsExactlyAndNothingBeyond) {
    const auto at = [](const Between& range, double u) { return Factor{"x1", range}.number(u); };
    for (int k = 0; k < 2000; ++k) {
        const double low = 0.001 * (1 + k % 37) * std::pow(10, k % 5);
        const double high = low * (1.001 + 0.37 * (k % 101));
        for (const auto scale : {Scale::linear, Scale::log}) {
            const Between range{low, high, scale};
            ASSERT_EQ(at(range, 0), low);
            ASSERT_EQ(at(range, 1), high) << low;
            for (const double u : {1e-300, 0x1p-53, 0.5, 1 - 0x1p-53}) {
                ASSERT_GE(at(range, u), low);
                ASSERT_LE(at(range, u), high) << low << ' ' << u;
            }
        }
    }
    EXPECT_EQ(at({30000, 1e6, Scale::log}, 1), 1e6);
    EXPECT_EQ(at({0.104, 1, Scale::log}, 1), 1);
    EXPECT_EQ(at({0.2, 0.9, Scale::linear}, 1), 0.9);
}

}  // namespace grainsweep::tests::campaign_ranges_test
