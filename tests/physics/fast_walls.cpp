// Walls of every shape and motion in the mixed-precision engine: the reference of single spheres
// (tests/reference/walls) and the law written plainly, on every instruction path; loads, energy and what is booked.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/against_plain.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/moving_walls.hpp"
#include "tests/support/spheres.hpp"
#include "tests/support/surfaces.hpp"

namespace grainsweep::tests::fast_walls_test {

using namespace geometry;

constexpr double radius = tests::sphere_at_walls;

struct Booked {
    Vec3 momentum{}, angular_momentum{};
    double work = 0;
    Vec3 momentum_of_sphere{}, angular_momentum_of_sphere{};
    double energy = 0;
};

/// Runs an impact step by step and sums what the wall's loads give.
Booked booked(const dem::Setup& setup, dem::Method::Path path, std::int64_t steps) {
    const auto engine = dem::fast::make_mixed_engine(setup, path);
    const double mass = dem::sphere_mass(radius, setup.material.density), inertia = 0.4 * mass * radius * radius;
    Booked b;
    const auto motion = [&](double sign) {
        const auto state = tests::state_of(*engine);
        const Vec3 &x = state.position[0], &v = state.velocity[0], &w = state.angular_velocity[0];
        b.momentum_of_sphere += (sign * mass) * v;
        b.angular_momentum_of_sphere += (sign * mass) * cross(x, v) + (sign * inertia) * w;
        b.energy += sign * (0.5 * mass * dot(v, v) + 0.5 * inertia * dot(w, w));
    };
    motion(-1);
    double most = 0;
    for (std::int64_t k = 0; k < steps; ++k) {
        engine->run(1);
        const auto load = engine->wall_load(0, {});
        b.momentum += (-setup.time_step) * load.force;
        b.angular_momentum += (-setup.time_step) * load.torque;
        b.work = load.work;
        most = std::max(most, norm(load.force));
    }
    EXPECT_EQ(norm(engine->wall_load(0, {}).force), 0) << "still in contact";
    EXPECT_GT(most, 0) << "never in contact";
    EXPECT_EQ(engine->fault(), "");
    motion(1);
    return b;
}

constexpr std::int64_t one_impact = 1200;  // steps of 1 us

/// A box of spheres thrown about, its centre and half its height.
struct Crowd {
    dem::Setup setup;
    Vec3 centre{};
    double half = 0;

