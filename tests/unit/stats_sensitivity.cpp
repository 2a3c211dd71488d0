#include "stats/random.hpp"
#include "stats/sensitivity.hpp"
#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace grainsweep::tests::stats_sensitivity_test {

using namespace stats;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// y = sum c_j u_j over u in [0, 1]^d.
std::vector<double> linear(const grainsweep::designs::PointSet& set, const std::vector<double>& c) {
    std::vector<double> values(set.size(), 3.0);
    for (std::size_t p = 0; p < set.size(); ++p)
        for (std::size_t j = 0; j < c.size(); ++j) values[p] += c[j] * set.point(p)[j];
    return values;
}

TEST(FirstOrder, LinearResponseSharesVarianceByTheSquaresOfItsSlopes) {
    const auto set = ask_design("halton", 3, {{"points", 4096}, {"sequences", 8}});
    std::vector<std::size_t> groups(set.size());
    for (std::size_t p = 0; p < set.size(); ++p) groups[p] = p % 8;
    const auto indices = first_order_indices(set.coordinates, 3, linear(set, {1, 2, 4}), groups);
    for (std::size_t j = 0; j < 3; ++j) {
        const double share = std::pow(4.0, static_cast<double>(j)) / 21;
        EXPECT_NEAR(indices.first[j].value, share, 0.002);
        EXPECT_LT(indices.first[j].half_width, 0.01);
        // Within a bin x_j still varies by 1/16 of its range: the bins see 1 - 1/256 of its share.
        EXPECT_NEAR(indices.within_bins[j], share / 256, 0.001);
    }
    EXPECT_EQ(indices.count, 4096);
}

TEST(FirstOrder, FewLevelsHaveABinEach) {
    // y = level on a 5 x 3 lattice: the factor explains everything, the other nothing.
    const auto set = ask_design("lattice", 2, {{"levels", std::vector<std::int64_t>{5, 30}}});
    std::vector<double> values;
    for (std::size_t p = 0; p < set.size(); ++p) values.push_back(set.point(p)[0]);
    const auto indices = first_order_indices(set.coordinates, 2, values);
    EXPECT_NEAR(indices.first[0].value, 1, 1e-12);
    EXPECT_LT(indices.first[1].value, 0.2);
    EXPECT_EQ(indices.within_bins[0], 0);
}

TEST(FirstOrder, MissingValuesAreLeftOutAndCounted) {
    const auto set = ask_design("halton", 2, {{"points", 2000}});
    auto values = linear(set, {1, 1});
    for (std::size_t p = 0; p < values.size(); p += 10) values[p] = missing;
    const auto indices = first_order_indices(set.coordinates, 2, values);
    EXPECT_EQ(indices.count, 1800);
    EXPECT_EQ(indices.excluded, 200);
    EXPECT_NEAR(indices.first[0].value, 0.5, 0.01);
}

TEST(FirstOrder, UndefinedWithoutVarianceOrEnoughRows) {
    const auto set = ask_design("halton", 1, {{"points", 100}});
    EXPECT_TRUE(std::isnan(first_order_indices(set.coordinates, 1, std::vector<double>(100, 2.0)).first[0].value));
    const auto few = ask_design("halton", 1, {{"points", 20}});
    EXPECT_TRUE(std::isnan(first_order_indices(few.coordinates, 1, linear(few, {1})).first[0].value));
}

TEST(FirstOrder, HalfWidthsOfSequencesCoverTheTruth) {
    // y = u1 u2: S_1 = S_2 = 3/7. Half-widths from 8 random sequences must cover that in about 95 % of 100 tries; 88
    // is three standard errors below.
    int covered = 0;
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const auto set = ask_design("halton", 2, {{"points", 2048}, {"sequences", 8}}, seed);
        std::vector<double> values;
        std::vector<std::size_t> groups;
        for (std::size_t p = 0; p < set.size(); ++p) {
            values.push_back(set.point(p)[0] * set.point(p)[1]);
            groups.push_back(p % 8);
        }
        const auto index = first_order_indices(set.coordinates, 2, values, groups).first[0];
        if (std::abs(index.value - 3.0 / 7) <= index.half_width) ++covered;
    }
    EXPECT_GE(covered, 88);
}

TEST(FirstOrder, WhatBinsLoseAndScatterAddsIsInTheBars) {
    // Two waves of sin^2, of which 16 bins lose 5 %, a factor that does nothing, and scatter of the same size.
    int waves = 0, nothing = 0;
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const auto set = ask_design("halton", 2, {{"points", 1024}, {"sequences", 8}}, seed);
        const Stream stream(seed, 5);
        std::vector<double> values;
        std::vector<std::size_t> groups;
        for (std::size_t p = 0; p < set.size(); ++p) {
            // Variances 1/8 and 1/8.
            values.push_back(std::pow(std::sin(6.283185307179586 * set.point(p)[0]), 2) +
                             std::sqrt(1.5) * (stream.uniform(p) - 0.5));
            groups.push_back(p % 8);
        }
        const auto found = first_order_indices(set.coordinates, 2, values, groups).first;
        waves += std::abs(found[0].value - 0.5) <= found[0].half_width ? 1 : 0;
        nothing += std::abs(found[1].value) <= found[1].half_width ? 1 : 0;
        EXPECT_LT(found[0].half_width, 0.12);
    }
    EXPECT_GE(waves, 88);
    EXPECT_GE(nothing, 88);
}

