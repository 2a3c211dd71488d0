// The mixed-precision engine against the law written down plainly in double precision, on every instruction path.
//
// Collisions multiply differences, so the tolerance is measured: the plain calculation is repeated with every start
// position moved by up to 1e-7 diameters (two units of single precision), and the engine may differ from the plain one
// by ten times what that grows to. A wrong convention (torque arm, order of damping and limit) differs by 1e-2.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "stats/random.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/plain_dem.hpp"

using namespace grainsweep;
using dem::Method;

namespace {

struct Question {
    std::string name;
    dem::Setup setup;
    std::int64_t steps;
};

std::string path_name(Method::Path path) {
    return path == Method::Path::avx512 ? "avx512" : path == Method::Path::avx2 ? "avx2" : "baseline";
}

std::vector<Method::Path> paths() {
    std::vector<Method::Path> all;
    for (const auto p : {Method::Path::baseline, Method::Path::avx2, Method::Path::avx512})
        if (dem::fast::supports(p)) all.push_back(p);
    return all;
}

dem::State plain_state(const test::PlainDem& plain, const dem::State& like) {
    dem::State s = like;
    for (std::size_t k = 0; k < like.id.size(); ++k) {
        const auto i = static_cast<std::size_t>(like.id[k]);
        s.position[k] = plain.position()[i];
        s.velocity[k] = plain.velocity()[i];
        s.angular_velocity[k] = plain.angular_velocity()[i];
    }
    return s;
}

/// What a change of the start by `size` diameters grows to.
struct Growth {
    double position, velocity, spin;
};

Growth growth(const Question& q, const test::PlainDem& plain, double diameter, double size) {
    dem::Setup moved = q.setup;
    const stats::Stream stream(11, 0);
    std::uint64_t draw = 0;
    for (auto& s : moved.spheres)
        for (double& x : s.position) x += size * diameter * (2 * stream.uniform(draw++) - 1);
    test::PlainDem other(moved);
    other.run(q.steps);
    Growth g{};
    for (std::size_t i = 0; i < moved.spheres.size(); ++i)
        for (std::size_t a = 0; a < 3; ++a) {
            g.position = std::max(g.position, std::abs(other.position()[i][a] - plain.position()[i][a]) / diameter);
            g.velocity = std::max(g.velocity, std::abs(other.velocity()[i][a] - plain.velocity()[i][a]));
            g.spin = std::max(g.spin, std::abs(other.angular_velocity()[i][a] - plain.angular_velocity()[i][a]));
        }
    return g;
}

void compare(const Question& q) {
    test::PlainDem plain(q.setup);
    plain.run(q.steps);
    double diameter = 0;
    for (const auto& s : q.setup.spheres) diameter = std::max(diameter, 2 * s.radius);
    const Growth g = growth(q, plain, diameter, 1e-7);
    ASSERT_LT(g.position, 1e-3) << q.name << " is too long to compare step by step";
    for (const auto path : paths()) {
        SCOPED_TRACE(q.name + " " + path_name(path));
        const auto engine = dem::fast::make_mixed_engine(q.setup, path);
        dem::State state;
        engine->run(q.steps);
        engine->state(state);
        ASSERT_EQ(engine->fault(), "");
        ASSERT_EQ(state.id.size(), q.setup.spheres.size());
        const dem::State expected = plain_state(plain, state);
        EXPECT_LT(test::position_difference(state, expected, q.setup.domain, diameter), 10 * g.position);
        EXPECT_LT(test::velocity_difference(state, expected), 10 * g.velocity);
        EXPECT_LT(test::spin_difference(state, expected), 10 * g.spin + 1e-4);
        EXPECT_NEAR(engine->largest_overlap(), plain.largest_overlap(), 20 * g.position);
    }
}

}  // namespace

TEST(FastAgainstPlain, EqualSpheresThrownTogether) {
    compare({"periodic", test::thrown_lattice(5, 1.0, 0, 1), 600});
    compare({"boxed", test::boxed_lattice(5, 0.5, 0, 2), 800});
}

TEST(FastAgainstPlain, UnequalSpheres) {
    compare({"unequal_periodic", test::thrown_lattice(5, 1.0, 0.3, 3), 600});
    compare({"unequal_boxed", test::boxed_lattice(5, 0.5, 0.25, 4), 800});
}

TEST(FastAgainstPlain, FrozenSpheresAreWallsOfSpheres) {
    for (const double spread : {0.0, 0.2}) {
        dem::Setup s = test::thrown_lattice(5, 1.0, spread, 5);
        for (std::size_t i = 0; i < 25; ++i) {
            s.spheres[i].mobile = false;
            s.spheres[i].velocity = s.spheres[i].angular_velocity = {};
        }
        s.gravity = {1, 0, -9.81};
        compare({spread == 0 ? "frozen" : "frozen_unequal", s, 600});
    }
}

