// Free bodies: six degrees of freedom. Closed forms of the rigid body, impacts with spheres, checkpoints; both engines.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/solid.hpp"
#include "solver/machine/shapes.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grainsweep::tests::free_bodies_test {

using dem::Vec3;
using namespace geometry;

using Precision = dem::Method::Precision;
constexpr std::array both = {Precision::double_precision, Precision::mixed};

/// A closed box of these lengths about `centre`, triangles outwards.
std::vector<std::array<Vec3, 3>> box(const Vec3& centre, const Vec3& lengths) {
    const auto corner = [&](int x, int y, int z) {
        return Vec3{centre[0] + (x - 0.5) * lengths[0], centre[1] + (y - 0.5) * lengths[1],
                    centre[2] + (z - 0.5) * lengths[2]};
    };
    std::vector<std::array<Vec3, 3>> triangles;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const auto at = [&](int u, int v) {
                int c[3];
                c[axis] = side, c[(axis + 1) % 3] = u, c[(axis + 2) % 3] = v;
                return corner(c[0], c[1], c[2]);
            };
            const std::array<Vec3, 4> face = {at(0, 0), at(1, 0), at(1, 1), at(0, 1)};
            const int second = side == 1 ? 1 : 3, fourth = side == 1 ? 3 : 1;
            triangles.push_back({face[0], face[second], face[2]});
            triangles.push_back({face[0], face[2], face[fourth]});
        }
    return triangles;
}

Flight flight_of(const Mesh& mesh, double density) {
    const auto solid = solid_of(mesh.surface()).value();
    return {.centre = solid.centre,
            .mass = density * solid.volume,
            .axes = solid.axes,
            .inertia = density * solid.inertia,
            .fastest = 5,
            .fastest_turn = 500};
}

TEST(FreeBodies, AClosedMeshHasItsMassAndInertia) {
    const Vec3 a{0.03, 0.02, 0.05}, centre{0.1, -0.2, 0.3};
    const auto solid = solid_of(machine::mesh_of(box(centre, a), 0, {}).surface()).value();
    const double volume = a[0] * a[1] * a[2];
    EXPECT_NEAR(solid.volume, volume, 1e-12 * volume);
    EXPECT_NEAR(norm(solid.centre - centre), 0, 1e-14);
    for (std::size_t k = 0; k < 3; ++k) {
        const double b = a[(k + 1) % 3], c = a[(k + 2) % 3];
        EXPECT_NEAR(solid.inertia[k], volume / 12 * (b * b + c * c), 1e-11 * solid.inertia[k]);
        EXPECT_EQ(solid.axes[k][k], 1);
    }
    // Turned: the same moments about axes that are turned with it.
    const auto turned =
        solid_of(machine::mesh_of(box(centre, a), 0, {.axis = {0, 0, 1}, .through = centre, .angle = 0.3}).surface());
    std::array<double, 3> one = solid.inertia, two = turned->inertia;
    std::ranges::sort(one), std::ranges::sort(two);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(two[k], one[k], 1e-9 * one[k]);
    auto open = box(centre, a);
    open.pop_back();
    EXPECT_FALSE(solid_of(machine::mesh_of(open, 0, {}).surface()));
}

/// A box of 30 x 20 x 50 mm far from everything, one sphere far below it.
dem::Setup lonely_box(const Flight& start) {
    dem::Setup setup;
    setup.domain = {{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}};
    setup.material.density = 2500;
    setup.material.youngs_modulus = 5e6;
    setup.gravity = {};
    setup.time_step = 1e-5;
    dem::Sphere sphere;
    sphere.radius = 0.002;
    sphere.position = {0, 0, -0.4};
    setup.spheres = {sphere};
    setup.walls.emplace_back(machine::mesh_of(box({0, 0, 0}, {0.03, 0.02, 0.05}), 0, {}), std::vector<Motion>{start});
    return setup;
}

const Flight& flight(const dem::Engine& engine, std::size_t wall = 0) {
    return std::get<Flight>(engine.wall(wall).motions.back());
}

double turning_energy(const Flight& f) {
    return dot(f.angular_momentum, spin_of(f)) / 2;
}

// About its middle axis a body turns over (Dzhanibekov): the angular momentum stays, the energy to second order in the
// step, and the spin about that axis changes its sign.
TEST(FreeBodies, ABodyWithoutMomentsTurnsOver) {
    Flight start = flight_of(machine::mesh_of(box({0, 0, 0}, {0.03, 0.02, 0.05}), 0, {}), 1000);
    start.angular_momentum = {100 * start.inertia[0], 0.5 * start.inertia[1], 0};  // middle: x
    for (const auto precision : both) {
        double drift[2] = {};
        for (const int fine : {0, 1}) {
            auto setup = lonely_box(start);
            setup.time_step = fine == 1 ? 5e-6 : 1e-5;
            const auto engine = dem::make_engine(setup, method(precision));
            const double energy = turning_energy(flight(*engine));
            double least = 100;
            for (int part = 0; part < 100; ++part) {
                engine->run(fine == 1 ? 400 : 200);
                const Flight& now = flight(*engine);
                const Pose pose = pose_at(engine->wall(0).motions, 0);
                least = std::min(least, dot(pose.turn_back(spin_of(now)), {1, 0, 0}));
                drift[fine] = std::max(drift[fine], std::abs(turning_energy(now) / energy - 1));
                for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(now.angular_momentum[k], start.angular_momentum[k]);
            }
            EXPECT_LT(least, -95) << "it turns over";
            EXPECT_EQ(engine->fault(), "");
        }
        EXPECT_LT(drift[0], 1e-6);
        EXPECT_NEAR(drift[0] / drift[1], 4, 0.5) << "of second order";
    }
}

