// Walls in motion: closed forms of rigid spheres, the same trajectory in a moving frame, momentum, angular momentum and
// energy that walls give.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/walls/moving_wall.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/moving_walls.hpp"
#include "tests/support/spheres.hpp"
#include "tests/support/surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace grainsweep::tests::wall_motions_test {

using dem::Vec3;
using namespace geometry;
using std::numbers::pi;

constexpr double radius = tests::sphere_at_walls;
constexpr double gravity = 9.81;

/// Overlap that carries the weight on a plane.
double resting_overlap(const dem::Setup& s) {
    const double mass = dem::sphere_mass(radius, s.material.density);
    return std::pow(mass * gravity / ((4.0 / 3 * dem::effective_modulus(s.material)) * std::sqrt(radius)), 2.0 / 3);
}

/// Runs `steps` steps one by one and sums what the wall's loads give.
struct Booked {
    Vec3 momentum{}, angular_momentum{};
    double work = 0, power_of_loads = 0;
    Vec3 momentum_of_sphere{}, angular_momentum_of_sphere{};
    double energy = 0;  ///< kinetic, at the end, less that at the start
};

Booked booked(const dem::Setup& setup, std::int64_t steps) {
    const auto engine = dem::make_engine(setup, {});
    const double mass = dem::sphere_mass(radius, setup.material.density), inertia = 0.4 * mass * radius * radius;
    const auto motion = [&](double sign, Booked& b) {
        const auto state = tests::state_of(*engine);
        const Vec3 &x = state.position[0], &v = state.velocity[0], &w = state.angular_velocity[0];
        b.momentum_of_sphere += (sign * mass) * v;
        b.angular_momentum_of_sphere += (sign * mass) * cross(x, v) + (sign * inertia) * w;
        b.energy += sign * (0.5 * mass * dot(v, v) + 0.5 * inertia * dot(w, w));
    };
    Booked b;
    motion(-1, b);
    double before = 0;
    for (std::int64_t k = 0; k < steps; ++k) {
        engine->run(1);
        const auto load = engine->wall_load(0, {});
        const auto twist = geometry::twist_at(setup.walls[0].motions, engine->wall_time());
        b.momentum += (-setup.time_step) * load.force;
        b.angular_momentum += (-setup.time_step) * load.torque;
        b.power_of_loads -= setup.time_step * (dot(load.force, twist.at({})) + dot(load.torque, twist.spin));
        b.work = load.work;
        before = std::max(before, norm(load.force));
    }
    EXPECT_EQ(norm(engine->wall_load(0, {}).force), 0) << "still in contact";
    EXPECT_GT(before, 0) << "never in contact";
    EXPECT_EQ(engine->fault(), "");
    motion(1, b);
    return b;
}

constexpr std::int64_t long_enough = 1200;  // steps of 1 us: one impact

// Momentum and angular momentum of the sphere are what the wall took, step by step: rounding alone.
TEST(WallMotions, LoadsAreTheReaction) {
    for (const auto& m : all_moving_walls()) {
        SCOPED_TRACE(m.name);
        for (const double rolling : {0.0, 0.1}) {
            auto setup = one_sphere(m.position, m.velocity, {m.wall});
            setup.material.rolling_friction = rolling;
            setup.spheres[0].angular_velocity = {40, -60, 30};
            const auto b = booked(setup, long_enough);
            const double scale = dem::sphere_mass(radius, 2500) * norm(m.velocity);
            EXPECT_LT(norm(b.momentum - b.momentum_of_sphere), 1e-12 * scale);
            EXPECT_LT(norm(b.angular_momentum - b.angular_momentum_of_sphere), 1e-12 * scale * 0.01);
        }
    }
}

// The work booked is that of force and torque on the wall: exact where it does not turn, or without friction, for then
// the lever is the normal; with friction on a turning wall the torque's lever is the middle of the overlap, the
// velocity that of the surface.
TEST(WallMotions, WorkIsThatOfTheLoads) {
    for (const auto& m : all_moving_walls())
        for (const double friction : {0.0, 0.3}) {
            SCOPED_TRACE(m.name);
            auto setup = one_sphere(m.position, m.velocity, {m.wall});
            setup.material.friction = friction;
            const auto b = booked(setup, long_enough);
            const bool turns = geometry::twist_at(m.wall.motions, 0).turns;
            const double scale = 0.5 * dem::sphere_mass(radius, 2500) * dot(m.velocity, m.velocity);
            EXPECT_NEAR(b.work, b.power_of_loads, (turns && friction > 0 ? 3e-3 : 1e-12) * scale);
        }
}

