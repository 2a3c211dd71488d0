#include "solver/observables/layer.hpp"
#include "solver/observables/series.hpp"

#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::observables_layer_test {

using namespace observables;

dem::State spheres(std::vector<dem::Vec3> positions, double radius) {
    dem::State s;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        s.id.push_back(static_cast<std::int32_t>(i));
        s.velocity.push_back({static_cast<double>(i + 1), 0, 0});
        s.radius.push_back(radius);
    }
    s.position = std::move(positions);
    return s;
}

TEST(Layer, SumsOverCentres) {
    const auto s = spheres({{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {1.5, 0, 4}}, 0.5);
    EXPECT_NEAR(solid_volume(s, 0.5, 2), 2 * std::numbers::pi / 6, 1e-15);  // x < to: a centre in the plane is beyond
}

// Exactly straight, one corner, noise: the second difference of independent values of variance 1 has variance 6.
TEST(Layer, UnevennessIsTheBendOfAProfile) {
    EXPECT_EQ(unevenness(std::vector<double>{1, 2, 3, 4, 5}), 0);
    EXPECT_DOUBLE_EQ(unevenness(std::vector<double>{0, 0, 0, 1, 2}), std::sqrt(1.0 / 3));
    const double none = std::nan("");
    EXPECT_DOUBLE_EQ(unevenness(std::vector<double>{0, 0, 3, none, 7, 8, 9}), std::sqrt(9.0 / 2));
    EXPECT_TRUE(std::isnan(unevenness(std::vector<double>{1, 2, none, 4, 5, none})));
    EXPECT_TRUE(std::isnan(unevenness(std::vector<double>{1, 2})));
    const stats::Stream random(1, 1);
    std::vector<double> noise;
    for (std::uint64_t k = 0; k < 20'000; ++k) noise.push_back(std::sqrt(12.0) * random.uniform(k));
    EXPECT_NEAR(unevenness(noise), std::sqrt(6.0), 0.03);
}

TEST(Layer, ReliefSeesTheUppermostSurfaceAcrossThePeriod) {
    // One sphere at the periodic edge of a patch of 4 x 4: a disc of area pi is covered, half of it beyond the edge.
    const Relief one(spheres({{2, 0, 5}}, 1), 0, 4, 4, 0.01);
    EXPECT_EQ(one.heights().size(), 160000U);
    EXPECT_NEAR(one.empty_share(), 1 - std::numbers::pi / 16, 1e-3);
    // Mean height and Sq of a hemisphere on a cylinder 5 high in an empty square, in closed form.
    const double mean = (5 * std::numbers::pi + 2 * std::numbers::pi / 3) / 16;
    const double square = (25 * std::numbers::pi + 10 * 2 * std::numbers::pi / 3 + std::numbers::pi / 2) / 16;
    EXPECT_NEAR(one.roughness(), std::sqrt(square - mean * mean), 5e-3);
    // A second one, lower and at the same place, changes nothing; higher it does.
    EXPECT_EQ(Relief(spheres({{2, 0, 5}, {2, 0, 4}}, 1), 0, 4, 4, 0.1).roughness(),
              Relief(spheres({{2, 0, 5}}, 1), 0, 4, 4, 0.1).roughness());
    EXPECT_GT(Relief(spheres({{2, 0, 5}, {2, 0, 6}}, 1), 0, 4, 4, 0.1).roughness(),
              Relief(spheres({{2, 0, 5}}, 1), 0, 4, 4, 0.1).roughness());
    EXPECT_EQ(Relief(spheres({}, 1), 0, 4, 4, 0.1).empty_share(), 1);
}

TEST(Layer, PlanesCutSpheres) {
    const double whole = 4 * std::numbers::pi / 3;
    EXPECT_NEAR(sphere_below(10, 1), whole, 1e-14);
    EXPECT_NEAR(sphere_below(0, 1), whole / 2, 1e-14);
    EXPECT_NEAR(sphere_below(-2, 1), 0, 1e-15);
    // A cap of height h has the volume pi h^2 (3 - h)/3.
    EXPECT_NEAR(sphere_below(-0.5, 1), std::numbers::pi * 0.25 * 2.5 / 3, 1e-14);
}

TEST(Layer, PatchesSpreadAsTheirVolumes) {
    Patches patches(0, 4, 2, 1.1);
    EXPECT_EQ(patches.size(), 8U);
    EXPECT_DOUBLE_EQ(patches.area(), 1);
    EXPECT_EQ(patches.deviation(), 0);
    patches.add(spheres({{0.5, 0.5, 0}, {3.9, -0.1, 0}, {9, 0.5, 0}}, 1));  // one beyond, one across the period
    const double v = 4 * std::numbers::pi / 3;
    EXPECT_NEAR(patches.deviation(), v * std::sqrt(2.0 / 8 - 1.0 / 16), 1e-12);
    patches.add(spheres({{0.7, 0.2, 9}, {3.1, 1.1, 9}}, 1), -1);
    EXPECT_NEAR(patches.deviation(), 0, 1e-12);
    EXPECT_TRUE(std::isnan(Patches(0, 1, 1, 1).deviation()));
    // Of a wide layer of few spheres only patches with a sphere are kept: these would be 8 PB.
    Patches wide(0, 1e8, 1e7, 1);
    wide.add(spheres({{0.5, 0.5, 0}}, 1));
    EXPECT_EQ(wide.size(), 1'000'000'000'000'000U);
    Patches bare(0, 1e3, 1e3, 1);
    bare.add(spheres({{0.5, 0.5, 0}, {999.5, 999.5, 0}}, 1));
    EXPECT_NEAR(bare.deviation(), v * std::sqrt(2e-6 - 4e-12), 1e-12);
}

TEST(Layer, ProfileAveragesByHeight) {
    const auto s = spheres({{1, 0, 2.1}, {1, 0, 2.2}, {1, 0, 2.9}, {9, 0, 2.1}, {1, 0, 1.9}, {1, 0, 99}}, 0.5);
    VelocityProfile profile(3);
    profile.add(s, 0, 2, 2.0, 0.5);
    EXPECT_EQ(profile.samples, (std::vector<std::int64_t>{2, 1, 0}));
    EXPECT_EQ(profile.sum, (std::vector<double>{3, 3, 0}));
}

// Independent samples: the blocks' error is that of the mean, sigma/sqrt(n). An AR(1) series with coefficient a has
// (1 + a)/(1 - a) times its variance. Over 400 series the mean of the estimate is known to about 2 %.
TEST(Layer, BlockErrorIsThatOfTheMean) {
    for (const double a : {0.0, 0.5}) {
        double squares = 0;
        constexpr std::size_t n = 1000;
        for (std::uint64_t k = 0; k < 400; ++k) {
            const stats::Stream random(k, 5);
            std::vector<double> series;
            double x = 0;
            for (std::uint64_t i = 0; i < n + 50; ++i) {
                x = a * x + (random.uniform(i) - 0.5) * std::sqrt(12.0);
                if (i >= 50) series.push_back(x);
            }
            const double error = block_standard_error(series, 10);
            squares += error * error / 400;
        }
        const double expected = 1 / ((1 - a) * (1 - a)) / static_cast<double>(n);
        EXPECT_NEAR(squares / expected, 1, 0.1) << a;
    }
    EXPECT_TRUE(std::isnan(block_standard_error(std::vector<double>(19, 1.0), 10)));
    EXPECT_NEAR(block_standard_error(std::vector<double>(20, 1.0), 10), 0, 1e-15);
}

}  // namespace grainsweep::tests::observables_layer_test
