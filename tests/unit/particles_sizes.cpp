// Size distributions and the loose start of unequal spheres.
#include "solver/particles/random_addition.hpp"
#include "solver/particles/size_distribution.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>

using namespace grainsweep;
using namespace grainsweep::particles;

namespace {

/// Mean of d^power by midpoints of u: the quadrature of the inverse distribution.
double quadrature(const SizeDistribution& sizes, int power) {
    constexpr int n = 20'000;
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += std::pow(sizes.diameter((k + 0.5) / n), power) / n;
    return sum;
}

}  // namespace

TEST(SizeDistribution, EqualIsOne) {
    const SizeDistribution equal;
    EXPECT_TRUE(equal.equal());
    EXPECT_EQ(equal.diameter(0.3), 1);
    EXPECT_EQ(equal.moment(3), 1);
    EXPECT_FALSE(SizeDistribution::lognormal(0).equal());
    EXPECT_NEAR(SizeDistribution::lognormal(0).largest(), 1, 1e-15);
}

// Shares of 20,000 draws against those printed: chi-square with 4 degrees of freedom, 18.5 at one in a thousand.
TEST(SizeDistribution, ClassesHaveTheirShares) {
    const std::map<double, double> narrow = {{0.8, 4.44}, {0.9, 22.76}, {1.0, 40.78}, {1.1, 26.91}, {1.2, 5.11}};
    const auto sizes = SizeDistribution::weibull_classes(0.1);
    constexpr std::uint64_t draws = 20'000;
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
        const stats::Stream random(seed, 3);
        std::map<long, double> counts;
        for (std::uint64_t k = 0; k < draws; ++k) ++counts[std::lround(10 * sizes.diameter(random.uniform(k)))];
        ASSERT_EQ(counts.size(), narrow.size());
        double chi_square = 0;
        for (const auto& [d, share] : narrow) {
            const double expected = share / 100 * draws;
            const double seen = counts.at(std::lround(10 * d));
            chi_square += (seen - expected) * (seen - expected) / expected;
        }
        EXPECT_LT(chi_square, 18.5) << "seed " << seed;
    }
    const auto wide = SizeDistribution::weibull_classes(0.15);
    EXPECT_DOUBLE_EQ(wide.smallest(), 0.7);
    EXPECT_DOUBLE_EQ(wide.largest(), 1.3);
    EXPECT_NEAR(wide.moment(1), 1 + 0.0549 * 0.15, 1e-12);
    EXPECT_NEAR(wide.moment(3), quadrature(wide, 3), 1e-4);
}

TEST(SizeDistribution, LognormalHasMeanOneAndItsQuantiles) {
    for (const double spread : {0.05, 0.2, 0.5}) {
        const auto sizes = SizeDistribution::lognormal(spread);
        EXPECT_NEAR(sizes.moment(1), 1, 1e-14);
        EXPECT_NEAR(quadrature(sizes, 1), 1, 1e-5);
        EXPECT_NEAR(quadrature(sizes, 3), sizes.moment(3), 1e-4 * sizes.moment(3));
        // The median's half and the ends of the normal distribution: Phi^-1(0.995) = 2.5758293.
        EXPECT_NEAR(std::log(sizes.largest() / sizes.diameter(0.5)), 2.5758293035 * spread, 1e-9);
        EXPECT_NEAR(std::log(sizes.diameter(0.5) / sizes.smallest()), 2.5758293035 * spread, 1e-9);
        // A quartile of the truncated law: Phi^-1(0.005 + 0.99/4) = -0.6665911.
        EXPECT_NEAR(std::log(sizes.diameter(0.25) / sizes.diameter(0.5)), -0.6666 * spread, 1e-3 * spread);
    }
}

TEST(RandomAddition, LeavesNoOverlapAndFillsTheTray) {
    const Tray tray{{1, -2, 0}, {13, 4, 8}};
    const auto sizes = SizeDistribution::lognormal(0.4);
    const stats::Stream random(5, 1);
    std::vector<double> radii;
    double volume = 0;
    while (volume < 0.25 * 12 * 6 * 8) {
        radii.push_back(sizes.diameter(random.uniform(radii.size())) / 4);
        volume += 4.18879 * std::pow(radii.back(), 3);
    }
    const auto centres = random_addition(tray, radii, 7);
    ASSERT_EQ(centres.size(), radii.size());
    EXPECT_EQ(centres, random_addition(tray, radii, 7));
    EXPECT_NE(centres, random_addition(tray, radii, 8));
    double height = 0;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        for (const std::size_t a : {0U, 2U}) {
            EXPECT_GE(centres[i][a] - radii[i], tray.low[a] - 1e-12);
            EXPECT_LE(centres[i][a] + radii[i], tray.high[a] + 1e-12);
        }
        EXPECT_TRUE(centres[i][1] >= -2 && centres[i][1] < 4);
        height += centres[i][2] / static_cast<double>(radii.size());
        for (std::size_t j = 0; j < i; ++j) {
            const double y = std::remainder(centres[i][1] - centres[j][1], 6.0);
            EXPECT_GE(std::hypot(centres[i][0] - centres[j][0], y, centres[i][2] - centres[j][2]),
                      radii[i] + radii[j] - 1e-12);
        }
    }
    EXPECT_NEAR(height, 4, 0.2);  // no layer is preferred: sd of a mean over about 900 heights is 0.08
}

TEST(RandomAddition, SaysWhenThereIsNoRoom) {
    const Tray tray{{0, 0, 0}, {4, 4, 2}};
    EXPECT_THROW((void)random_addition(tray, std::vector<double>(40, 0.5), 1), std::invalid_argument);  // 0.65
    EXPECT_THROW((void)random_addition(tray, std::vector<double>{1.01}, 1), std::invalid_argument);
    EXPECT_TRUE(random_addition(tray, {}, 1).empty());
}