// Without friction and damping an impact gives back what it took, up to the work of the wall: the error is that of the
// integrator, of second order in the step.
TEST(WallMotions, EnergyIsConservedUpToTheWorkOfTheWall) {
    for (const auto& m : all_moving_walls()) {
        SCOPED_TRACE(m.name);
        double error[2] = {};
        for (const int k : {0, 1}) {
            auto setup = one_sphere(m.position, m.velocity, {m.wall});
            setup.material.friction = 0;
            setup.material.restitution = 1;
            setup.time_step = k == 0 ? 1e-6 : 2.5e-7;
            const auto b = booked(setup, k == 0 ? long_enough : 4 * long_enough);
            error[k] =
                std::abs(b.energy - b.work) / (0.5 * dem::sphere_mass(radius, 2500) * dot(m.velocity, m.velocity));
        }
        EXPECT_LT(error[0], 2e-3);
        EXPECT_LT(error[1], 0.2 * error[0] + 5e-7) << "of the integrator";
    }
}

TEST(WallMotions, AWallWithoutMotionIsAWallAtRest) {
    const dem::Plane floor;
    const Vec3 x{0, 0, 1.01e-3}, v{0.1, 0, -0.2};
    const std::vector<std::vector<geometry::Motion>> still = {
        {dem::Translation{}},
        {dem::Vibration{.amplitude = {}, .frequency = 50}, dem::Rotation{.point = {1, 2, 3}, .axis = {1, 0, 0}}},
        {dem::Translation{.velocity = {0, 0, 1}, .start = 1e9}},
        {dem::Rotation{.point = {-0.01, 0, 0}, .axis = {0, 1, 0}, .speed = 3, .start = 1e9}},
    };
    const auto rest = dem::make_engine(one_sphere(x, v, {floor}), {});
    rest->run(600);
    for (const auto& motions : still) {
        const auto engine = dem::make_engine(one_sphere(x, v, {{floor, motions}}), {});
        engine->run(600);
        EXPECT_EQ(tests::state_of(*engine).position, tests::state_of(*rest).position);
        EXPECT_EQ(tests::state_of(*engine).velocity, tests::state_of(*rest).velocity);
        EXPECT_EQ(tests::state_of(*engine).angular_velocity, tests::state_of(*rest).angular_velocity);
    }
}

// A wall that moves evenly is a wall at rest seen from a moving frame.
TEST(WallMotions, TheSameInAMovingFrame) {
    const Vec3 frame{0.3, -0.1, 0.2};
    const dem::Cylinder roller{.point = {0, 0, -0.01}, .axis = {0, 1, 0}, .radius = 0.01, .side = dem::Side::outside};
    const dem::Cone funnel{.base = {0, 0, -0.02}, .base_radius = 0.002, .end_radius = 0.03, .length = 0.04};
    const dem::Rotation turns{.point = {0, 0, -0.01}, .axis = {0, 1, 0}, .speed = 20};
    const std::vector<dem::Wall> walls = {
        dem::Plane{}, {roller, {turns}}, funnel, dem::Bar{0.01, 0.02, -0.01, 0, 1e-3}};
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const Vec3 x = w == 2 ? Vec3{0.01477, 0, 0} : Vec3{0.001, 0, 1.01e-3},
                   v = w == 2 ? Vec3{0.3, 0, 0} : Vec3{0.05, 0, -0.3};
        auto moving = walls[w];
        moving.motions.emplace_back(dem::Translation{.velocity = frame});
        const auto here = dem::make_engine(one_sphere(x, v, {walls[w]}), {});
        const auto there = dem::make_engine(one_sphere(x, v + frame, {moving}), {});
        double touched = 0;
        for (int k = 0; k < 600; ++k) {
            here->run(1);
            there->run(1);
            const dem::State a = tests::state_of(*here), b = tests::state_of(*there);
            const Vec3 shift = there->wall_time() * frame;
            ASSERT_LT(norm(b.position[0] - shift - a.position[0]), 1e-12 * 2 * radius) << w << " step " << k;
            ASSERT_LT(norm(b.velocity[0] - frame - a.velocity[0]), 1e-12 * norm(v + frame)) << w << " step " << k;
            ASSERT_LT(radius * norm(b.angular_velocity[0] - a.angular_velocity[0]), 1e-12 * norm(v + frame)) << w;
            touched = std::max(touched, norm(here->wall_load(0, {}).force));
        }
        EXPECT_GT(touched, 0) << w;
    }
}

