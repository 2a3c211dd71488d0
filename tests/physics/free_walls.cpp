// Walls that the powder moves: pressed and driven ones. Closed forms, momentum and energy, checkpoints, phases; both
// engines.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/vector.hpp"
#include "solver/machine/shapes.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace grainsweep::tests::free_walls_test {

using dem::Vec3;
using namespace geometry;
using std::numbers::pi;

using Precision = dem::Method::Precision;
constexpr std::array both = {Precision::double_precision, Precision::mixed};

constexpr double diameter = 0.01, stiffness = 1000;

/// One sphere of 1 cm on the floor z = 0, by undamped springs, without gravity.
dem::Setup one_sphere() {
    dem::Setup setup;
    setup.domain = {{-0.05, -0.05, -0.05}, {0.05, 0.05, 0.1}, {}};
    setup.material.density = 100;
    setup.material.normal_law = dem::NormalLaw::linear;
    setup.material.stiffness = stiffness;
    setup.material.restitution = 1;
    setup.material.friction = 0;
    setup.gravity = {};
    setup.time_step = 2e-6;
    dem::Sphere sphere;
    sphere.radius = diameter / 2;
    sphere.position = {0, 0, diameter / 2};
    setup.spheres = {sphere};
    setup.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 1}});
    return setup;
}

Press press(double force, double mass, double fastest = 10) {
    return {.along = {0, 0, -1}, .force = force, .mass = mass, .fastest = fastest};
}

const Press& pressed(const dem::Engine& engine, std::size_t wall) {
    return std::get<Press>(engine.wall(wall).motions.back());
}

// Nothing in its way: v = F t/m, way = F t^2/(2 m), then its bound.
TEST(FreeWalls, APlateFallsByItsForce) {
    for (const auto precision : both) {
        dem::Setup setup = one_sphere();
        setup.walls.emplace_back(dem::Plane{{0, 0, 0.09}, {0, 0, -1}}, std::vector<Motion>{press(0.3, 0.2, 0.12)});
        const auto engine = dem::make_engine(setup, method(precision));
        engine->run(20000);  // 40 ms
        const double t = 20000 * setup.time_step;
        EXPECT_NEAR(pressed(*engine, 1).way, 1.5 * t * t / 2, 1e-12);
        EXPECT_NEAR(pressed(*engine, 1).speed, 1.5 * (t + (precision == Precision::mixed ? 1e-6 : 0)), 1e-12)
            << "in mixed precision half a step later";
        engine->run(80000);
        EXPECT_NEAR(pressed(*engine, 1).speed, 0.12, 1e-12);
        EXPECT_EQ(engine->fault(), "");
    }
}

// A plate of mass M, a light sphere of mass m between two springs k: the plate swings about F/(k/2) with the angular
// frequency sqrt((k/2)/(M + m/4)), and no energy is lost.
TEST(FreeWalls, APlateSwingsOnSpringsOfContacts) {
    constexpr double force = 0.05, mass = 0.2;
    for (const auto precision : both) {
        dem::Setup setup = one_sphere();
        setup.walls.emplace_back(dem::Plane{{0, 0, diameter}, {0, 0, -1}}, std::vector<Motion>{press(force, mass)});
        const auto engine = dem::make_engine(setup, method(precision));
        const double sphere = dem::sphere_mass(diameter / 2, 100);
        const double period = 2 * pi * std::sqrt((mass + sphere / 4) / (stiffness / 2));
        const double equilibrium = force / (stiffness / 2);
        const auto steps = static_cast<std::int64_t>(period / setup.time_step / 8);
        double highest = 0;
        for (int part = 1; part <= 16; ++part) {  // two periods
            engine->run(steps);
            const double t = engine->wall_time();
            const double way = equilibrium * (1 - std::cos(2 * pi * t / period));
            EXPECT_NEAR(pressed(*engine, 1).way, way, 2e-3 * equilibrium) << part;
            highest = std::max(highest, pressed(*engine, 1).way);
            const double speed = pressed(*engine, 1).speed;
            const auto state = tests::state_of(*engine);
            const double vz = state.velocity[0][2];
            double energy = 0.5 * mass * speed * speed + 0.5 * sphere * vz * vz - force * pressed(*engine, 1).way;
            std::vector<dem::ContactForce> contacts;
            engine->contacts(contacts);
            for (const auto& c : contacts) energy += 0.5 * stiffness * c.overlap * c.overlap;
            // Of the order of the work of the force; the mixed engine's speed is half a step ahead.
            EXPECT_NEAR(energy, 0, (precision == Precision::mixed ? 2e-3 : 2e-5) * 2 * force * equilibrium) << part;
        }
        EXPECT_NEAR(highest, 2 * equilibrium, 1e-3 * equilibrium);
        EXPECT_EQ(engine->fault(), "");
    }
}

