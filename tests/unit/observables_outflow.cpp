// What has left a hopper, on states that are counted by hand.
#include "solver/observables/outflow.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::observables_outflow_test {

using namespace observables;

TEST(Outflow, CountsWhatIsBelowAndWhatIsGone) {
    dem::State state;
    state.id = {0, 2, 4};  // 1 and 3 are gone
    state.position = {{0, 0, 1}, {0, 0, -0.5}, {0, 0, 0}};
    const std::vector<double> radius = {1, 2, 1, 1, 3};
    const auto out = outflow(state, radius, 2, 0.7);
    EXPECT_EQ(out.count, 4);
    EXPECT_DOUBLE_EQ(out.diameters, 2 * (2 + 1 + 1 + 3));
    EXPECT_DOUBLE_EQ(out.mass, 2 * 4.0 / 3 * std::numbers::pi * (8 + 1 + 1 + 27));
    EXPECT_EQ(out.time, 0.7);
}

TEST(Outflow, ASteadyRateIsFoundBetweenTheShares) {
    std::vector<Outflow> frames;
    for (int k = 0; k <= 100; ++k) {
        const double t = 0.02 * k;
        // Slow at first, then 3 kg/s, of which 1 kg in all; what leaves is 5 mm wide, 4 mm at first.
        const double mass = t < 0.1 ? 0.5 * t : std::min(1.0, 0.05 + 3 * (t - 0.1));
        const auto count = static_cast<std::int64_t>(std::llround(1000 * mass));
        frames.push_back({t, mass, 5e-3 * static_cast<double>(count) - (t < 0.1 ? 0 : 0.01), count});
    }
    const auto found = rate_between(frames, 1, 0.1, 0.5);
    EXPECT_NEAR(found.rate, 3, 1e-9);
    EXPECT_NEAR(found.mean_diameter, 5e-3, 1e-12);
    EXPECT_TRUE(std::isnan(rate_between(frames, 100, 0.1, 0.5).rate));
    EXPECT_TRUE(std::isnan(rate_between({}, 1, 0.1, 0.5).rate));
}

TEST(Outflow, TheSpaceOverTheOpeningIsItsColumn) {
    dem::State state;
    state.position = {{0.5, 0, 0.1}, {0, 3, 0.1}, {0, 0, 2.1}, {0, 0, -0.1}};
    state.radius = {1, 1, 1, 1};
    const double one = 4.0 / 3 * std::numbers::pi;
    EXPECT_DOUBLE_EQ(solid_over_opening(state, 1, 2, false), one);
    EXPECT_DOUBLE_EQ(solid_over_opening(state, 1, 2, true), 2 * one) << "a slot along y";
}

TEST(Outflow, TheSettledFractionLeavesTheEndsOut) {
    // Points of volume 0.6 per unit cube, over a floor at z = 2, up to z = 42.
    dem::State state;
    const double r = std::cbrt(0.6 * 3 / (4 * std::numbers::pi));
    for (int k = 0; k < 40; ++k)
        for (int i = 0; i < 25; ++i) {
            state.position.push_back({0.0 + i % 5, 0.0 + i / 5, 2.5 + k});
            state.radius.push_back(r);
        }
    EXPECT_NEAR(settled_fraction(state, 2, 1, 25), 0.6, 0.02);
    EXPECT_TRUE(std::isnan(settled_fraction(state, 40, 1, 25))) << "too low";
    EXPECT_TRUE(std::isnan(settled_fraction({}, 0, 1, 25)));
}

}  // namespace grainsweep::tests::observables_outflow_test