// v' = u + e (u - v); v' = 2u - v without damping. The damped Hertz contact keeps e to 1e-4 without gravity.
TEST(WallMotions, AWallInMotionGivesItsVelocityToARebound) {
    for (const double e : {0.5, 1.0}) {
        auto setup =
            one_sphere({0, 0, 1.001e-3}, {0, 0, -0.3}, {{dem::Plane{}, {dem::Translation{.velocity = {0, 0, 0.2}}}}});
        setup.material.restitution = e;
        const auto engine = dem::make_engine(setup, {});
        engine->run(400);
        EXPECT_NEAR(tests::state_of(*engine).velocity[0][2], 0.2 + e * 0.5, 1e-3 * 0.5);
    }
}

// A belt takes a sphere at rest to 2/7 of its speed, for the contact point keeps m v + I w/R; it slips until then.
TEST(WallMotions, ABeltTakesASphereToTwoSeventhsOfItsSpeed) {
    auto setup = one_sphere({}, {}, {{dem::Plane{}, {dem::Translation{.velocity = {0.2, 0, 0}}}}});
    setup.gravity = {0, 0, -gravity};
    setup.spheres[0].position[2] = radius - resting_overlap(setup);
    const auto engine = dem::make_engine(setup, {});
    engine->run(60000);
    EXPECT_NEAR(tests::state_of(*engine).velocity[0][0] / 0.2, 2.0 / 7, 1e-3 * 2 / 7);
}

// A conveyance moves the surface of any wall as a shift moves that of a plane, bit by bit, and the wall stays.
TEST(WallMotions, AConveyanceMovesTheSurfaceAlone) {
    const Vec3 velocity{0.2, 0, 0};
    const auto after = [&](const dem::Wall& wall, int steps) {
        auto setup = one_sphere({}, {}, {wall});
        setup.gravity = {0, 0, -gravity};
        setup.spheres[0].position[2] = radius - resting_overlap(setup);
        const auto engine = dem::make_engine(setup, {});
        engine->run(steps);
        return tests::state_of(*engine);
    };
    constexpr int steps = 60000;
    const auto shifted = after({dem::Plane{}, {dem::Translation{.velocity = velocity}}}, steps);
    const auto plane = after({dem::Plane{}, {geometry::Conveyance{.velocity = velocity}}}, steps);
    EXPECT_EQ(plane.position, shifted.position);
    EXPECT_EQ(plane.velocity, shifted.velocity);
    // On a finite belt the sphere comes to the same speed, then leaves its end; the belt is still there.
    const double way = shifted.position[0][0];
    ASSERT_GT(way, radius);
    const dem::Bar long_belt{1, 2, -0.01, 0, 1e-3}, short_belt{way / 2 + 1e-3, 1, -0.01, 0, 1e-3};
    const auto carried = after({long_belt, {geometry::Conveyance{.velocity = velocity}}}, steps);
    EXPECT_NEAR(carried.velocity[0][0] / 0.2, 2.0 / 7, 1e-3 * 2 / 7);
    EXPECT_NEAR(carried.position[0][0], way, 1e-6);
    const auto fallen = after({short_belt, {geometry::Conveyance{.velocity = velocity}}}, 10 * steps);
    EXPECT_TRUE(fallen.position.empty() || fallen.position[0][2] < 0) << "it left the domain, or falls";
    EXPECT_TRUE(geometry::is_still(geometry::Conveyance{}));
}

// What leaves a surface where it is needs no new lists: a sphere above the belt, beside a roller and in a drum.
TEST(WallMotions, ListsFollowTheSurfaceOnly) {
    const dem::Plane floor{{0, 0, -0.0205}, {0, 0, 1}};
    const dem::Cylinder drum{.point = {}, .axis = {0, 1, 0}, .radius = 0.0205};
    const dem::Cylinder roller{.point = {0, 0, 0.002}, .axis = {0, 1, 0}, .radius = 0.001, .side = dem::Side::outside};
    const dem::Rotation about_y{.axis = {0, 1, 0}, .speed = 50},
        beside{.point = {1e-3, 0, 0}, .axis = {0, 1, 0}, .speed = 50};
    const std::vector<std::pair<dem::Wall, bool>> walls = {
        {{floor, {dem::Translation{.velocity = {3, 1, 0}}}}, true},
        {{floor, {dem::Rotation{.axis = {0, 0, -1}, .speed = 90}}}, true},
        {{floor, {dem::Translation{.velocity = {0, 0, -1}}}}, false},
        {{drum, {about_y}}, true},
        {{drum, {about_y, dem::Translation{.velocity = {0, 2, 0}}}}, true},
        {{drum, {beside}}, false},
        {{roller, {dem::Rotation{.point = {0, 7, 0.002}, .axis = {0, -1, 0}, .speed = 9}}}, true},
        {{roller, {about_y}}, false},
    };
    for (std::size_t w = 0; w < walls.size(); ++w) {
        const auto engine = dem::make_engine(one_sphere({0, 0, 0}, {}, {walls[w].first}), {});
        engine->run(5000);
        EXPECT_EQ(engine->work().rebuilds == 1, walls[w].second) << w;
        EXPECT_EQ(engine->fault(), "") << w;
    }
}

