// The mixed-precision engine against the law written down plainly in double precision, on every instruction path.
// The tolerance is measured (tests/support/against_plain.hpp).
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "tests/support/against_plain.hpp"
#include "tests/support/blade.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/plain_dem.hpp"

namespace grainsweep::tests::fast_against_plain_test {

using dem::Method;

TEST(FastAgainstPlain, EqualSpheresThrownTogether) {
    tests::compare_with_plain({"periodic", tests::thrown_lattice(5, 1.0, 0, 1), 600});
    tests::compare_with_plain({"boxed", tests::boxed_lattice(5, 0.5, 0, 2), 800});
}

TEST(FastAgainstPlain, UnequalSpheres) {
    tests::compare_with_plain({"unequal_periodic", tests::thrown_lattice(5, 1.0, 0.3, 3), 600});
    tests::compare_with_plain({"unequal_boxed", tests::boxed_lattice(5, 0.5, 0.25, 4), 800});
}

TEST(FastAgainstPlain, FrozenSpheresAreWallsOfSpheres) {
    for (const double spread : {0.0, 0.2}) {
        dem::Setup s = tests::thrown_lattice(5, 1.0, spread, 5);
        for (std::size_t i = 0; i < 25; ++i) {
            s.spheres[i].mobile = false;
            s.spheres[i].velocity = s.spheres[i].angular_velocity = {};
        }
        s.gravity = {1, 0, -9.81};
        tests::compare_with_plain({spread == 0 ? "frozen" : "frozen_unequal", s, 600});
    }
}

TEST(FastAgainstPlain, WithoutFriction) {
    dem::Setup s = tests::boxed_lattice(5, 0.5, 0, 6);
    s.material.friction = 0;
    tests::compare_with_plain({"frictionless", s, 800});
    s = tests::boxed_lattice(4, 0.5, 0.2, 6);
    s.material.friction = 0;
    tests::compare_with_plain({"frictionless_unequal", s, 800});
    s = tests::boxed_lattice(5, 0.4, 0, 12);  // some touch at the start: no dashpot may act on them
    s.material.friction = 0;
    s.material.cohesion = 2e5;
    tests::compare_with_plain({"frictionless_cohesive", s, 600});
}

TEST(FastAgainstPlain, EveryCohesionAndLimit) {
    for (const auto area : {dem::CohesionLaw::sjkr, dem::CohesionLaw::sjkr2, dem::CohesionLaw::paper})
        for (const auto limit : {dem::FrictionLimit::contact, dem::FrictionLimit::net})
            for (const double spread : {0.0, 0.2}) {
                dem::Setup s = tests::boxed_lattice(4, 0.3, spread, 8);
                s.material.cohesion = 2e5;
                s.material.cohesion_law = area;
                s.material.friction_limit = limit;
                tests::compare_with_plain({"cohesive", s, 600});
            }
}

TEST(FastAgainstPlain, BladeMovingAndVibrating) {
    for (const double round : {0.0, 0.4e-3})
        for (const double spread : {0.0, 0.2}) {
            dem::Setup s = tests::boxed_lattice(5, 0.2, spread, 9);
            Blade b;
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
            tests::compare_with_plain({round == 0 ? "blade_sharp" : "blade_round", s, 500});
        }
}

// Rolling resistance everywhere at once: pairs of all sizes, frozen spheres, planes, a blade; with and without what
// Coulomb's and the rolling limit see of cohesion, and without friction.
TEST(FastAgainstPlain, RollingResistance) {
    for (const double spread : {0.0, 0.25})
        for (const double friction : {0.0, 0.4})
            for (const double cohesion : {0.0, 2e5}) {
                dem::Setup s = tests::boxed_lattice(5, 0.4, spread, 12);
                s.material.friction = friction;
                s.material.rolling_friction = 0.15;
                s.material.cohesion = cohesion;
                s.material.friction_limit = spread > 0 ? dem::FrictionLimit::net : dem::FrictionLimit::contact;
                s.spheres[60].mobile = s.spheres[31].mobile = false;
                for (const std::size_t i : {31U, 60U}) s.spheres[i].velocity = s.spheres[i].angular_velocity = {};
                Blade b;
                b.front = s.domain.low[0] + 2.95e-3;
                b.thickness = 2e-3;
                b.bottom = s.domain.low[2] + 5.5e-3;
                b.top = b.bottom + 20e-3;
                b.speed = 0.8;
                s.walls.erase(s.walls.begin() + 1);
                s.walls.push_back(b);
                tests::compare_with_plain({"rolling", s, 300});
            }
}

// The torque reverses at once: in some arrangements rounding moves a reversal by a step, in this one not.
TEST(FastAgainstPlain, AConstantTorqueAgainstRolling) {
    for (const double spread : {0.0, 0.25})
        for (const double cohesion : {0.0, 2e5}) {
            dem::Setup s = tests::boxed_lattice(5, 0.4, spread, 15);
            s.material.rolling_friction = 0.2;
            s.material.rolling_law = dem::RollingLaw::cdt;
            s.material.cohesion = cohesion;
            tests::compare_with_plain({"constant_torque", s, 300});
        }
}

// Contacts that last beyond touch, with everything that follows their radius; slow spheres, some of which stick.
TEST(FastAgainstPlain, SurfaceEnergy) {
    for (const auto law : {dem::CohesionLaw::jkr, dem::CohesionLaw::dmt})
        for (const auto rolling : {dem::RollingLaw::epsd, dem::RollingLaw::cdt})
            for (const auto limit : {dem::FrictionLimit::contact, dem::FrictionLimit::net})
                for (const double spread : {0.0, 0.25}) {
                    dem::Setup s = tests::boxed_lattice(4, 0.3, spread, 14);
                    s.material.cohesion_law = law;
                    s.material.surface_energy = 2;
                    s.material.rolling_law = rolling;
                    s.material.rolling_friction = spread > 0 ? 0.1 : 0;
                    s.material.friction_limit = limit;
                    tests::compare_with_plain({law == dem::CohesionLaw::jkr ? "jkr" : "dmt", s, 400});
                }
}

// Liquid bridges form, act over gaps, break and form anew.
TEST(FastAgainstPlain, LiquidBridges) {
    for (const auto rolling : {dem::RollingLaw::epsd, dem::RollingLaw::cdt})
        for (const auto limit : {dem::FrictionLimit::contact, dem::FrictionLimit::net})
            for (const double spread : {0.0, 0.25}) {
                dem::Setup s = tests::boxed_lattice(4, 1, spread, 14);
                s.material.cohesion_law = dem::CohesionLaw::capillary;
                s.material.surface_tension = 2;
                s.material.contact_angle = 0.2;
                s.material.bridge_volume = 0.01;
                s.material.rolling_law = rolling;
                s.material.rolling_friction = spread > 0 ? 0.1 : 0;
                s.material.friction_limit = limit;
                tests::compare_with_plain({"capillary", s, 400});
            }
}

TEST(FastAgainstPlain, NewWallsAndRemovedParticles) {
    dem::Setup s = tests::boxed_lattice(5, 0.5, 0, 10);
    tests::PlainDem plain(s);
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
        EXPECT_LT(tests::position_difference(state, expected, s.domain, 1e-3), 1e-5);
        EXPECT_LT(tests::velocity_difference(state, expected), 1e-4);
    }
}

}  // namespace grainsweep::tests::fast_against_plain_test