    explicit Crowd(double spread) : setup(tests::boxed_lattice(5, 0.5, spread, 24)) {
        for (const auto& s : setup.spheres) centre += (1.0 / static_cast<double>(setup.spheres.size())) * s.position;
        for (const auto& s : setup.spheres) half = std::max(half, std::abs(s.position[2] - centre[2]) + s.radius);
    }
    [[nodiscard]] dem::Setup among(const dem::Wall& wall) const {
        dem::Setup with = setup;
        with.walls.push_back(wall);
        return with;
    }
};

// Single precision rounds each force to 1e-7: a collision sums some hundred of them.
TEST(FastWalls, LoadsAreTheReaction) {
    for (const auto path : tests::paths())
        for (const auto& m : all_moving_walls())
            for (const double rolling : {0.0, 0.1}) {
                SCOPED_TRACE(m.name);
                auto setup = one_sphere(m.position, m.velocity, {m.wall});
                setup.material.rolling_friction = rolling;
                setup.spheres[0].angular_velocity = {40, -60, 30};
                const auto b = booked(setup, path, one_impact);
                const double scale = dem::sphere_mass(radius, 2500) * norm(m.velocity);
                EXPECT_LT(norm(b.momentum - b.momentum_of_sphere), 3e-6 * scale);
                EXPECT_LT(norm(b.angular_momentum - b.angular_momentum_of_sphere), 3e-6 * scale * 0.01);
            }
}

// Without friction and damping an impact gives back what it took, up to the work of the wall: the error is that of the
// integrator, as in double precision.
TEST(FastWalls, EnergyIsConservedUpToTheWorkOfTheWall) {
    for (const auto path : tests::paths())
        for (const auto& m : all_moving_walls()) {
            SCOPED_TRACE(m.name);
            auto setup = one_sphere(m.position, m.velocity, {m.wall});
            setup.material.friction = 0;
            setup.material.restitution = 1;
            setup.time_step = 2.5e-7;
            const auto b = booked(setup, path, 4 * one_impact);
            const double scale = 0.5 * dem::sphere_mass(radius, 2500) * dot(m.velocity, m.velocity);
            EXPECT_NEAR(b.energy, b.work, 4e-4 * scale);
        }
}

// An impact on each shape in each motion, as the double engine computes it.
TEST(FastWalls, EqualTheDoubleEngine) {
    for (const auto path : tests::paths())
        for (const auto& m : all_moving_walls()) {
            SCOPED_TRACE(m.name);
            auto setup = one_sphere(m.position, m.velocity, {m.wall});
            setup.walls[0].surface = {.friction = 0.5, .rolling_friction = 0.2, .restitution = 0.8};
            // No touch begins with a step: in which of two steps it begins would be a matter of rounding.
            setup.spheres[0].position = setup.spheres[0].position + Vec3{3e-8, 2e-8, 1e-8};
            const auto mixed = dem::fast::make_mixed_engine(setup, path);
            const auto reference = dem::make_engine(setup, {});
            mixed->run(one_impact), reference->run(one_impact);
            const auto a = tests::state_of(*mixed), b = tests::state_of(*reference);
            const double fastest = std::max(norm(m.velocity), norm(b.velocity[0]));
            EXPECT_LT(norm(a.position[0] - b.position[0]), 1e-6 * 2 * radius);
            EXPECT_LT(norm(a.velocity[0] - b.velocity[0]), 3e-6 * fastest);
            EXPECT_LT(radius * norm(a.angular_velocity[0] - b.angular_velocity[0]), 3e-6 * fastest);
            const double work = std::abs(reference->wall_load(0, {}).work);
            EXPECT_NEAR(mixed->wall_load(0, {}).work, reference->wall_load(0, {}).work, 1e-5 * work + 1e-15);
        }
}

// Many spheres among turning, sliding and shaking walls: ten times what a disturbance of 1e-7 d grows to.
TEST(FastWalls, CrowdsAmongMovingWallsEqualThePlainLaw) {
    for (const double spread : {0.0, 0.2}) {
        const Crowd crowd(spread);
        const Vec3 &c = crowd.centre, top = c + Vec3{0, 0, crowd.half};
        const auto compare = [&](const std::string& name, const dem::Wall& wall) {
            tests::compare_with_plain({name, crowd.among(wall), 500});
        };
        const dem::Cylinder drum{.point = c, .axis = {0, 1, 0}, .radius = 1.42 * crowd.half};
        const dem::Cylinder roller{.point = top + Vec3{0, 0, 1.05e-3},
                                   .axis = {0, 1, 0},
                                   .radius = 1e-3,
                                   .side = dem::Side::outside,
                                   .length = 3e-3};
        const dem::Cone spike{.base = top + Vec3{0, 0, 2.1e-3},
                              .axis = {0, 0, -1},
                              .base_radius = 1e-3,
                              .length = 2e-3,
                              .side = dem::Side::outside};
        const dem::Bar paddle{top[0] + 0.5e-3, 1e-3, top[2] + 0.05e-3, top[2] + 3e-3, 0.2e-3};
        const dem::Translation down{.velocity = {0.1, 0, -0.6}};
        const dem::Rotation stirs{.point = c, .axis = {0, 0, 1}, .speed = 400};
        compare("drum", {drum, {dem::Rotation{.point = c, .axis = {0, 1, 0}, .speed = 150}}, {.friction = 0.6}});
        compare("roller", {roller, {dem::Rotation{.point = roller.point, .axis = {0, 1, 0}, .speed = 900}, down}, {}});
        compare("shaken roller",
                {roller, {dem::Vibration{.amplitude = {2e-4, 0, -4e-4}, .frequency = 300}, stirs}, {}});
        compare("spike", {spike, {stirs, down}, {.friction = 0, .restitution = 0.9}});
        compare("paddle", {paddle, {stirs, down}, {}});
    }
}

// Walls at rest are summed up in the last step of a run only: step by step, each of them is such a step.
TEST(FastWalls, AtRestHaveTheLoadsOfARunStepByStep) {
    for (const double spread : {0.0, 0.2}) {
        const Crowd crowd(spread);
        const Vec3 &c = crowd.centre, top = c + Vec3{0, 0, crowd.half};
        tests::Soup block = tests::box(1e-3, 2e-3);
        for (auto& triangle : block)
            for (Vec3& x : triangle) x += top + Vec3{0.3e-3, 0.2e-3, 2.1e-3};
        const dem::Bar paddle{top[0] + 0.5e-3, 1e-3, top[2] + 0.05e-3, top[2] + 3e-3, 0.2e-3};
        auto setup = crowd.among({paddle, {dem::Translation{.velocity = {0.1, 0, -0.6}}}, {}});
        setup.walls.push_back({dem::Mesh(tests::surface_of(block)), {}, {.friction = 0.4}});
        setup.material.rolling_friction = spread > 0 ? 0.1 : 0;
        for (const auto path : tests::paths()) {
            const auto at_once = dem::fast::make_mixed_engine(setup, path);
            const auto by_steps = dem::fast::make_mixed_engine(setup, path);
            std::vector<int> loaded(setup.walls.size());
            for (int k = 0; k < 100; ++k) {
                at_once->run(5);
                for (int s = 0; s < 5; ++s) by_steps->run(1);
                for (std::size_t w = 0; w < setup.walls.size(); ++w) {
                    const auto a = at_once->wall_load(w, c), b = by_steps->wall_load(w, c);
                    EXPECT_EQ(a.force, b.force);
                    EXPECT_EQ(a.torque, b.torque);
                    EXPECT_EQ(a.work, b.work);
                    if (norm(a.force) > 0 && norm(a.torque) > 0) ++loaded[w];
                }
            }
            EXPECT_GT(loaded[0] + loaded[1] + loaded[2] + loaded[3] + loaded[4], 0) << "planes";
            EXPECT_GT(loaded[6], 0) << "triangles";
            std::vector<std::byte> a, b;
            at_once->save(a), by_steps->save(b);
            EXPECT_TRUE(a == b);
        }
    }
}

// The same among triangles: a stirred block, and a drum of facets that turns, against the double engine, whose start is
// moved by 1e-7 diameters to see what that grows to.
TEST(FastWalls, CrowdsAmongTrianglesEqualTheDoubleEngine) {
    for (const double spread : {0.0, 0.2}) {
        const Crowd crowd(spread);
        const Vec3 &c = crowd.centre, top = c + Vec3{0, 0, crowd.half};
        tests::Soup block = tests::box(1e-3, 2e-3), drum = tests::drum(24, 1.37 * crowd.half, 2 * crowd.half);
        for (auto& triangle : block)
            for (Vec3& x : triangle) x += top + Vec3{0.3e-3, 0.2e-3, 2.1e-3};
        for (auto& triangle : drum)
            for (Vec3& x : triangle) x += c;
        const dem::Rotation stirs{.point = c, .axis = {0, 0, 1}, .speed = 400};
        const dem::Translation down{.velocity = {0.1, 0, -0.6}};
        const dem::Mesh stirrer(tests::surface_of(block)), facets(tests::surface_of(drum));
        const std::vector<dem::Wall> walls = {
            {stirrer, {stirs, down}, {.friction = 0.4}},
            {facets, {dem::Rotation{.point = c, .axis = {1, 0, 0}, .speed = 150}}, {.restitution = 0.8}}};
        for (const dem::Wall& wall : walls) {
            SCOPED_TRACE(spread);
            auto setup = crowd.among(wall);
            setup.material.rolling_friction = spread > 0 ? 0.1 : 0;
            auto moved = setup;
            for (std::size_t i = 0; i < moved.spheres.size(); ++i)
                for (std::size_t a = 0; a < 3; ++a) moved.spheres[i].position[a] += (i + a) % 2 == 0 ? 1e-10 : -1e-10;
            const auto reference = dem::make_engine(setup, {}), other = dem::make_engine(moved, {});
            reference->run(500), other->run(500);
            const auto expected = tests::state_of(*reference), disturbed = tests::state_of(*other);
            const double grown = tests::velocity_difference(expected, disturbed);
            EXPECT_LT(grown, 1e-3);
            const double work = reference->wall_load(5, {}).work;
            EXPECT_NE(work, 0);
            for (const auto path : tests::paths()) {
                const auto engine = dem::fast::make_mixed_engine(setup, path);
                engine->run(500);
                EXPECT_EQ(engine->fault(), "");
                EXPECT_LT(tests::velocity_difference(tests::state_of(*engine), expected), 10 * grown);
                std::vector<dem::ContactForce> a, b;
                engine->contacts(a), reference->contacts(b);
                EXPECT_EQ(a.size(), b.size());
                EXPECT_NEAR(engine->wall_load(5, {}).work, work, 1e-4 * std::abs(work));
            }
        }
    }
}

// A rectangle from one periodic face to the other: at the seam a sphere leaves one triangle for the other. It slides
// over many seams on the floor, without friction, as on a floor without end.
TEST(FastWalls, ARectangleOfOnePeriodHasNoSeam) {
    const double length = 20 * radius, width = 16 * radius;
    const Vec3 a{0, 0, 0}, b{width, 0, 0}, c{width, length, 0}, d{0, length, 0};
    const tests::Soup floor = {{{a, b, c}}, {{a, c, d}}};
    auto setup = one_sphere({0.3 * width, 0.9 * length, 0.999 * radius}, {0, 0.4, 0}, {});
    setup.domain = {{0, 0, -5e-3}, {width, length, 2e-2}, {true, true, false}};
    setup.gravity = {0, 0, -9.81};
    setup.material.friction = 0;
    setup.walls = {dem::Wall{dem::Mesh(tests::surface_of(floor))}};
    for (const auto path : tests::paths()) {
        const auto engine = dem::fast::make_mixed_engine(setup, path);
        for (int part = 0; part < 60; ++part) {  // 12 mm
            engine->run(500);
            EXPECT_EQ(engine->fault(), "");
            EXPECT_NEAR(tests::state_of(*engine).position[0][2], radius, 2e-3 * radius) << part;
        }
    }
}

}  // namespace grainsweep::tests::fast_walls_test