TEST(FreeBodies, ABodyFallsAndIsHeldOutsideOfItsTime) {
    Flight start = flight_of(machine::mesh_of(box({0, 0, 0}, {0.03, 0.02, 0.05}), 0, {}), 1000);
    start.force = {0, 0, -9.81 * start.mass};
    start.start = 0.01, start.end = 0.02;
    for (const auto precision : both) {
        const auto engine = dem::make_engine(lonely_box(start), method(precision));
        engine->run(1000);
        EXPECT_EQ(flight(*engine).way, (Vec3{}));
        engine->run(1000);
        EXPECT_NEAR(flight(*engine).way[2], -9.81 * 0.01 * 0.01 / 2, 2e-3 * 9.81 * 0.01 * 0.01 / 2);
        engine->run(10);
        const Vec3 way = flight(*engine).way;
        engine->run(1000);
        EXPECT_EQ(flight(*engine).way, way);
        EXPECT_EQ(flight(*engine).velocity, (Vec3{}));
    }
}

// A sphere hits a box off its centre, with friction: momentum and angular momentum are those before.
TEST(FreeBodies, AnImpactKeepsMomentumAndAngularMomentum) {
    Flight start = flight_of(machine::mesh_of(box({0, 0, 0}, {0.03, 0.02, 0.05}), 0, {}), 200);
    for (const auto precision : both)
        for (const double friction : {0.0, 0.4}) {
            auto setup = lonely_box(start);
            setup.material.friction = friction;
            setup.material.restitution = friction > 0 ? 0.5 : 1;
            setup.time_step = 2e-6;
            auto& sphere = setup.spheres.front();
            sphere.radius = 0.005;
            sphere.position = {0.021, 0.004, 0.015};
            sphere.velocity = {-0.4, 0.05, 0.1};
            const double mass = dem::sphere_mass(sphere.radius, 2500);
            const auto engine = dem::make_engine(setup, method(precision));
            const auto totals = [&](const dem::Engine& now) {
                const auto state = tests::state_of(now);
                const Flight& body = flight(now);
                const Vec3 centre = body.centre + body.way;
                std::array<Vec3, 2> sum{};
                sum[0] = mass * state.velocity[0] + body.mass * body.velocity;
                sum[1] = mass * cross(state.position[0], state.velocity[0]) +
                         0.4 * mass * sphere.radius * sphere.radius * state.angular_velocity[0] +
                         body.mass * cross(centre, body.velocity) + body.angular_momentum;
                return sum;
            };
            const auto energy_of = [&](const dem::Engine& now) {
                const auto state = tests::state_of(now);
                const Flight& body = flight(now);
                return mass / 2 * dot(state.velocity[0], state.velocity[0]) +
                       0.2 * mass * sphere.radius * sphere.radius *
                           dot(state.angular_velocity[0], state.angular_velocity[0]) +
                       body.mass / 2 * dot(body.velocity, body.velocity) + turning_energy(body);
            };
            const auto before = totals(*engine);
            const double energy = energy_of(*engine);
            engine->run(15000);
            ASSERT_EQ(engine->fault(), "");
            EXPECT_GT(norm(flight(*engine).velocity), 0.01);
            EXPECT_GT(norm(spin_of(flight(*engine))), 1);
            const auto after = totals(*engine);
            const double rounding = precision == Precision::mixed ? 1e-5 : 1e-10;
            EXPECT_NEAR(norm(after[0] - before[0]), 0, rounding * norm(before[0]));
            EXPECT_NEAR(norm(after[1] - before[1]), 0, rounding * norm(before[1]));
            if (friction == 0)
                EXPECT_NEAR(energy_of(*engine), energy, 1e-3 * energy);
            else
                EXPECT_LT(energy_of(*engine), energy);
        }
}

/// A box that falls onto a bed of spheres.
dem::Setup box_on_bed() {
    dem::Setup setup = tests::bed_on_floor(5);
    setup.domain = {{0, 0, -0.01}, {0.02, 0.02, 0.08}, {}};
    for (std::size_t k = 0; k < 2; ++k) {
        Vec3 low{}, high{}, inwards{};
        high[k] = 0.02, inwards[k] = 1;
        setup.walls.emplace_back(dem::Plane{low, inwards});
        inwards[k] = -1;
        setup.walls.emplace_back(dem::Plane{high, inwards});
    }
    const Mesh mesh = machine::mesh_of(box({0.011, 0.01, 0.03}, {0.008, 0.006, 0.01}), 0,
                                       {.axis = {0, 1, 0}, .through = {0.011, 0.01, 0.03}, .angle = 0.5});
    Flight start = flight_of(mesh, 3000);
    start.force = {0, 0, -9.81 * start.mass};
    setup.walls.emplace_back(mesh, std::vector<Motion>{start});
    return setup;
}

