// Where the nearest cases failed: regions that are known, factors that do not matter, ties.
#include "stats/nearest_cases.hpp"
#include "stats/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

namespace grainsweep::tests::stats_nearest_cases_test {

using stats::NearestCases;
using testing::ElementsAre;
using testing::IsEmpty;

NearestCases along_a_line(std::vector<double> places, std::vector<bool> failed) {
    return {std::move(places), 1, std::move(failed)};
}

bool answers(const NearestCases& cases, double x) {
    return cases.at(std::array{x}).answers;
}

TEST(NearestCases, OfNoFailureEveryPointAnswers) {
    const auto cases = along_a_line({0, 0.5, 1}, {false, false, false});
    EXPECT_FALSE(cases.any_failed());
    const auto near = cases.at(std::array{0.2});
    EXPECT_TRUE(near.answers);
    EXPECT_EQ(near.cases, 3U);
    EXPECT_THAT(near.failed, IsEmpty());
}

TEST(NearestCases, TheNearestOneDecidesAndSoDoMostOfFive) {
    // Failed up to 0.2 and at 0.8.
    const auto cases = along_a_line({0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1},
                                    {true, true, true, false, false, false, false, false, true, false, false});
    EXPECT_FALSE(answers(cases, 0.02));
    EXPECT_FALSE(answers(cases, 0.24)) << "the nearest is 0.2";
    EXPECT_TRUE(answers(cases, 0.26)) << "the nearest is 0.3, and three of five have answers";
    EXPECT_FALSE(answers(cases, 0.84)) << "one failed case is a hole about itself";
    EXPECT_TRUE(answers(cases, 0.86));
    EXPECT_THAT(cases.at(std::array{0.86}).failed, ElementsAre(8));
    const auto alone = along_a_line({0, 0.1, 0.2, 0.3, 0.4}, {true, true, false, true, true});
    EXPECT_FALSE(answers(alone, 0.2)) << "one answer among failed cases";
}

TEST(NearestCases, BetweenAFailedAndAnAnsweredCaseAPointIsBesideTheBorder) {
    const auto cases = along_a_line({0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1},
                                    {true, true, true, false, false, false, false, false, false, false, false});
    const auto beside = [&](double x) { return cases.at(std::array{x}).beside; };
    EXPECT_TRUE(beside(0.1)) << "it fails";
    EXPECT_TRUE(beside(0.29)) << "no case has an answer at 0.29 or less";
    EXPECT_FALSE(beside(0.3));
    EXPECT_FALSE(beside(0.34)) << "farther from 0.2 than 0.3 is";
    EXPECT_FALSE(beside(0.9));
}

TEST(NearestCases, OfReplicatesMostDecideAndTheirOrderDoesNot) {
    std::vector<double> places(8, 0.5);
    for (const double far : {0.0, 0.1, 0.9, 1.0}) places.push_back(far);
    std::vector<bool> failed = {true, true, true, false, false, false, false, false, false, false, false, false};
    const auto near = along_a_line(places, failed).at(std::array{0.5});
    EXPECT_TRUE(near.answers);
    EXPECT_EQ(near.cases, 8U) << "all that are as near as the fifth";
    EXPECT_EQ(near.failed.size(), 3U);
    std::reverse(failed.begin(), failed.begin() + 8);
    EXPECT_TRUE(answers(along_a_line(places, failed), 0.5));
    std::fill(failed.begin(), failed.begin() + 5, true);
    EXPECT_FALSE(answers(along_a_line(places, failed), 0.5));
}

/// Shares of failing points that count as answering, and of answering ones that count as failing.
std::array<double, 2> errors(std::size_t d, std::size_t n, const std::function<bool(std::span<const double>)>& fails) {
    std::vector<double> rows;
    std::vector<bool> failed;
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < d; ++j) rows.push_back(stats::to_unit(stats::bits_at(5, j, i)));
        failed.push_back(fails(std::span(rows).last(d)));
    }
    const NearestCases cases(rows, d, failed);
    std::array<double, 2> wrong{}, all{};
    for (std::size_t i = 0; i < 1000; ++i) {
        std::vector<double> point;
        for (std::size_t j = 0; j < d; ++j) point.push_back(stats::to_unit(stats::bits_at(6, j, i)));
        const std::size_t kind = fails(point) ? 0 : 1;
        all[kind] += 1;
        if (cases.at(point).answers == (kind == 0)) wrong[kind] += 1;
    }
    return {wrong[0] / all[0], wrong[1] / all[1]};
}

/// With equal weights 13 % of the failing points pass in six dimensions, and 11 % of the others are left out.
TEST(NearestCases, FindTheCoordinateThatDecides) {
    for (const std::size_t d : {1U, 2U, 4U, 6U}) {
        const auto [passed, left_out] = errors(d, 100, [](std::span<const double> x) { return x[0] < 0.3; });
        EXPECT_LT(passed, 0.04) << d;
        EXPECT_LT(left_out, 0.04) << d;
    }
    const auto [passed, left_out] = errors(4, 200, [](std::span<const double> x) { return x[1] < 0.4 && x[2] > 0.6; });
    EXPECT_LT(passed, 0.15) << "a corner of two";
    EXPECT_LT(left_out, 0.06);
}

}  // namespace grainsweep::tests::stats_nearest_cases_test