// A flat blade on an axis y, driven against a sphere that a wall holds: at rest the force at the arm is the moment.
TEST(FreeWalls, ADrivenBladeRestsWhereItsMomentIsBalanced) {
    for (const auto precision : both) {
        dem::Setup setup = one_sphere();
        setup.material.restitution = 0.05;
        setup.material.friction = 0.5;
        setup.gravity = {0, 0, -9.81};
        setup.walls.emplace_back(dem::Plane{{-diameter / 2 - 1e-4, 0, 0}, {1, 0, 0}});
        const double x = diameter / 2 + 2e-4, y = 0.02;
        const std::vector<std::array<Vec3, 3>> blade = {{{{x, -y, -0.01}, {x, y, -0.01}, {x, y, 0.03}}},
                                                        {{{x, -y, -0.01}, {x, y, 0.03}, {x, -y, 0.03}}}};
        const Drive drive{.point = {x, 0, 0.03}, .axis = {0, 1, 0}, .moment = 2e-4, .inertia = 1e-6, .fastest = 20};
        setup.walls.emplace_back(machine::mesh_of(blade, 0, {}), std::vector<Motion>{drive});
        const auto engine = dem::make_engine(setup, method(precision));
        engine->run(300000);
        EXPECT_EQ(engine->fault(), "");
        const auto& now = std::get<Drive>(engine->wall(2).motions.back());
        EXPECT_GT(now.way, 1e-3);
        EXPECT_LT(std::abs(now.speed), 1e-3);
        const auto load = engine->wall_load(2, {x, 0, 0.03});
        EXPECT_NEAR(load.torque[1], -2e-4, 2e-6);
        EXPECT_GT(std::abs(load.force[0]), 2e-4 / 0.03);
    }
}

/// A bed of spheres under a heavy lid.
dem::Setup bed_under_lid() {
    dem::Setup setup = tests::bed_on_floor(6);
    setup.domain = {{0, 0, -0.01}, {0.02, 0.02, 0.06}, {true, true, false}};
    setup.walls.emplace_back(dem::Plane{{0, 0, 0.022}, {0, 0, -1}}, std::vector<Motion>{press(2.0, 0.05, 0.5)});
    return setup;
}

// In the end the floor carries the force of the lid and the weight of the powder.
TEST(FreeWalls, TheFloorCarriesTheLidAndThePowder) {
    for (const auto precision : both) {
        dem::Setup setup = bed_under_lid();
        std::get<Press>(setup.walls[1].motions[0]).mass = 0.005;
        const auto engine = dem::make_engine(setup, method(precision));
        engine->run(40000);
        EXPECT_EQ(engine->fault(), "");
        double weight = 0;
        for (const auto& sphere : setup.spheres) weight += 9.81 * dem::sphere_mass(sphere.radius, 2500);
        EXPECT_NEAR(engine->wall_load(1, {}).force[2], 2.0, 0.02);
        EXPECT_NEAR(engine->wall_load(0, {}).force[2], -(2.0 + weight), 0.02);
        EXPECT_LT(std::abs(pressed(*engine, 1).speed), 1e-4);
    }
}

std::vector<std::byte> saved(const dem::Engine& engine) {
    std::vector<std::byte> bytes;
    engine.save(bytes);
    return bytes;
}

TEST(FreeWalls, CheckpointsAndThreadsChangeNoBit) {
    const dem::Setup setup = bed_under_lid();
    for (const auto precision : both) {
        const auto whole = dem::make_engine(setup, method(precision));
        auto parts = dem::make_engine(setup, method(precision, 2));
        for (int k = 0; k < 12; ++k) {
            whole->run(517);
            parts->run(200), parts->run(317);
            const auto bytes = saved(*parts);
            EXPECT_EQ(bytes, saved(*whole)) << k;
            parts = dem::make_engine(setup, method(precision, 1 + k % 2));
            parts->restore(bytes);
        }
        EXPECT_EQ(pressed(*parts, 1).way, pressed(*whole, 1).way);
        EXPECT_GT(pressed(*whole, 1).way, 0.001);
    }
}

// Held before its start and after its end, where it stays; changing other walls moves it not.
TEST(FreeWalls, AreHeldOutsideOfTheirTimes) {
    for (const auto precision : both) {
        dem::Setup setup = bed_under_lid();
        auto& lid = std::get<Press>(setup.walls[1].motions[0]);
        lid.start = 0.01;
        lid.end = 0.02;
        setup.walls.emplace_back(dem::Plane{{0, 0, 0.055}, {0, 0, -1}});
        setup.walls[2].present = false;
        const auto engine = dem::make_engine(setup, method(precision));
        engine->run(1000);
        EXPECT_EQ(pressed(*engine, 1).way, 0);
        engine->run(500);
        const double way = pressed(*engine, 1).way, speed = pressed(*engine, 1).speed;
        EXPECT_GT(way, 1e-5);
        EXPECT_GT(speed, 1e-3);
        setup.walls[2].present = true;
        engine->change_walls(setup.walls);
        EXPECT_EQ(pressed(*engine, 1).way, way);
        EXPECT_NEAR(pressed(*engine, 1).speed, speed, 1e-3 * speed);
        engine->run(700);
        const double held = pressed(*engine, 1).way;
        EXPECT_GT(held, way);
        EXPECT_EQ(pressed(*engine, 1).speed, 0);
        engine->run(500);
        EXPECT_EQ(pressed(*engine, 1).way, held);
        EXPECT_EQ(engine->fault(), "");
    }
}

TEST(FreeWalls, ImpossibleOnesGetASentence) {
    const auto refusal = [](const Motion& motion) { return flaw(motion); };
    EXPECT_EQ(refusal(press(1, 0)), "the mass of a pressed wall must be above 0");
    EXPECT_EQ(refusal(press(1, 1, 0)), "the speed of a pressed wall must have a bound above 0");
    EXPECT_EQ(refusal(Press{.along = {0, 0, 2}, .force = 1, .mass = 1, .fastest = 1}),
              "the direction of a press must have unit length");
    EXPECT_EQ(refusal(Drive{.moment = 1, .inertia = 0, .fastest = 1}), "the inertia of a driven wall must be above 0");
    EXPECT_EQ(refusal(Drive{.moment = 1, .inertia = 1, .fastest = 0}),
              "the speed of a driven wall must have a bound above 0");
    EXPECT_EQ(refusal(press(1, 1)), "");
}

}  // namespace grainsweep::tests::free_walls_test