TEST(FirstOrder, AnEffectThatTurnsWithinItsBinsIsInTheBars) {
    // Two periods in four bins: the means of the bins are equal, the index is 1.
    const auto set = ask_design("halton", 1, {{"points", 64}});
    std::vector<double> values;
    for (std::size_t i = 0; i < set.size(); ++i)
        values.push_back(std::pow(std::sin(std::numbers::pi * (2 * set.point(i)[0] - 1)), 2));
    const auto index = first_order_indices(set.coordinates, 1, values, {}, 4).first[0];
    EXPECT_LT(index.value, 0.3);
    EXPECT_GT(index.value + index.half_width, 0.9);
}

TEST(Saltelli, IncompleteRowsAreLeftOutWhole) {
    const auto set = ask_design("saltelli", 2, {{"base_points", 512}});
    auto values = linear(set, {1, 2});
    values[4 * 100 + 3] = missing;
    values.resize(values.size() - 1);  // the last block is not complete
    const auto indices = saltelli_indices(values, 2);
    EXPECT_EQ(indices.count, 510);
    EXPECT_EQ(indices.excluded, 1);
    EXPECT_NEAR(indices.total[0].value, 0.2, 0.03);
    EXPECT_NEAR(indices.first_jansen[1].value, 0.8, 0.03);
    EXPECT_GT(indices.total[0].half_width, 0);
}

TEST(Morris, LinearResponseHasItsSlopesAndNoSpread) {
    const auto set = ask_design("morris", 4, {{"trajectories", 20}});
    const auto effects = elementary_effects(set.coordinates, 4, linear(set, {1, -2, 0, 5}));
    const std::vector<double> slopes = {1, -2, 0, 5};
    for (std::size_t j = 0; j < 4; ++j) {
        EXPECT_NEAR(effects[j].mu, slopes[j], 1e-12);
        EXPECT_NEAR(effects[j].mu_star, std::abs(slopes[j]), 1e-12);
        EXPECT_NEAR(effects[j].sigma, 0, 1e-12);
        EXPECT_EQ(effects[j].count, 20);
    }
}

TEST(Morris, LevelsHaveTheSlopesOfTheirPlaces) {
    // y = n + 3 u2 with n the place of a level: k - 1 per unit of the range whatever k, without spread.
    for (const std::size_t k : {2U, 3U, 4U, 5U, 6U, 7U, 8U, 9U}) {
        const auto set = ask_design("morris", std::vector<std::size_t>{k, 0}, {{"trajectories", 40}});
        const double last = static_cast<double>(k) - 1;
        std::vector<double> coordinates, values;
        for (std::size_t p = 0; p < set.size(); ++p) {
            const double level = std::min(last, std::floor(static_cast<double>(k) * set.point(p)[0]));
            coordinates.insert(coordinates.end(), {level / last, set.point(p)[1]});
            values.push_back(level + 3 * set.point(p)[1]);
        }
        const auto effects = elementary_effects(coordinates, 2, values);
        EXPECT_NEAR(effects[0].mu_star, last, 1e-12) << k;
        EXPECT_NEAR(effects[0].sigma, 0, 1e-12) << k;
        EXPECT_NEAR(effects[1].mu_star, 3, 1e-12) << k;
        EXPECT_EQ(effects[0].count, 40);
    }
}

TEST(Morris, InteractionsShowAsSpreadAndFailuresAreCounted) {
    const auto set = ask_design("morris", 2, {{"trajectories", 200}});
    std::vector<double> values;
    for (std::size_t p = 0; p < set.size(); ++p) values.push_back(set.point(p)[0] * set.point(p)[1]);
    values[0] = missing;
    const auto effects = elementary_effects(set.coordinates, 2, values);
    // dy/du1 = u2, which takes 0, 1/3, 2/3, 1 with equal chance: mean 1/2, standard deviation 0.373.
    EXPECT_NEAR(effects[0].mu_star, 0.5, 0.1);
    EXPECT_NEAR(effects[0].sigma, 0.373, 0.05);
    EXPECT_EQ(effects[0].excluded + effects[1].excluded, 1);
    const auto halton = ask_design("halton", 2, {{"points", 9}});
    EXPECT_THROW((void)elementary_effects(halton.coordinates, 2, std::vector<double>(9, 1.0)), std::invalid_argument);
}

}  // namespace grainsweep::tests::stats_sensitivity_test