// On a turntable the velocity of a rolling sphere turns at 2/7 of the table's rate.
TEST(WallMotions, ATurntableTurnsTheVelocityAtTwoSeventhsOfItsRate) {
    constexpr double rate = 30;
    auto setup = one_sphere({0.005, 0, 0}, {}, {{dem::Plane{}, {dem::Rotation{.speed = rate}}}});
    setup.gravity = {0, 0, -gravity};
    setup.spheres[0].position[2] = radius - resting_overlap(setup);
    setup.time_step = 2e-6;
    // Rolling on the table: v + w x (-R z) = rate z x r.
    setup.spheres[0].velocity = {0.02, 0, 0};
    const double arm = radius - resting_overlap(setup) / 2;
    setup.spheres[0].angular_velocity = {rate * 0.005 / arm, 0.02 / arm, 0};
    const auto engine = dem::make_engine(setup, {});
    engine->run(10000);
    const auto direction = [&] {
        const Vec3 v = tests::state_of(*engine).velocity[0];
        return std::atan2(v[1], v[0]);
    };
    const double before = direction();
    engine->run(20000);
    const double turned = std::remainder(direction() - before, 2 * pi);
    EXPECT_NEAR(turned / (20000 * 2e-6), 2.0 / 7 * rate, 1e-3 * 2.0 / 7 * rate);
}

// Down the inside of a cone of half angle a, sliding: g (cos a - mu sin a).
TEST(WallMotions, SlidesDownAConeWithItsFriction) {
    constexpr double a = pi / 6, mu = 0.1;
    const dem::Cone funnel{
        .base = {0, 0, -0.03}, .base_radius = 0.005, .end_radius = 0.005 + 0.07 * std::tan(a), .length = 0.07};
    auto setup = one_sphere({}, {}, {funnel});
    setup.material.friction = mu;
    setup.gravity = {0, 0, -gravity};
    const double mass = dem::sphere_mass(radius, setup.material.density);
    const double overlap = std::pow(
        mass * gravity * std::sin(a) / ((4.0 / 3 * dem::effective_modulus(setup.material)) * std::sqrt(radius)),
        2.0 / 3);
    const double at_height = 0.005 + 0.05 * std::tan(a);
    setup.spheres[0].position = {at_height - (radius - overlap) / std::cos(a), 0, 0.02};
    const auto engine = dem::make_engine(setup, {});
    engine->run(10000);
    const Vec3 before = tests::state_of(*engine).velocity[0];
    engine->run(20000);
    const double gained = norm(tests::state_of(*engine).velocity[0] - before);
    EXPECT_NEAR(gained / 0.02, gravity * (std::cos(a) - mu * std::sin(a)), 1e-6 * gravity);
}

// The seventh known defect of walls made of triangles (mesh_defects.cpp): poses are closed forms, and no step adds to
// another.
TEST(MeshDefects, AMeshDoesNotDrift) {
    const dem::Mesh block(tests::surface_of(tests::box(0.004, 0.004)));
    const Vec3 axis = (1 / norm(Vec3{1, 2, 3})) * Vec3{1, 2, 3}, point{0.001, 0, 0.002};
    constexpr double step = 1e-5;
    dem::MovingWall wall({block, {dem::Rotation{.point = point, .axis = axis, .speed = 37}}},
                         {{-1, -1, -1}, {1, 1, 1}, {}}, radius);
    for (std::int64_t k = 0; k <= 1000000; k += 50000) {
        wall.place(static_cast<double>(k) * step);
        for (const Vec3& corner : block.surface().corners) {
            const Vec3 now = wall.pose().from_body(corner);
            EXPECT_NEAR(norm(now - point) / norm(corner - point), 1, 1e-15 * 4);
            EXPECT_NEAR(dot(now - point, axis), dot(corner - point, axis), 1e-17);
        }
    }
}

}  // namespace grainsweep::tests::wall_motions_test
