#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <cmath>

using namespace grainsweep;
using grainsweep::testing::ask_design;

TEST(SaltelliDesign, BlocksAreAThenBThenRadialRows) {
    constexpr std::size_t d = 4;
    const auto set = ask_design("saltelli", d, {{"base_points", 5}});
    ASSERT_EQ(set.size(), 5 * (d + 2));
    EXPECT_EQ(set.sequences, d + 2);
    for (std::size_t k = 0; k < 5; ++k) {
        const auto a = set.point(k * (d + 2));
        const auto b = set.point(k * (d + 2) + 1);
        for (std::size_t j = 0; j < d; ++j) {
            const auto mixed = set.point(k * (d + 2) + 2 + j);
            for (std::size_t i = 0; i < d; ++i) EXPECT_EQ(mixed[i], i == j ? b[i] : a[i]);
        }
    }
}

TEST(MorrisDesign, EachStepMovesOneFactorByDelta) {
    constexpr std::size_t d = 6;
    const auto set = ask_design("morris", d, {{"trajectories", 50}, {"grid", 8}});
    ASSERT_EQ(set.size(), 50 * (d + 1));
    for (std::size_t t = 0; t < 50; ++t) {
        std::vector<int> moves(d, 0);
        for (std::size_t step = 1; step <= d; ++step)
            for (std::size_t j = 0; j < d; ++j) {
                const double moved = set.point(t * (d + 1) + step)[j] - set.point(t * (d + 1) + step - 1)[j];
                if (moved == 0) continue;
                EXPECT_NEAR(std::abs(moved), 8.0 / 14.0, 1e-15);
                ++moves[j];
            }
        EXPECT_EQ(moves, std::vector<int>(d, 1));
    }
}

TEST(MorrisDesign, GridMustBeEven) {
    EXPECT_THROW((void)ask_design("morris", 2, {{"trajectories", 4}, {"grid", 5}}), std::invalid_argument);
}
