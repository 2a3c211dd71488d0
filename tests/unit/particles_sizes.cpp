// Size distributions and the loose start of unequal spheres.
#include "solver/particles/random_addition.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/particles/size_table.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>

namespace grainsweep::tests::particles_sizes_test {

using namespace particles;

/// Mean of d^power by midpoints of u: the quadrature of the inverse distribution.
double quadrature(const SizeDistribution& sizes, int power) {
    constexpr int n = 20'000;
    double sum = 0;
    for (int k = 0; k < n; ++k) sum += std::pow(sizes.diameter((k + 0.5) / n), power) / n;
    return sum;
}

TEST(SizeDistribution, EqualIsOne) {
    const SizeDistribution equal;
    EXPECT_TRUE(equal.equal());
    EXPECT_EQ(equal.diameter(0.3), 1);
    EXPECT_EQ(equal.moment(3), 1);
    EXPECT_FALSE(SizeDistribution::lognormal(0).equal());
    EXPECT_NEAR(SizeDistribution::lognormal(0).largest(), 1, 1e-15);
}

TEST(SizeDistribution, UniformHasItsMoments) {
    const auto sizes = SizeDistribution::uniform(0.3);
    EXPECT_DOUBLE_EQ(sizes.smallest(), 0.7);
    EXPECT_DOUBLE_EQ(sizes.moment(2), 1 + 0.3 * 0.3 / 3);
    EXPECT_NEAR(sizes.moment(3), quadrature(sizes, 3), 1e-8);
    EXPECT_EQ(SizeDistribution::uniform(0).moment(3), 1);
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

TEST(RandomAddition, LeavesNoOverlapAndFillsTheRoom) {
    const Room room{{1, -2, 0}, {13, 4, 8}, {false, true, false}, {}};
    const auto sizes = SizeDistribution::lognormal(0.4);
    const stats::Stream random(5, 1);
    std::vector<double> radii;
    double volume = 0;
    while (volume < 0.25 * 12 * 6 * 8) {
        radii.push_back(sizes.diameter(random.uniform(radii.size())) / 4);
        volume += 4.18879 * std::pow(radii.back(), 3);
    }
    const auto placed = random_addition(room, radii, 7);
    ASSERT_TRUE(placed);
    const auto& centres = *placed;
    ASSERT_EQ(centres.size(), radii.size());
    EXPECT_EQ(placed, random_addition(room, radii, 7));
    EXPECT_NE(placed, random_addition(room, radii, 8));
    double height = 0;
    for (std::size_t i = 0; i < radii.size(); ++i) {
        for (const std::size_t a : {0U, 2U}) {
            EXPECT_GE(centres[i][a] - radii[i], room.low[a] - 1e-12);
            EXPECT_LE(centres[i][a] + radii[i], room.high[a] + 1e-12);
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
    const Room room{{0, 0, 0}, {4, 4, 2}, {false, true, false}, {}};
    EXPECT_FALSE(random_addition(room, std::vector<double>(40, 0.5), 1));  // a fraction of 0.65
    EXPECT_THROW((void)random_addition(room, std::vector<double>{1.01}, 1), std::invalid_argument);
    EXPECT_TRUE(random_addition(room, {}, 1)->empty());
}

// Sampled moments against the table's, and those against what its text says.
TEST(SizeTable, SamplesHaveTheMomentsOfTheFile) {
    for (const char* header : {"number_fraction", "volume_fraction", "number_below", "volume_below"}) {
        const bool below = std::string_view(header).ends_with("below");
        const auto table = SizeTable::read("diameter," + std::string(header) +
                                           (below ? "\n20e-6,0\n30e-6,0.25\n40e-6,0.7\n60e-6,1\n"
                                                  : "\n20e-6,0.3\n 30e-6, 0.5 \r\n\n60e-6,0.2\n"))
                               .over(30e-6);
        const auto sizes = SizeDistribution::table(table);
        for (const int power : {1, 2, 3})
            EXPECT_NEAR(sizes.moment(power) / quadrature(sizes, power), 1, 2e-4) << header << " " << power;
        const stats::Stream random(7, 3);
        constexpr std::uint64_t draws = 40'000;
        double sum = 0, squares = 0;
        for (std::uint64_t k = 0; k < draws; ++k) {
            const double v = std::pow(sizes.diameter(random.uniform(k)), 3);
            sum += v, squares += v * v;
        }
        const double mean = sum / draws, error = std::sqrt((squares / draws - mean * mean) / draws);
        EXPECT_NEAR(mean, sizes.moment(3), 4 * error) << header;
        EXPECT_NEAR(sizes.smallest(), 2.0 / 3, 1e-12);
        EXPECT_NEAR(sizes.largest(), 2, 1e-12);
    }
}

TEST(SizeTable, SharesOfTheVolumeAreThose) {
    const auto classes = SizeTable::read("diameter,volume_fraction\n1e-4,0.5\n2e-4,0.5\n").over(1e-4);
    // Half of the volume in spheres of eight times the volume: one in nine.
    EXPECT_NEAR(classes.moment(1), (8 + 2) / 9.0, 1e-12);
    EXPECT_EQ(classes.diameter(0.888), 1);
    EXPECT_EQ(classes.diameter(0.889), 2);
    const auto even = SizeTable::read("diameter,volume_below\n1e-4,0\n3e-4,1\n").over(1e-4);
    double volume = 0, lower = 0;
    constexpr int n = 100'000;
    for (int k = 0; k < n; ++k) {
        const double d = even.diameter((k + 0.5) / n);
        volume += d * d * d;
        if (d < 2) lower += d * d * d;
    }
    EXPECT_NEAR(lower / volume, 0.5, 1e-4);  // evenly from 1 to 3
}

TEST(SizeTable, OtherTextsAreRefusedInOneSentence) {
    const auto why = [](std::string_view text) -> std::string {
        try {
            (void)SizeTable::read(text);
        } catch (const std::invalid_argument& refusal) {
            return refusal.what();
        }
        return "";
    };
    const auto says = [&](std::string_view text, const char* part) {
        EXPECT_NE(why(text).find(part), std::string::npos) << why(text);
    };
    says("", "no diameter");
    says("diameter,fraction\n1e-3,1\n", "header");
    says("diameter,number_fraction\n", "no diameter");
    says("diameter,number_fraction\n1e-3;1\n", "line 2");
    says("diameter,number_fraction\n1200,1\n", "in m");
    says("diameter,number_fraction\n2e-3,0.5\n1e-3,0.5\n", "line 3");
    says("diameter,number_fraction\n1e-3,0.5\n2e-3,0.3\n", "add up to 0.8");
    says("diameter,number_fraction\n1e-3,-0.1\n", "outside 0 to 1");
    says("diameter,number_below\n1e-3,0\n2e-3,0.5\n3e-3,0.4\n4e-3,1\n", "must not fall");
    says("diameter,volume_below\n1e-3,0.1\n2e-3,1\n", "begin with 0");
    EXPECT_EQ(why("\xEF\xBB\xBF"
                  "diameter , number_fraction\n1e-3,1\n"),
              "");
}

}  // namespace grainsweep::tests::particles_sizes_test