TEST(FastAgainstPlain, WithoutFriction) {
    dem::Setup s = test::boxed_lattice(5, 0.5, 0, 6);
    s.material.friction = 0;
    compare({"frictionless", s, 800});
    s = test::boxed_lattice(4, 0.5, 0.2, 6);
    s.material.friction = 0;
    compare({"frictionless_unequal", s, 800});
    s = test::boxed_lattice(5, 0.4, 0, 12);  // some touch at the start: no dashpot may act on them
    s.material.friction = 0;
    s.material.cohesion = 2e5;
    compare({"frictionless_cohesive", s, 600});
}

TEST(FastAgainstPlain, EveryCohesionAndLimit) {
    for (const auto area : {dem::CohesionLaw::sjkr, dem::CohesionLaw::sjkr2, dem::CohesionLaw::paper})
        for (const auto limit : {dem::FrictionLimit::contact, dem::FrictionLimit::net})
            for (const double spread : {0.0, 0.2}) {
                dem::Setup s = test::boxed_lattice(4, 0.3, spread, 8);
                s.material.cohesion = 2e5;
                s.material.cohesion_law = area;
                s.material.friction_limit = limit;
                compare({"cohesive", s, 600});
            }
}

TEST(FastAgainstPlain, BladeMovingAndVibrating) {
    for (const double round : {0.0, 0.4e-3})
        for (const double spread : {0.0, 0.2}) {
            dem::Setup s = test::boxed_lattice(5, 0.2, spread, 9);
            dem::Blade b;
            b.front = s.domain.low[0] + 2.95e-3;  // just outside the lattice
            b.thickness = 2e-3;
            b.bottom = s.domain.low[2] + 5.5e-3;
            b.top = b.bottom + 20e-3;
            b.speed = 1.2;
            b.amplitude = 0.05e-3;
            b.frequency = 400;
            b.edge_radius = round;
            s.walls.erase(s.walls.begin() + 1);  // the plane where the blade comes from
            s.walls.push_back(b);
            compare({round == 0 ? "blade_sharp" : "blade_round", s, 500});
        }
}

// Rolling resistance everywhere at once: pairs of all sizes, frozen spheres, planes, a blade; with and without what
// Coulomb's and the rolling limit see of cohesion, and without friction.
TEST(FastAgainstPlain, RollingResistance) {
    for (const double spread : {0.0, 0.25})
        for (const double friction : {0.0, 0.4})
            for (const double cohesion : {0.0, 2e5}) {
                dem::Setup s = test::boxed_lattice(5, 0.4, spread, 12);
                s.material.friction = friction;
                s.material.rolling_friction = 0.15;
                s.material.cohesion = cohesion;
                s.material.friction_limit = spread > 0 ? dem::FrictionLimit::net : dem::FrictionLimit::contact;
                s.spheres[60].mobile = s.spheres[31].mobile = false;
                for (const std::size_t i : {31U, 60U}) s.spheres[i].velocity = s.spheres[i].angular_velocity = {};
                dem::Blade b;
                b.front = s.domain.low[0] + 2.95e-3;
                b.thickness = 2e-3;
                b.bottom = s.domain.low[2] + 5.5e-3;
                b.top = b.bottom + 20e-3;
                b.speed = 0.8;
                s.walls.erase(s.walls.begin() + 1);
                s.walls.push_back(b);
                compare({"rolling", s, 300});
            }
}

TEST(FastAgainstPlain, NewWallsAndRemovedParticles) {
    dem::Setup s = test::boxed_lattice(5, 0.5, 0, 10);
    test::PlainDem plain(s);
    const std::vector<std::int32_t> out{3, 60, 61, 124, 4000};
    std::vector<dem::Wall> fewer(s.walls.begin(), s.walls.begin() + 3);
    plain.run(300);
    for (const auto id : out)
        if (id < 125) plain.remove(id);
    plain.run(200);
    plain.set_walls(fewer);
    plain.run(300);
    for (const auto path : paths()) {
        SCOPED_TRACE(path_name(path));
        const auto engine = dem::fast::make_mixed_engine(s, path);
        engine->run(300);
        engine->remove(out);
        EXPECT_EQ(engine->size(), 121U);
        engine->run(200);
        EXPECT_NEAR(engine->wall_time(), 500 * s.time_step, 1e-12);
        engine->set_walls(fewer);
        EXPECT_EQ(engine->wall_time(), 0);
        engine->run(300);
        dem::State state;
        engine->state(state);
        const dem::State expected = plain_state(plain, state);
        EXPECT_LT(test::position_difference(state, expected, s.domain, 1e-3), 1e-5);
        EXPECT_LT(test::velocity_difference(state, expected), 1e-4);
    }
}
