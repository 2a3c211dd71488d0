#include "tests/support/ask_design.hpp"
#include "tests/support/discrepancy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grainsweep::tests::stats_discrepancy_test {

TEST(Discrepancy, OnePointByHand) {
    // The star discrepancy of the single point (x, y) is max(1 - x y, x, y).
    for (const auto& [x, y] : {std::pair{0.5, 0.5}, std::pair{0.9, 0.2}, std::pair{0.97, 0.96}})
        EXPECT_DOUBLE_EQ(star_discrepancy_of_pair(std::vector{x, y}, 2, 0, 1), std::max({1 - x * y, x, y}));
    // One dimension, one point at 1/2: L2 star^2 = int_0^.5 a^2 + int_.5^1 (1-a)^2 = 1/12; centred the same.
    EXPECT_NEAR(squared_l2_star_discrepancy(std::vector{0.5}, 1), 1.0 / 12, 1e-15);
    EXPECT_NEAR(squared_centred_discrepancy(std::vector{0.5}, 1), 1.0 / 12, 1e-15);
}

TEST(Discrepancy, WrapAroundDoesNotSeeShifts) {
    auto set = ask_design("halton", 3, {{"points", 64}});
    const double before = squared_wraparound_discrepancy(set.coordinates, 3);
    for (auto& u : set.coordinates) u = u + 0.375 - std::floor(u + 0.375);
    EXPECT_NEAR(squared_wraparound_discrepancy(set.coordinates, 3), before, 1e-13);
}

TEST(Discrepancy, StarOfAPairAgreesWithTryingEveryBox) {
    const auto set = ask_design("random", 2, {{"points", 40}}, 6);
    double worst = 0;
    const auto corner = [&](double a, double b) {
        double open = 0, closed = 0;
        for (std::size_t p = 0; p < 40; ++p) {
            open += set.point(p)[0] < a && set.point(p)[1] < b ? 1.0 / 40 : 0;
            closed += set.point(p)[0] <= a && set.point(p)[1] <= b ? 1.0 / 40 : 0;
        }
        worst = std::max({worst, a * b - open, closed - a * b});
    };
    for (std::size_t i = 0; i <= 40; ++i)
        for (std::size_t k = 0; k <= 40; ++k) corner(i < 40 ? set.point(i)[0] : 1, k < 40 ? set.point(k)[1] : 1);
    EXPECT_NEAR(star_discrepancy_of_pair(set.coordinates, 2, 0, 1), worst, 1e-14);
}

}  // namespace grainsweep::tests::stats_discrepancy_test
