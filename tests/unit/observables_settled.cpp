// The solid fraction of settled powder, on a state that is counted by hand.
#include "solver/observables/settled.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::observables_settled_test {

using namespace observables;

TEST(Settled, TheFractionLeavesTheEndsOut) {
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

}  // namespace grainsweep::tests::observables_settled_test
