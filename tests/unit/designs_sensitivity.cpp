#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::tests::designs_sensitivity_test {

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

TEST(MorrisDesign, EveryLevelIsMetAndStepsAreHalfTheLevels) {
    for (const std::size_t k : {2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U}) {
        const auto set = ask_design("morris", std::vector<std::size_t>{0, k}, {{"trajectories", 90}});
        const auto level = [&](std::size_t p) {
            return std::min(k - 1, static_cast<std::size_t>(static_cast<double>(k) * set.point(p)[1]));
        };
        std::map<std::size_t, int> met;
        for (std::size_t p = 0; p < set.size(); ++p) {
            ++met[level(p)];
            if (p % 3 != 0 && set.point(p)[1] != set.point(p - 1)[1]) {
                const auto step = std::max(level(p), level(p - 1)) - std::min(level(p), level(p - 1));
                EXPECT_EQ(step, k / 2) << k;
            }
        }
        ASSERT_EQ(met.size(), k);
        // 270 points; of an odd number of levels the ends are met half to once as often as the others.
        for (const auto& [at, times] : met) EXPECT_GT(times, 0.6 * 270 / static_cast<double>(k)) << k << ' ' << at;
    }
}

TEST(MorrisDesign, PointsOfGridsThatLevelsDivideStay) {
    // As many levels as places, or half of them: what is drawn is what is drawn for a continuous factor.
    for (const std::size_t k : {2U, 4U})
        EXPECT_EQ(ask_design("morris", std::vector<std::size_t>{0, k, 0}, {{"trajectories", 30}}).coordinates,
                  ask_design("morris", 3, {{"trajectories", 30}}).coordinates);
}

TEST(MorrisDesign, LevelsThatNoTrajectoryMeetsAreRefused) {
    const auto said = [](std::size_t levels, std::int64_t trajectories) -> std::string {
        try {
            (void)ask_design("morris", std::vector<std::size_t>{0, levels}, {{"trajectories", trajectories}});
        } catch (const std::invalid_argument& error) {
            return error.what();
        }
        return {};
    };
    EXPECT_NE(said(9, 3).find("trajectories: 3 of them run only "), std::string::npos);
    EXPECT_NE(said(9, 3).find(" of the 9 levels of factor 2; "), std::string::npos);
    EXPECT_EQ(said(9, 9), "");
    EXPECT_NE(said(1, 9).find("factor 2 has one level"), std::string::npos);
}

}  // namespace grainsweep::tests::designs_sensitivity_test
