// Quantile functions of distributions, and rows of numbers as the image of the unit cube.
#include "stats/distribution.hpp"
#include "stats/random.hpp"
#include "tests/support/known_responses.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <vector>

namespace grainsweep::tests::stats_distribution_test {

using namespace stats;

std::vector<Distribution> all_forms() {
    const std::vector<double> values = {0.2, 0.5, 0.5, 0.9, 0.1};
    return {
        Distribution(Normal{34e-6, 3e-6}, 0),
        Distribution(Normal{0.5, 0.3}, 0, 1),
        Distribution(Lognormal{2, 0.7}),
        Distribution(Lognormal{0.3, 0.5}, 0, 1),
        Distribution(Weibull{60e-6, 3}),
        Distribution(Weibull{0.4, 0.8}, 0, 1),
        Distribution(Gumbel{1, 0.1}),
        Distribution(Gumbel{0.5, 0.2}, 0, 1),
        Distribution(Triangular{1, 2, 5}),
        Distribution(Triangular{1, 1, 5}),
        Distribution(Triangular{1, 5, 5}),
        Distribution(Beta{-1, 3, 2, 5}),
        Distribution(Beta{0, 1, 0.5, 0.5}),
        Distribution(SampleColumn{std::make_shared<const JointSample>(std::vector<std::vector<double>>{values}), 0})};
}

TEST(Distribution, QuantilesAreFiniteRiseAndStayWithinTheBounds) {
    for (const auto& distribution : all_forms()) {
        double before = -std::numeric_limits<double>::infinity();
        for (const double u : {0.0, 1e-300, 1e-12, 1e-6, 0.01, 0.25, 0.5, 0.75, 0.99, 1 - 1e-6, 1 - 1e-16, 1.0}) {
            const double x = distribution.quantile(u);
            EXPECT_TRUE(std::isfinite(x)) << distribution.form().index() << " at " << u;
            EXPECT_GE(x, before);
            EXPECT_GE(x, distribution.low());
            EXPECT_LE(x, distribution.high());
            before = x;
        }
        EXPECT_EQ(distribution.quantile(0) == distribution.low() && distribution.quantile(1) == distribution.high(),
                  distribution.has_ends());
    }
}

TEST(Distribution, TheDistributionFunctionIsTheInverse) {
    for (const auto& distribution : all_forms()) {
        if (std::holds_alternative<SampleColumn>(distribution.form())) continue;  // constant at its ends
        for (const double u : {1e-6, 0.001, 0.125, 0.5, 0.875, 0.999, 1 - 1e-6})
            EXPECT_NEAR(distribution.cumulative(distribution.quantile(u)), u, 1e-11) << distribution.form().index();
        EXPECT_EQ(distribution.cumulative(-1e9), 0);
        EXPECT_EQ(distribution.cumulative(1e9), 1);
    }
}

TEST(Distribution, WeibullAndGumbelHaveTheirClosedForms) {
    const Distribution weibull(Weibull{2, 3}), largest(Gumbel{1, 0.5});
    for (const double u : {0.01, 0.5, 0.99}) {
        EXPECT_NEAR(weibull.quantile(u), 2 * std::cbrt(-std::log(1 - u)), 1e-12);
        EXPECT_NEAR(largest.quantile(u), 1 - 0.5 * std::log(-std::log(u)), 1e-12);
    }
    const Distribution cut(Gumbel{0, 1}, 0);
    EXPECT_NEAR(cut.cut(), std::exp(-1), 1e-12) << "the share below the location";
    EXPECT_NEAR(cut.quantile(0.5), -std::log(-std::log((1 + std::exp(-1)) / 2)), 1e-12);
}

TEST(Distribution, QuantilesAreThoseOfClosedForms) {
    constexpr double z = 1.959963984540054;  // of the standard normal distribution at 0.975
    EXPECT_NEAR(Distribution(Normal{2, 3}).quantile(0.975), 2 + 3 * z, 1e-14 * 8);
    EXPECT_NEAR(Distribution(Normal{2, 3}).quantile(0.025), 2 - 3 * z, 1e-14 * 8);
    EXPECT_NEAR(Distribution(Lognormal{2, 0.5}).quantile(0.975), 2 * std::exp(0.5 * z), 1e-13);
    EXPECT_NEAR(Distribution(Triangular{1, 2, 5}).quantile(0.16), 1 + std::sqrt(0.16 * 4 * 1), 1e-14);
    EXPECT_NEAR(Distribution(Triangular{1, 2, 5}).quantile(0.84), 5 - std::sqrt(0.16 * 4 * 3), 1e-14);
    EXPECT_NEAR(Distribution(Beta{-1, 3, 2, 1}).quantile(0.25), -1 + 4 * 0.5, 1e-14);  // F = z^2
    EXPECT_NEAR(Distribution(Beta{0, 1, 1, 1}).quantile(0.3), 0.3, 1e-15);
}

TEST(Distribution, TruncationKeepsTheShapeAndSaysWhatItCuts) {
    const Distribution whole(Normal{0.5, 0.3}), part(Normal{0.5, 0.3}, 0, 1);
    const double below = whole.cumulative(0), above = 1 - whole.cumulative(1);
    EXPECT_NEAR(part.cut(), below + above, 1e-15);
    EXPECT_EQ(whole.cut(), 0);
    for (const double u : {0.1, 0.5, 0.9})
        EXPECT_NEAR(part.quantile(u), whole.quantile(below + u * (1 - below - above)), 1e-12);
    EXPECT_EQ(Distribution(Lognormal{2, 0.7}, 0).cut(), 0);
    EXPECT_LT(Distribution(Normal{34e-6, 3e-6}, 0).cut(), 1e-29);
}

TEST(Distribution, TheRangeOfWhatHasNoEndsIsItsCentralPart) {
    const auto [low, high] = Distribution(Normal{0, 1}).range();
    EXPECT_NEAR(high, 3.090232306167813, 1e-12);
    EXPECT_EQ(low, -high);
    EXPECT_EQ(Distribution(Triangular{1, 2, 5}).range(), std::pair(1.0, 5.0));
}

TEST(JointSample, AColumnHasTheMeanOfItsValues) {
    const JointSample sample({{3, 1, 10, 2, 2}});
    double sum = 0;
    constexpr int points = 1000;
    for (int i = 0; i < points; ++i) sum += sample.quantile(0, (i + 0.5) / points);
    EXPECT_NEAR(sum / points, 3.6, 1e-12);
    EXPECT_EQ(sample.quantile(0, 0), 1);
    EXPECT_EQ(sample.quantile(0, 1), 10);
    EXPECT_NEAR(sample.cumulative(0, 2), 0.4, 1e-15) << "the middle of two equal values";
    EXPECT_NEAR(sample.cumulative(0, sample.quantile(0, 0.85)), 0.85, 1e-15);
}

/// x normal, y = x^2 and a little scatter: no correlation, and not independent.
JointSample banana(std::size_t rows) {
    std::vector<std::vector<double>> columns(2);
    const Stream stream(3, 4);
    for (std::size_t i = 0; i < rows; ++i) {
        columns[0].push_back(normal_at(stream, 2 * i));
        columns[1].push_back(columns[0].back() * columns[0].back() + 0.05 * normal_at(stream, 2 * i + 1));
    }
    return JointSample(columns);
}

TEST(JointSample, EveryRowHasABoxOfTheSameVolume) {
    for (const std::size_t rows : {2U, 7U, 30U, 64U}) {
        const auto sample = banana(rows);
        std::vector<double> hits(rows, 0);
        constexpr std::size_t grid = 840;  // a multiple of all widths
        for (std::size_t i = 0; i < grid; ++i)
            for (std::size_t k = 0; k < grid; ++k) {
                const double u[] = {(static_cast<double>(i) + 0.5) / grid, (static_cast<double>(k) + 0.5) / grid};
                hits[sample.row_at(u)] += 1.0 / (grid * grid);
            }
        for (const double share : hits)
            EXPECT_NEAR(share, 1.0 / static_cast<double>(rows), 3e-3 / static_cast<double>(rows));
    }
}

TEST(JointSample, KeepsADependenceThatNoCorrelationShows) {
    const auto sample = banana(2000);
    double xy = 0, xxy = 0, of_rows = 0;
    constexpr std::size_t points = 4096;
    const auto set = ask_design("sobol", 2, {{"points", std::int64_t{points}}, {"scramble", std::string("random")}});
    for (std::size_t i = 0; i < points; ++i) {
        const auto row = sample.row_at(set.point(i));
        const double x = sample.column(0)[row], y = sample.column(1)[row];
        EXPECT_LT(std::abs(y - x * x), 0.25) << "a point beside the banana";
        xy += x * y / points;
        xxy += x * x * y / points;
    }
    for (std::size_t i = 0; i < sample.rows(); ++i)
        of_rows += std::pow(sample.column(0)[i], 2) * sample.column(1)[i] / static_cast<double>(sample.rows());
    EXPECT_NEAR(xxy, of_rows, 0.02 * of_rows);
    EXPECT_LT(std::abs(xy), 0.25);
}

TEST(JointSample, TheFirstColumnRisesWithItsCoordinateAndTheNextWithinIt) {
    const auto sample = banana(900);
    double before = -1e9;
    for (double u = 0.01; u < 1; u += 0.1) {
        const double place[] = {u, 0.5};
        const double x = sample.column(0)[sample.row_at(place)];
        EXPECT_GT(x, before);
        before = x;
    }
    const double low[] = {0.9, 0.05}, high[] = {0.9, 0.95};
    EXPECT_LT(sample.column(1)[sample.row_at(low)], sample.column(1)[sample.row_at(high)]);
}

TEST(JointSample, ARowIsFoundByItsValues) {
    const auto sample = banana(500);
    for (std::size_t row = 0; row < sample.rows(); row += 7) {
        const double values[] = {sample.column(0)[row], sample.column(1)[row]};
        const auto place = sample.place_of(values);
        ASSERT_TRUE(place);
        EXPECT_EQ(sample.row_at(*place), row);
    }
    const double elsewhere[] = {0.0, 0.0};
    EXPECT_FALSE(sample.place_of(elsewhere));
    const JointSample twice({{1, 1, 1, 2}, {5, 5, 5, 6}});
    const double equal[] = {1.0, 5.0};
    ASSERT_TRUE(twice.place_of(equal));
    EXPECT_EQ(twice.column(0)[twice.row_at(*twice.place_of(equal))], 1);
}

}  // namespace grainsweep::tests::stats_distribution_test
