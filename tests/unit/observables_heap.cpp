// The shape of a heap, on states whose angles are known.
#include "solver/observables/heap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::observables_heap_test {

using namespace observables;

constexpr double degree = std::numbers::pi / 180;

void add(dem::State& state, const dem::Vec3& x, double radius, bool mobile = true) {
    state.id.push_back(static_cast<std::int32_t>(state.id.size()));
    state.position.push_back(x);
    state.velocity.push_back({});
    state.radius.push_back(radius);
    state.mobile.push_back(mobile ? 1 : 0);
}

/// A cone of a radius and angle filled evenly with points on a fine lattice, its axis off the origin.
dem::State cone(double radius, double angle, double pitch) {
    dem::State state;
    const double height = radius * std::tan(angle * degree);
    const auto n = static_cast<int>(radius / pitch) + 1;
    for (int i = -n; i < n; ++i)
        for (int j = -n; j < n; ++j)
            for (int k = 0; (k + 0.5) * pitch < height; ++k) {
                const double x = (i + 0.5) * pitch, y = (j + 0.5) * pitch, z = (k + 0.5) * pitch;
                if (z < height * (1 - std::hypot(x, y) / radius)) add(state, {x + 3, y - 7, z}, 1e-9);
            }
    return state;
}

TEST(HeapShape, OfAnEvenConeIsItsAngle) {
    for (const double angle : {15.0, 25.0, 40.0}) {
        const auto state = cone(20, angle, 0.25);
        const auto shape = heap_shape(state, 1, 30);
        // The foot lower than D/2 is left out, which steepens a flat cone by half a degree.
        EXPECT_NEAR(shape.angle_moment, angle, 0.5) << angle;
        EXPECT_NEAR(shape.angle, angle, 0.6) << angle;
        EXPECT_LT(shape.residual, 0.1);
        // The inner ring is half a width from the axis.
        EXPECT_NEAR(shape.height, (20 - 0.54) * std::tan(angle * degree), 0.35);
        // Nine tenths of a cone's volume lie within rho: 3 u^2 - 2 u^3 = 0.9, u = 0.804.
        EXPECT_NEAR(shape.run_out, 0.804 * 20, 0.15);
        EXPECT_EQ(shape.outline.size(), 30U);
        EXPECT_EQ(shape.outline.back(), 0);
    }
}

// Two grains opposite each other: each ring is their heights over its columns, counted one by one.
TEST(HeapShape, RingsHaveTheirColumns) {
    for (int ring = 0; ring < 60; ++ring) {
        double columns = 0;
        for (int i = -ring - 1; i <= ring; ++i)
            for (int j = -ring - 1; j <= ring; ++j)
                columns += static_cast<int>(std::hypot(i + 0.5, j + 0.5)) == ring ? 1 : 0;
        dem::State state;
        add(state, {ring + 0.6, 0.2, 0}, 0.5), add(state, {-ring - 0.6, -0.2, 0}, 0.5);
        const auto outline = heap_shape(state, 1, 61).outline;
        EXPECT_EQ(outline[static_cast<std::size_t>(ring)], 1 / columns) << ring;
    }
    dem::State wide;  // of 30,000 rings, in no time
    add(wide, {3e4 - 0.5, 0.2, 0}, 0.5), add(wide, {0.5 - 3e4, -0.2, 0}, 0.5);
    EXPECT_NEAR(heap_shape(wide, 1, 3e4).outline.back(), 1 / (std::numbers::pi * (6e4 - 1)), 5e-3 / (6e4 * 3));
}

TEST(HeapShape, CountsOnlyWhatCanMove) {
    auto state = cone(10, 30, 0.5);
    const auto before = heap_shape(state, 1, 20);
    for (int k = 0; k < 50; ++k) add(state, {50.0 + k, 0, 99}, 0.5, false);
    const auto after = heap_shape(state, 1, 20);
    EXPECT_EQ(before.angle, after.angle);
    EXPECT_EQ(before.angle_moment, after.angle_moment);
    EXPECT_EQ(before.run_out, after.run_out);
    state.velocity.back() = {7, 0, 0};
    EXPECT_EQ(rms_speed(state), 0);
    state.velocity.front() = {3, 0, 4};
    EXPECT_NEAR(rms_speed(state), 5 / std::sqrt(static_cast<double>(state.id.size() - 50)), 1e-12);
}

TEST(HeapShape, OfTooLittleIsUnknown) {
    EXPECT_TRUE(std::isnan(heap_shape({}, 1, 10).angle));
    dem::State one;
    add(one, {0, 0, 0.5}, 0.5);
    const auto shape = heap_shape(one, 1, 10);
    EXPECT_TRUE(std::isnan(shape.angle));
    EXPECT_EQ(shape.run_out, 0);
    EXPECT_EQ(rms_speed({}), 0);
}

}  // namespace grainsweep::tests::observables_heap_test
