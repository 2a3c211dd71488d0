#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace grainsweep::tests::designs_random_test {

TEST(RandomDesign, ExtendsAndDependsOnTheSeed) {
    const auto few = ask_design("random", 3, {{"points", 10}}, 7);
    const auto many = ask_design("random", 3, {{"points", 1000}}, 7);
    EXPECT_TRUE(std::equal(few.coordinates.begin(), few.coordinates.end(), many.coordinates.begin()));
    EXPECT_NE(ask_design("random", 3, {{"points", 10}}, 8).coordinates, few.coordinates);
    EXPECT_EQ(std::set<double>(many.coordinates.begin(), many.coordinates.end()).size(), 3000U);
}

TEST(RandomDesign, IsUniformAndUncorrelated) {
    constexpr std::size_t n = 20'000;
    const auto set = ask_design("random", 2, {{"points", std::int64_t{n}}}, 3);
    double mean = 0;
    double product = 0;
    for (std::size_t p = 0; p < n; ++p) {
        mean += set.point(p)[0] / n;
        product += 12 * (set.point(p)[0] - 0.5) * (set.point(p)[1] - 0.5) / n;
    }
    // Standard errors 0.00204 and 0.0071: four of them.
    EXPECT_NEAR(mean, 0.5, 0.0082);
    EXPECT_NEAR(product, 0.0, 0.0283);
}

TEST(LatinHypercube, VisitsEveryCellOfEveryFactorOnce) {
    constexpr std::size_t n = 97;
    const auto set = ask_design("latin_hypercube", 5, {{"points", std::int64_t{n}}}, 11);
    for (std::size_t j = 0; j < 5; ++j) {
        std::set<std::size_t> cells;
        for (std::size_t p = 0; p < n; ++p) cells.insert(static_cast<std::size_t>(set.point(p)[j] * n));
        EXPECT_EQ(cells.size(), n);
    }
}

double nearest_two(const designs::PointSet& set) {
    double least = 1e300;
    for (std::size_t p = 0; p < set.size(); ++p)
        for (std::size_t q = 0; q < p; ++q) {
            double square = 0;
            for (std::size_t j = 0; j < set.dimensions; ++j) square += std::pow(set.point(p)[j] - set.point(q)[j], 2);
            least = std::min(least, std::sqrt(square));
        }
    return least;
}

TEST(LatinHypercube, TakesTheCandidateWhosePointsAreFarthestApart) {
    const auto asked = [](std::int64_t candidates) {
        return ask_design("latin_hypercube", 2, {{"points", std::int64_t{20}}, {"candidates", candidates}}, 11);
    };
    const auto first = asked(1), best = asked(200);
    EXPECT_EQ(first.coordinates, ask_design("latin_hypercube", 2, {{"points", std::int64_t{20}}}, 11).coordinates);
    EXPECT_GT(nearest_two(best), 2 * nearest_two(first));
    EXPECT_GE(nearest_two(asked(400)), nearest_two(best));
    std::set<std::size_t> cells;
    for (std::size_t p = 0; p < 20; ++p) cells.insert(static_cast<std::size_t>(best.point(p)[1] * 20));
    EXPECT_EQ(cells.size(), 20U);
    EXPECT_THROW(
        (void)ask_design("latin_hypercube", 2, {{"points", std::int64_t{100'000}}, {"candidates", std::int64_t{2}}}),
        std::invalid_argument);
}

TEST(ListDesign, TakesRowsAsTheyAre) {
    const designs::Rows rows = {{0.5, std::string("sjkr")}, {std::int64_t{3}, std::string("sjkr2")}};
    const auto set = ask_design("list", 2, {{"rows", rows}});
    EXPECT_EQ(set.size(), 2U);
    EXPECT_EQ(set.rows, rows);
    EXPECT_THROW((void)ask_design("list", 3, {{"rows", rows}}), std::invalid_argument);
    EXPECT_THROW((void)ask_design("list", 3, {}), std::invalid_argument);
}

}  // namespace grainsweep::tests::designs_random_test
