// Many spheres: what must be conserved, what must not grow, and what must not depend on the list.
#include "solver/dem/engine.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::tests::dem_conservation_test {

using namespace geometry;

/// A dense cluster falling into itself: no walls, all fly towards the middle.
dem::Setup imploding_cluster(double ratio) {
    auto setup = tests::boxed_gas(216, 0.1, ratio, 4);
    setup.walls.clear();
    setup.domain = {{-1, -1, -1}, {1, 1, 1}, {}};
    for (std::size_t i = 0; i < setup.spheres.size(); ++i) {
        auto& s = setup.spheres[i];
        const Vec3 inwards = Vec3{0.007, 0.007, 0.007} - s.position;
        s.velocity = s.velocity + 60.0 * inwards;
        s.angular_velocity = {10.0 * static_cast<double>(i % 7), -30, 20};
    }
    return setup;
}

struct Momenta {
    Vec3 linear{}, angular{};
    double linear_scale = 0, angular_scale = 0;
};

Momenta momenta(const dem::Setup& setup, const dem::State& s) {
    Momenta total;
    for (std::size_t i = 0; i < s.id.size(); ++i) {
        const double m = tests::mass(setup, s.radius[i]);
        const Vec3 orbital = m * cross(s.position[i], s.velocity[i]);
        total.linear += m * s.velocity[i];
        total.angular += orbital + (0.4 * m * s.radius[i] * s.radius[i]) * s.angular_velocity[i];
        total.linear_scale += m * norm(s.velocity[i]);
        total.angular_scale += norm(orbital);
    }
    return total;
}

// To rounding: about 2000 steps of contacts, each adding equal and opposite forces and torques about one point.
TEST(DemConservation, MomentumAndAngularMomentumOfAFreeCluster) {
    for (const double ratio : {1.0, 5.0}) {
        auto setup = imploding_cluster(ratio);
        setup.material.friction = 0.5;
        setup.material.cohesion = 1e4;
        const auto engine = dem::make_engine(setup, {});
        const auto before = momenta(setup, state_of(*engine));
        engine->run(2000);
        ASSERT_EQ(engine->fault(), "");
        ASSERT_EQ(engine->size(), 216U);
        const auto after = momenta(setup, state_of(*engine));
        EXPECT_LT(norm(after.linear - before.linear), 1e-13 * before.linear_scale);
        EXPECT_LT(norm(after.angular - before.angular), 1e-13 * before.angular_scale);
    }
}

// Kinetic energy after the collisions of a dissipative gas, between contacts and in them, never exceeds the start, and
// falls: contacts give back at most what they took.
TEST(DemConservation, EnergyNeverGrows) {
    for (const double restitution : {1.0, 0.8, 0.5})
        for (const double friction : {0.0, 0.5}) {
            auto setup = tests::boxed_gas(216, 0.5, 1, 8);
            setup.material.restitution = restitution;
            setup.material.friction = friction;
            setup.time_step = 2e-6;
            const auto engine = dem::make_engine(setup, {});
            const double start = tests::kinetic_energy(setup, state_of(*engine));
            double last = start;
            for (int k = 0; k < 20; ++k) {
                engine->run(500);
                ASSERT_EQ(engine->fault(), "") << restitution << " " << friction;
                last = tests::kinetic_energy(setup, state_of(*engine));
                EXPECT_LT(last, start * 1.0001);
            }
            if (restitution < 1) {
                EXPECT_LT(last, 0.9 * start);
            }
            if (restitution == 1 && friction == 0) {
                EXPECT_GT(last, 0.9 * start);
            }  // some of it is in contacts
        }
}

// Three skins mean different lists, rebuilt at different times, with particles sorted differently. One of them lists
// all pairs once and for all. Until rounding has grown the answers are the same.
TEST(DemConservation, AnswerDoesNotDependOnTheNeighbourList) {
    for (const double ratio : {1.0, 20.0}) {
        const auto setup = imploding_cluster(ratio);
        std::vector<dem::State> states;
        std::vector<std::int64_t> rebuilds;
        for (const double skin : {1.0, 5e-4, 5e-5}) {
            dem::Method method;
            method.skin = skin;
            const auto engine = dem::make_engine(setup, method);
            engine->run(400);
            ASSERT_EQ(engine->fault(), "");
            states.push_back(state_of(*engine));
            rebuilds.push_back(engine->work().rebuilds);
        }
        EXPECT_EQ(rebuilds[0], 1);
        EXPECT_GT(rebuilds[2], 10);
        for (std::size_t k = 1; k < states.size(); ++k)
            for (std::size_t i = 0; i < states[0].id.size(); ++i)
                ASSERT_LT(norm(states[k].position[i] - states[0].position[i]), 1e-9 * states[0].radius[i])
                    << "ratio " << ratio << " particle " << i;
    }
}

// A frozen sphere is a wall of its own curvature: an elastic partner bounces off with its speed, and nothing else
// moves.
TEST(DemConservation, FrozenSpheresStayAndReflect) {
    for (const double other : {0.001, 0.002}) {
        auto setup = tests::empty_space();
        setup.material.restitution = 1;
        setup.spheres = {{{0, 0, 0}, {}, {}, other, false},
                         {{other + 0.0011, 0, 0}, {-0.5, 0, 0}, {}, 0.001, true},
                         {{-0.5 * other, 0, 0}, {}, {}, other, false}};
        const auto engine = dem::make_engine(setup, {});
        engine->run(2000);
        ASSERT_EQ(engine->fault(), "");
        const auto s = state_of(*engine);
        EXPECT_EQ(s.position[0], (Vec3{0, 0, 0}));
        EXPECT_EQ(s.velocity[2], (Vec3{}));
        EXPECT_NEAR(s.velocity[1][0], 0.5, 1e-4);
    }
}

// A pair across a periodic face collides as anywhere else; through an open face particles leave and are gone.
TEST(DemConservation, PeriodicFacesJoinAndOpenFacesRemove) {
    auto setup = tests::empty_space();
    setup.domain = {{0, 0, 0}, {0.01, 0.01, 0.01}, {true, false, false}};
    setup.material.restitution = 1;
    setup.spheres = {{{0.0098, 0.005, 0.005}, {0.5, 0, 0}, {}, 0.001, true},
                     {{0.0022, 0.005, 0.005}, {-0.5, 0, 0}, {}, 0.001, true},
                     {{0.005, 0.0095, 0.002}, {0, 1, 0}, {}, 0.001, true}};
    const auto engine = dem::make_engine(setup, {});
    engine->run(1000);
    ASSERT_EQ(engine->fault(), "");
    const auto s = state_of(*engine);
    EXPECT_EQ(s.id, (std::vector<std::int32_t>{0, 1}));
    EXPECT_NEAR(s.velocity[0][0], -0.5, 1e-4);
    EXPECT_NEAR(s.velocity[1][0], 0.5, 1e-4);
    const std::vector<std::int32_t> all_three = {1, 0, 77};
    engine->remove(all_three);
    EXPECT_EQ(engine->size(), 0U);
    engine->run(10);
    EXPECT_EQ(engine->fault(), "");
}

}  // namespace grainsweep::tests::dem_conservation_test