// It comes to rest on the powder, which carries its weight.
TEST(FreeBodies, ABoxRestsOnPowder) {
    for (const auto precision : both) {
        const auto engine = dem::make_engine(box_on_bed(), method(precision));
        engine->run(60000);
        ASSERT_EQ(engine->fault(), "");
        const Flight& body = flight(*engine, 5);
        EXPECT_LT(norm(body.velocity), 2e-3);
        EXPECT_LT(body.way[2], -0.005);
        const auto load = engine->wall_load(5, body.centre + body.way);
        const double weight = 9.81 * body.mass;
        EXPECT_NEAR(load.force[2], weight, 0.02 * weight);
        EXPECT_NEAR(norm(load.torque), 0, 0.02 * weight * 0.005);
    }
}

TEST(FreeBodies, ThreadsSlicesAndCheckpointsChangeNoBit) {
    for (const auto precision : both) {
        const auto engine = dem::make_engine(box_on_bed(), method(precision));
        const auto other = dem::make_engine(box_on_bed(), method(precision, precision == Precision::mixed ? 2 : 1));
        engine->run(6000);
        for (int part = 0; part < 4; ++part) other->run(1500);
        const auto same = [](const dem::Engine& a, const dem::Engine& b) {
            const Flight &one = flight(a, 5), &two = flight(b, 5);
            EXPECT_EQ(one.way, two.way);
            EXPECT_EQ(one.turned, two.turned);
            EXPECT_EQ(one.angular_momentum, two.angular_momentum);
            EXPECT_EQ(tests::state_of(a).position, tests::state_of(b).position);
        };
        same(*engine, *other);
        EXPECT_GT(norm(spin_of(flight(*engine, 5))), 0.1) << "in the midst of it";
        std::vector<std::byte> bytes;
        engine->save(bytes);
        const auto resumed = dem::make_engine(box_on_bed(), method(precision));
        resumed->restore(bytes);
        engine->run(1000), resumed->run(1000);
        same(*engine, *resumed);
    }
}

// A wheel on a plate of powder without friction: two presses and a drive add up to a plane motion, and the moment of
// the load is about the axis where it is by then.
TEST(FreeBodies, PressesAndADriveAddUpToAPlaneMotion) {
    for (const auto precision : both) {
        auto setup = lonely_box({});
        setup.material.friction = 0;
        setup.material.restitution = 1;
        setup.time_step = 2e-6;
        const Mesh mesh = machine::mesh_of(box({0, 0, 0}, {0.03, 0.02, 0.05}), 0, {});
        const Flight whole = flight_of(mesh, 200);
        setup.walls.front() =
            dem::Wall(mesh, {Press{.along = {1, 0, 0}, .mass = whole.mass, .fastest = 5, .number = 0, .speed = 0.2},
                             Press{.along = {0, 0, 1}, .mass = whole.mass, .fastest = 5, .number = 1},
                             Drive{.axis = {0, 1, 0}, .inertia = whole.inertia[1], .fastest = 500, .number = 2}});
        Flight same = whole;
        same.velocity = {0.2, 0, 0};
        auto free = setup;
        free.walls.front() = dem::Wall(mesh, {same});
        for (auto* each : {&setup, &free}) {
            auto& sphere = each->spheres.front();
            sphere.radius = 0.005;
            sphere.position = {0.041, 0, 0.015};
            sphere.velocity = {-0.4, 0, 0};
        }
        const auto plane = dem::make_engine(setup, method(precision));
        const auto body = dem::make_engine(free, method(precision));
        plane->run(25000), body->run(25000);
        ASSERT_EQ(plane->fault() + body->fault(), "");
        const auto& motions = plane->wall(0).motions;
        const double spin = std::get<Drive>(motions[2]).speed;
        EXPECT_GT(std::abs(spin), 1);
        EXPECT_NEAR(spin, spin_of(flight(*body))[1], 1e-3 * std::abs(spin));
        EXPECT_NEAR(std::get<Press>(motions[0]).speed, flight(*body).velocity[0], 1e-4);
    }
}

TEST(FreeBodies, NothingTurnsABodyAfterADrive) {
    auto setup = lonely_box({});
    const Mesh mesh = machine::mesh_of(box({0, 0, 0}, {0.03, 0.02, 0.05}), 0, {});
    setup.walls.front() = dem::Wall(mesh, {Drive{.fastest = 1}, Rotation{.speed = 1}});
    EXPECT_THROW((void)dem::make_engine(setup, method(Precision::mixed)), std::invalid_argument);
    setup.walls.front() = dem::Wall(mesh, {Rotation{.speed = 1}, Drive{.fastest = 1}});
    EXPECT_EQ(dem::make_engine(setup, method(Precision::mixed))->fault(), "");
}

}  // namespace grainsweep::tests::free_bodies_test
