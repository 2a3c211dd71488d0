#include "stats/moments.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace grainsweep::tests::stats_moments_test {

using namespace stats;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<double> uniform(std::size_t n, std::uint64_t seed) {
    Generator generator(seed);
    std::vector<double> values(n);
    for (auto& value : values) value = generator.uniform();
    return values;
}

/// The plain path: two passes in extended precision.
Summary two_pass(const std::vector<double>& values) {
    const auto n = static_cast<long double>(values.size());
    const long double mean = std::accumulate(values.begin(), values.end(), 0.0L) / n;
    long double m2 = 0, m3 = 0, m4 = 0;
    for (const double value : values) {
        const long double d = value - mean;
        m2 += d * d / n;
        m3 += d * d * d / n;
        m4 += d * d * d * d / n;
    }
    Summary s;
    s.mean = static_cast<double>(mean);
    s.sd = static_cast<double>(std::sqrt(m2));
    s.g1 = static_cast<double>(m3 / (m2 * std::sqrt(m2)));
    s.kurtosis = static_cast<double>(m4 / (m2 * m2));
    return s;
}

TEST(Moments, AgreeWithTwoPassesInExtendedPrecision) {
    const auto values = uniform(12'345, 9);
    const Summary s = summarise(values);
    const Summary plain = two_pass(values);
    EXPECT_NEAR(s.mean, plain.mean, 1e-14);
    EXPECT_NEAR(s.sd, plain.sd, 1e-14);
    EXPECT_NEAR(s.g1, plain.g1, 1e-13);
    EXPECT_NEAR(s.kurtosis, plain.kurtosis, 1e-13);
}

TEST(Moments, MergingIsAddingWhereverTheCutIs) {
    const auto values = uniform(4000, 3);
    const Summary whole = summarise(values);
    for (const std::size_t cut : {0U, 1U, 2U, 999U, 1000U, 1001U, 2500U, 3999U, 4000U}) {
        Moments left, right;
        left.add(std::span(values).first(cut));
        right.add(std::span(values).subspan(cut));
        left.merge(right);
        const Summary merged = left.summary(middle(values));
        EXPECT_EQ(merged.count, whole.count);
        for (const Statistic statistic : statistics)
            EXPECT_NEAR(merged.of(statistic), whole.of(statistic), 1e-13) << to_string(statistic) << " cut " << cut;
        EXPECT_EQ(merged.minimum, whole.minimum);
        EXPECT_EQ(merged.maximum, whole.maximum);
    }
}

TEST(Moments, MergingKeepsWhatOffsetsWouldLose) {
    // Two halves around different large offsets: 1e9 + {0, 1} and -1e9 + {0, 1} have mean 0.5 exactly.
    Moments left, right;
    left.add(std::vector{1e9, 1e9 + 1});
    right.add(std::vector{-1e9, -1e9 + 1});
    left.merge(right);
    EXPECT_EQ(left.summary().mean, 0.5);
    EXPECT_DOUBLE_EQ(left.summary().sd, std::sqrt(1e18 + 0.25));
}

TEST(Moments, NoSpreadHasNoShape) {
    const Summary s = summarise(std::vector<double>(1000, 0.1));
    EXPECT_EQ(s.mean, 0.1);
    EXPECT_EQ(s.sd, 0);
    EXPECT_TRUE(std::isnan(s.skewness) && std::isnan(s.g1) && std::isnan(s.kurtosis));
    EXPECT_TRUE(s.representable);
}

TEST(Moments, NonFiniteValuesAreCountedAndLeftOut) {
    const Summary s = summarise(std::vector{missing, 1.0, infinity, 2.0, 4.0, -infinity});
    EXPECT_EQ(s.count, 3);
    EXPECT_EQ(s.excluded, 3);
    EXPECT_DOUBLE_EQ(s.mean, 7.0 / 3);
    EXPECT_EQ(s.median, 2);
    const Summary nothing = summarise(std::vector{missing, missing});
    EXPECT_EQ(nothing.excluded, 2);
    EXPECT_TRUE(std::isnan(nothing.mean) && std::isnan(nothing.sd) && std::isnan(nothing.zero_share));
}

TEST(Moments, WhatDoublesCannotHoldIsFlagged) {
    const Summary huge = summarise(std::vector{1e150, -1e150, 0.0, 2e150});
    EXPECT_FALSE(huge.representable);
    EXPECT_DOUBLE_EQ(huge.mean, 0.5e150);
    EXPECT_TRUE(std::isnan(huge.kurtosis));
    const Summary tiny = summarise(std::vector{1e-300, 2e-300, 4e-300});
    EXPECT_FALSE(tiny.representable);
    EXPECT_TRUE(std::isnan(tiny.sd));  // never zero: the values differ
    const Summary apart = summarise(std::vector{1.7e308, -1.7e308});
    EXPECT_FALSE(apart.representable);
}

TEST(Moments, ZeroSharePearsonAndNames) {
    const Summary s = summarise(std::vector{0.0, -0.0, 1.0, 3.0});
    EXPECT_EQ(s.zero_share, 0.5);
    EXPECT_EQ(s.median, 0.5);
    EXPECT_DOUBLE_EQ(s.skewness, 3 * (1.0 - 0.5) / s.sd);
    for (const Statistic statistic : statistics) EXPECT_EQ(statistic_named(to_string(statistic)), statistic);
    EXPECT_FALSE(statistic_named("skew"));
}

}  // namespace grainsweep::tests::stats_moments_test
