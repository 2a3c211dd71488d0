#include "stats/group_test.hpp"

#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::stats_group_test_test {

using stats::compare_groups;

const std::vector<double> zeros(3, 0), ones(3, 1);

std::vector<double> cube(std::size_t n, std::uint64_t seed) {
    std::vector<double> x;
    for (std::size_t i = 0; i < 3 * n; ++i) x.push_back(stats::to_unit(stats::bits_at(seed, 1, i)));
    return x;
}

// Labels that depend on nothing: p below 0.05 in 5 % of the samples. Of 200, 10 +- 3 are expected.
TEST(GroupTest, FindsNoDifferenceWhereThereIsNone) {
    int found = 0, of_feature = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const auto x = cube(40, seed);
        std::vector<bool> first;
        for (std::size_t i = 0; i < 40; ++i) first.push_back(stats::to_unit(stats::bits_at(seed, 2, i)) < 0.3);
        const auto test = compare_groups({x, 3}, first, zeros, ones);
        found += test.p_value <= 0.05 ? 1 : 0;
        for (const double p : test.p_of_feature) of_feature += p <= 0.05 ? 1 : 0;
    }
    EXPECT_LE(found, 20);
    EXPECT_GE(found, 2);
    EXPECT_LE(of_feature, 20) << "three features are no three looks";
}

TEST(GroupTest, NamesTheFeatureThatDecides) {
    const auto x = cube(30, 7);
    std::vector<bool> first;
    for (std::size_t i = 0; i < 30; ++i) first.push_back(x[3 * i + 1] > 0.5);
    const auto test = compare_groups({x, 3}, first, zeros, ones);
    EXPECT_LE(test.p_value, 0.001) << "no other of the 999 orders splits so well";
    EXPECT_LE(test.p_of_feature[1], 0.001);
    EXPECT_GT(test.p_of_feature[0], 0.05);
    EXPECT_GT(test.p_of_feature[2], 0.05);
}

// A ball in the middle: no mean differs. An exclusive or: no single feature differs.
TEST(GroupTest, FindsDifferencesThatAreNoShift) {
    const auto x = cube(240, 3);
    std::vector<bool> ball, either;
    for (std::size_t i = 0; i < 240; ++i) {
        ball.push_back(std::hypot(x[3 * i] - 0.5, x[3 * i + 1] - 0.5, x[3 * i + 2] - 0.5) < 0.35);
        either.push_back((x[3 * i] > 0.5) != (x[3 * i + 2] > 0.5));
    }
    EXPECT_LE(compare_groups({x, 3}, ball, zeros, ones).p_value, 0.01);
    EXPECT_LE(compare_groups({x, 3}, either, zeros, ones).p_value, 0.01);
}

TEST(GroupTest, ChoosesAmongManyPointsAndRefusesWhatHasNoAnswer) {
    const auto x = cube(3000, 5);
    std::vector<bool> first;
    for (std::size_t i = 0; i < 3000; ++i) first.push_back(x[3 * i] > 0.7);
    EXPECT_LE(compare_groups({x, 3}, first, zeros, ones).p_value, 0.001);
    EXPECT_EQ(compare_groups({x, 3}, std::vector<bool>(3000, true), zeros, ones).p_value, 1);
    EXPECT_THROW((void)compare_groups({x, 3}, std::vector<bool>(5, true), zeros, ones), std::invalid_argument);
}

}  // namespace grainsweep::tests::stats_group_test_test
