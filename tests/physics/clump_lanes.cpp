// Clumps of the mixed engine, which are stepped in lanes, against the double engine, which steps one after the other.
#include "solver/dem/engine.hpp"
#include "tests/support/clump_cases.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace grainsweep::tests::clump_lanes_test {

using namespace geometry;

constexpr double density = clump_density;
constexpr dem::Method mixed{.precision = dem::Method::Precision::mixed};

dem::State state_of(const dem::Engine& engine) {
    dem::State state;
    engine.state(state);
    return state;
}

/// Free clumps of three shapes, more of each than lanes of a vector hold, or fewer.
dem::Setup free_crowd(std::size_t count) {
    dem::Setup setup = clump_room();
    setup.domain = {{0, 0, 0}, {0.1, 0.1, 0.1}, {true, true, true}};
    setup.gravity = {0.3, -0.2, -0.1};
    setup.time_step = 2e-5;
    setup.shapes = {clump_shape("dumbbell_1_5", density), clump_shape("tetra_1_5", density, dem::DampingMass::body),
                    clump_shape("asym3", density)};
    for (std::size_t n = 0; n < count; ++n) {
        const double u = std::fmod(0.618 * static_cast<double>(n), 1), v = std::fmod(0.755 * static_cast<double>(n), 1),
                     w = std::fmod(0.57 * static_cast<double>(n), 1);
        const auto at = [](std::size_t k) { return 0.0125 + 0.025 * static_cast<double>(k); };
        constexpr std::array<std::size_t, 7> shapes = {0, 0, 0, 0, 2, 2, 1};
        const std::size_t shape = shapes[n % shapes.size()];
        add_body(setup, {.shape = shape,
                         .scale = shape == 0 ? 0.95 : 0.9 + 0.1 * u,  // dumbbells are alike
                         .position = {at(n % 4), at(n / 4 % 4), at(n / 16)},
                         .orientation = orientation_at(u, v, w),
                         .velocity = {0.05 * (u - 0.5), 0.05 * (v - 0.5), 0.05 * (w - 0.5)},
                         .angular_velocity = {200 * (v - 0.5), 200 * (w - 0.5), 200 * (u - 0.5)}});
    }
    return setup;
}

// As many steps of as many bodies, in full and in partly filled vectors.
TEST(ClumpLanes, StepAsOneByOne) {
    for (const std::size_t count : {1U, 5U, 61U}) {
        const dem::Setup setup = free_crowd(count);
        const auto one_by_one = dem::make_engine(setup, {}), in_lanes = dem::make_engine(setup, mixed);
        for (auto* engine : {one_by_one.get(), in_lanes.get()}) {
            engine->run(1000);
            EXPECT_EQ(engine->fault(), "");
        }
        const dem::State a = state_of(*one_by_one), b = state_of(*in_lanes);
        ASSERT_EQ(a.bodies.size(), count);
        for (std::size_t k = 0; k < count; ++k) {
            const dem::BodyState &x = a.bodies[k], &y = b.bodies[k];
            EXPECT_LT(norm(x.velocity - y.velocity), 1e-12 * norm(x.velocity)) << k;
            EXPECT_LT(norm(x.position - y.position), 1e-13) << k;
            EXPECT_LT(norm(x.angular_velocity - y.angular_velocity), 1e-10 * norm(x.angular_velocity)) << k;
            EXPECT_LT(norm(x.angular_momentum - y.angular_momentum), 1e-12 * norm(x.angular_momentum)) << k;
            for (std::size_t q = 0; q < 4; ++q) EXPECT_NEAR(x.orientation[q], y.orientation[q], 1e-11) << k;
        }
        for (std::size_t i = 0; i < a.id.size(); ++i) {
            EXPECT_LT(norm(a.position[i] - b.position[i]), 1e-11) << i;
            EXPECT_LT(norm(a.velocity[i] - b.velocity[i]), 1e-10) << i;
        }
    }
}

// An oblique impact of two bodies without symmetry, and of a body on a sphere and on a wall.
TEST(ClumpLanes, DampImpactsAlike) {
    dem::Setup setup = clump_room();
    setup.shapes = {clump_shape("asym3", density)};
    setup.material.restitution = 0.3;
    setup.material.friction = 0.3;
    setup.walls.emplace_back(Plane{{0, 0, -0.012}, {0, 0, 1}});
    add_body(setup, {.orientation = orientation_at(0.3, 0.1, 0.7), .velocity = {0, 0, -0.4}});
    add_body(setup, {.position = {0.0085, 0.001, 0.002},
                     .orientation = orientation_at(0.8, 0.4, 0.2),
                     .velocity = {-0.6, 0, -0.4},
                     .angular_velocity = {20, 0, 40}});
    setup.spheres.push_back({.position = {-0.008, 0.001, 0}, .velocity = {0.3, 0, -0.4}, .radius = 0.002});
    const auto in_double = dem::make_engine(setup, {}), in_lanes = dem::make_engine(setup, mixed);
    in_double->run(30000), in_lanes->run(30000);
    EXPECT_GT(in_double->peak_overlap(), 0);
    EXPECT_GT(in_double->peak_wall_overlap(), 0);
    for (const std::size_t k : {0U, 1U}) {
        const dem::BodyState x = state_of(*in_double).bodies[k], y = state_of(*in_lanes).bodies[k];
        EXPECT_LT(norm(x.velocity - y.velocity), 1e-4 * 0.6) << k;
        EXPECT_LT(norm(x.angular_velocity - y.angular_velocity), 1e-4 * 100) << k;
    }
}

}  // namespace grainsweep::tests::clump_lanes_test
