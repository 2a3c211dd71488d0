// Interaction, scatter and main effects of responses whose shares are known in closed form.
#include "stats/random.hpp"
#include "stats/trend.hpp"
#include "stats/variance_split.hpp"
#include "tests/support/ask_design.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

namespace grainsweep::tests::stats_variance_split_test {

using namespace stats;

constexpr double missing = std::numeric_limits<double>::quiet_NaN();

/// A standard normal number (Box & Muller 1958), the same for the same address.
double normal(std::uint64_t seed, std::uint64_t counter) {
    const Stream stream(seed, 7);
    return std::sqrt(-2 * std::log(1 - stream.uniform(2 * counter))) *
           std::cos(2 * std::numbers::pi * stream.uniform(2 * counter + 1));
}

/// Rows of a design with replicates: the same points, `repeats` times each.
struct Rows {
    std::vector<std::int64_t> points;
    std::vector<std::vector<double>> columns;
    std::vector<double> values;
    std::vector<std::size_t> groups;

    Rows(const grainsweep::designs::PointSet& set, std::size_t repeats, double sigma, std::uint64_t seed,
         const std::function<double(std::span<const double>)>& response)
        : columns(set.dimensions) {
        for (std::size_t p = 0; p < set.size(); ++p) {
            for (std::size_t k = 0; k < repeats; ++k) {
                points.push_back(static_cast<std::int64_t>(p));
                for (std::size_t j = 0; j < set.dimensions; ++j) columns[j].push_back(set.point(p)[j]);
                values.push_back(response(set.point(p)) + sigma * normal(seed, values.size()));
                groups.push_back(p % set.sequences);
            }
        }
    }
    [[nodiscard]] VarianceSplit split(std::size_t pieces, bool all_points = false) const {
        std::vector<SplitFactor> factors;
        for (const auto& column : columns) factors.push_back({column, pieces});
        return split_variance(points, factors, values, groups, all_points);
    }
};

/// y = x1 + x2 + c (x1 - 1/2)(x2 - 1/2) on the unit square: V_main = 1/6, V_int = c^2/144.
double bilinear(std::span<const double> u, double c) {
    return u[0] + u[1] + c * (u[0] - 0.5) * (u[1] - 0.5);
}

TEST(PureErrorOfReplicates, IsTheVarianceOfTheScatterWhateverTheResponse) {
    const auto set = ask_design("halton", 2, {{"points", 2000}});
    const Rows rows(set, 3, 0.2, 1, [](auto u) { return 100 * u[0] * u[1]; });
    const auto error = pure_error(rows.points, rows.values);
    EXPECT_EQ(error.freedom, 4000);
    EXPECT_NEAR(error.variance, 0.04, 4 * 0.04 * std::sqrt(2.0 / 4000));  // chi-squared: four standard errors
    EXPECT_NEAR(error.half_width(50), 1.9605 * std::sqrt(error.variance / 50), 1e-4);
}

TEST(PureErrorOfReplicates, NeedsTwoValuesAtAPoint) {
    const std::vector<std::int64_t> points = {0, 0, 1, 1, 2};
    EXPECT_EQ(pure_error(points, std::vector<double>{1, missing, missing, 2, 3}).freedom, 0);
    EXPECT_TRUE(std::isnan(pure_error(points, std::vector<double>{1, missing, missing, 2, 3}).variance));
    EXPECT_TRUE(std::isnan(PureError{}.half_width(4)));
    const auto error = pure_error(points, std::vector<double>{1, 3, 5, 5, 9});
    EXPECT_EQ(error.freedom, 2);
    EXPECT_DOUBLE_EQ(error.variance, 1);  // (1 + 1 + 0 + 0)/2
}

TEST(VarianceSplitOfASample, TellsInteractionFromScatterByReplicates) {
    // V_main = 1/6, V_int = 1/6 x 1/4 (c = sqrt 6), sigma^2 = 1/12: shares 4/7, 1/7, 2/7.
    const auto set = ask_design("halton", 2, {{"points", 2048}, {"sequences", 8}});
    const double sigma = std::sqrt(1.0 / 12), c = std::sqrt(6.0);
    const Rows rows(set, 2, sigma, 3, [&](auto u) { return bilinear(u, c); });
    const auto split = rows.split(8);
    EXPECT_NEAR(split.main_effects.value, 4.0 / 7, 2 * split.main_effects.half_width);
    EXPECT_NEAR(split.interactions.value, 1.0 / 7, 2 * split.interactions.half_width);
    EXPECT_NEAR(split.scatter.value, 2.0 / 7, 2 * split.scatter.half_width);
    EXPECT_LT(split.main_effects.half_width, 0.05);
    EXPECT_LT(split.interactions.half_width, 0.04);
    EXPECT_LT(split.scatter.half_width, 0.04);
    EXPECT_NEAR(split.interactions.value + split.scatter.value, split.unexplained.value, 1e-12);
    EXPECT_NEAR(split.main_effects.value + split.unexplained.value, 1, 1e-12);
    EXPECT_EQ(split.pure.freedom, 2048);
}

TEST(VarianceSplitOfASample, CoversTheTruthAsOftenAsItSays) {
    // 100 tries of 95 % half-widths from 8 sequences; 88 is three standard errors below.
    int main = 0, interactions = 0, scatter = 0;
    const double sigma = std::sqrt(1.0 / 12), c = std::sqrt(6.0);
    for (std::uint64_t seed = 1; seed <= 100; ++seed) {
        const auto set = ask_design("halton", 2, {{"points", 320}, {"sequences", 8}}, seed);
        const auto split = Rows(set, 2, sigma, seed, [&](auto u) { return bilinear(u, c); }).split(4);
        main += std::abs(split.main_effects.value - 4.0 / 7) <= split.main_effects.half_width;
        interactions += std::abs(split.interactions.value - 1.0 / 7) <= split.interactions.half_width;
        scatter += std::abs(split.scatter.value - 2.0 / 7) <= split.scatter.half_width;
    }
    EXPECT_GE(main, 88);
    EXPECT_GE(interactions, 88);
    EXPECT_GE(scatter, 88);
}

TEST(VarianceSplitOfASample, WithoutReplicatesInteractionsAreNotToldFromScatter) {
    const auto set = ask_design("halton", 3, {{"points", 1600}, {"sequences", 8}});
    const double c = std::sqrt(6.0);
    const Rows rows(set, 1, std::sqrt(1.0 / 12), 5, [&](auto u) { return bilinear(u, c); });
    const auto split = rows.split(8);
    EXPECT_TRUE(std::isnan(split.scatter.value));
    EXPECT_TRUE(std::isnan(split.interactions.value));
    EXPECT_NEAR(split.unexplained.value, 3.0 / 7, 2 * split.unexplained.half_width);
}

TEST(VarianceSplitOfASample, AnAdditiveResponseWithoutScatterIsExplained) {
    const auto set = ask_design("halton", 3, {{"points", 800}, {"sequences", 8}});
    const Rows rows(set, 1, 0, 1, [](auto u) { return std::sin(3 * u[0]) + u[1] * u[1] + 0.1 * u[2]; });
    const auto split = rows.split(15);
    EXPECT_NEAR(split.main_effects.value, 1, 1e-4);
    EXPECT_NEAR(split.unexplained.value, 0, 1e-4);
}

TEST(VarianceSplitOfALattice, IsTheAnalysisOfVarianceOfItsOwnPoints) {
    // y = x1 + x2 + c (x1 - 1/2)(x2 - 1/2) on k x k points of [0, 1]: the variance of one coordinate is
    // v = (k + 1)/(12 (k - 1)); V_main = 2 v, V_int = c^2 v^2.
    const auto set = ask_design("lattice", 2, {{"levels", std::vector<std::int64_t>{7, 7}}});
    const double v = 8.0 / (12 * 6), c = 1.5, sigma = 0.2;
    const double total = 2 * v + c * c * v * v + sigma * sigma;
    int main = 0, interactions = 0, scatter = 0;
    double mean_interactions = 0;
    for (std::uint64_t seed = 1; seed <= 200; ++seed) {
        const auto split = Rows(set, 4, sigma, seed, [&](auto u) { return bilinear(u, c); }).split(0, true);
        main += std::abs(split.main_effects.value - 2 * v / total) <= split.main_effects.half_width;
        interactions += std::abs(split.interactions.value - c * c * v * v / total) <= split.interactions.half_width;
        scatter += std::abs(split.scatter.value - sigma * sigma / total) <= split.scatter.half_width;
        mean_interactions += split.interactions.value / 200;
    }
    EXPECT_NEAR(mean_interactions, c * c * v * v / total, 0.003);
    for (const int covered : {main, interactions, scatter}) EXPECT_GE(covered, 181);  // three standard errors below
}

TEST(VarianceSplitOfALattice, WithoutReplicatesHasAnExactRestAndNoError) {
    const auto set = ask_design("lattice", 2, {{"levels", std::vector<std::int64_t>{5, 5}}});
    const double v = 6.0 / (12 * 4), c = 2;
    const auto split = Rows(set, 1, 0, 1, [&](auto u) { return bilinear(u, c); }).split(0, true);
    EXPECT_NEAR(split.unexplained.value, c * c * v * v / (2 * v + c * c * v * v), 1e-12);
    EXPECT_TRUE(std::isnan(split.unexplained.half_width));
    EXPECT_TRUE(std::isnan(split.scatter.value));
}

TEST(VarianceSplitOfALattice, LevelsWithoutOrderAndMissingRowsAreAnsweredToo) {
    const std::vector<double> word = {0, 0, 1, 1, 2, 2}, number = {0, 1, 0, 1, 0, 1};
    const std::vector<std::int64_t> points = {0, 1, 2, 3, 4, 5};
    const std::vector<std::size_t> groups(6, 0);
    const std::vector<SplitFactor> factors = {{word, 0}, {number, 0}};
    const std::vector<double> additive = {1, 2, 7, 8, missing, 4};
    EXPECT_NEAR(split_variance(points, factors, additive, groups, true).unexplained.value, 0, 1e-12);
    EXPECT_EQ(split_variance(points, factors, additive, groups, true).points, 5);
    const std::vector<double> constant(6, 3.0);
    EXPECT_TRUE(std::isnan(split_variance(points, factors, constant, groups, true).unexplained.value));
}

TEST(VarianceSplitOfASample, TooFewPointsGiveNothing) {
    const auto set = ask_design("halton", 3, {{"points", 20}, {"sequences", 4}});
    EXPECT_TRUE(std::isnan(Rows(set, 1, 0, 1, [](auto u) { return u[0]; }).split(4).unexplained.value));
}

TEST(RankCorrelation, SeesOrderOnlyAndSharesTies) {
    std::vector<double> x, rising, falling, bent;
    std::vector<std::size_t> groups;
    for (int i = 0; i <= 40; ++i) {
        x.push_back(i);
        rising.push_back(std::exp(0.3 * i));
        falling.push_back(-std::pow(i, 3));
        bent.push_back((i - 20) * (i - 20));
        groups.push_back(static_cast<std::size_t>(i % 5));
    }
    EXPECT_DOUBLE_EQ(rank_correlation(x, rising, groups).value, 1);
    EXPECT_DOUBLE_EQ(rank_correlation(x, falling, groups).value, -1);
    EXPECT_NEAR(rank_correlation(x, bent, groups).value, 0, 1e-12);
    EXPECT_GT(rank_correlation(x, bent, groups).half_width, 0);
    // 1 2 2 3 against 1 2 3 3: ranks 0 1.5 1.5 3 and 0 1 2.5 2.5, both with a sum of squares of 4.5; of products 3.75.
    const std::vector<std::size_t> one(4, 0);
    const auto tied = rank_correlation(std::vector<double>{1, 2, 2, 3}, std::vector<double>{1, 2, 3, 3}, one);
    EXPECT_DOUBLE_EQ(tied.value, 3.75 / 4.5);
    EXPECT_TRUE(std::isnan(tied.half_width));
    EXPECT_TRUE(std::isnan(rank_correlation(x, std::vector<double>(41, 1.0), groups).value));
}

TEST(RisingShare, IsWhatTheBestRisingSequenceExplains) {
    const std::vector<double> equal(4, 1.0);
    EXPECT_DOUBLE_EQ(rising_share(std::vector<double>{1, 2, 3, 4}, equal), 1);
    EXPECT_DOUBLE_EQ(rising_share(std::vector<double>{4, 3, 2, 1}, equal), 0);
    // 1 3 2 4: the middle pools to 2.5; (2.25 + 0 + 0 + 2.25)/5.
    EXPECT_DOUBLE_EQ(rising_share(std::vector<double>{1, 3, 2, 4}, equal), 4.5 / 5);
    EXPECT_TRUE(std::isnan(rising_share(equal, equal)));
}

}  // namespace grainsweep::tests::stats_variance_split_test
