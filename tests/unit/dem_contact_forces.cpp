// What an engine says of its contacts: forces printed by LIGGGHTS for two spheres at rest, Newton's law against the
// engine's own motion, and the running maximum of the overlap. Both precisions.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/granular_scenes.hpp"

namespace grainsweep::tests::dem_contact_forces_test {

using namespace dem;
using geometry::operator*;
using geometry::operator-;
using geometry::operator+=;
using geometry::operator-=;

constexpr double diameter = 45e-6;

class ContactForces : public testing::TestWithParam<Method::Precision> {
protected:
    [[nodiscard]] static std::unique_ptr<Engine> engine_of(const dem::Setup& setup) {
        Method method;
        method.precision = GetParam();
        return make_engine(setup, method);
    }
    /// Rounding of a force over the largest force.
    [[nodiscard]] static double rounding() { return GetParam() == Method::Precision::mixed ? 1e-5 : 1e-11; }
};
INSTANTIATE_TEST_SUITE_P(Both, ContactForces,
                         testing::Values(Method::Precision::mixed, Method::Precision::double_precision),
                         [](const auto& p) { return p.param == Method::Precision::mixed ? "mixed" : "double"; });

dem::Setup pair(double distance, bool second_mobile, double cohesion) {
    dem::Setup s;
    s.domain = {{-1e-3, -1e-3, -1e-3}, {1e-3, 1e-3, 1e-3}, {}};
    s.material.youngs_modulus = 2.11e6;
    s.material.restitution = 0.64;
    s.material.friction = 0.5;
    s.material.cohesion = cohesion;
    s.gravity = {};
    s.time_step = 1e-6;
    s.spheres = {{{0, 0, 0}, {}, {}, diameter / 2, true}, {{distance, 0, 0}, {}, {}, diameter / 2, second_mobile}};
    return s;
}

std::vector<ContactForce> contacts_of(const Engine& engine) {
    std::vector<ContactForce> contacts;
    engine.contacts(contacts);
    return contacts;
}

/// Thrown spheres of unequal size between planes, lossless: then no force depends on a velocity.
dem::Setup lossless_box() {
    dem::Setup s = tests::boxed_lattice(4, 0.5, 0.2, 3);
    s.material.restitution = 1;
    s.material.friction = 0.4;
    s.material.cohesion = 20e3;
    return s;
}

struct Load {
    Vec3 force{}, torque{};
};

/// Forces and torques by id, summed over an engine's contacts: torque -(R - d/2) n x F_t on either partner.
std::map<std::int32_t, Load> loads_of(const Engine& engine, const State& state) {
    std::map<std::int32_t, double> radius;
    for (std::size_t i = 0; i < state.id.size(); ++i) radius[state.id[i]] = state.radius[i];
    std::map<std::int32_t, Load> loads;
    for (const ContactForce& c : contacts_of(engine)) {
        const Vec3 moment = geometry::cross(c.normal, c.tangential_force);
        loads[c.first].force += c.normal_force * c.normal;
        loads[c.first].force += c.tangential_force;
        loads[c.first].torque -= (radius.at(c.first) - c.overlap / 2) * moment;
        if (c.second < 0) continue;
        loads[c.second].force -= c.normal_force * c.normal;
        loads[c.second].force -= c.tangential_force;
        loads[c.second].torque -= (radius.at(c.second) - c.overlap / 2) * moment;
    }
    return loads;
}

TEST_P(ContactForces, NetForceIsThatOfAnotherProgram) {
    // LIGGGHTS 3.8, SJKR, two spheres at rest: overlap 0.45 um, contact area 3.16496e-11 m2, net force 4.57375e-07 N.
    const double overlap = 0.45e-6;
    const auto contacts = contacts_of(*engine_of(pair(diameter - overlap, true, 35e3)));
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].overlap / overlap, 1, 1e-5);  // single precision places a centre to 1e-7 of a diameter
    EXPECT_NEAR(contacts[0].normal_force / 4.57375e-07, 1, 2e-5);
    const auto dry = contacts_of(*engine_of(pair(diameter - overlap, true, 0)));
    EXPECT_NEAR((dry[0].normal_force - contacts[0].normal_force) / 35e3 / 3.16496e-11, 1, 1e-5);
    EXPECT_EQ(contacts[0].tangential_force, Vec3{});
}

TEST_P(ContactForces, ApproachIsDampedAndFrozenPartnersAreHeavy) {
    dem::Setup approaching = pair(0.99 * diameter, true, 0);
    const double rest = contacts_of(*engine_of(approaching))[0].normal_force;
    approaching.spheres[0].velocity[0] = 0.1;
    const double one = contacts_of(*engine_of(approaching))[0].normal_force - rest;
    approaching.spheres[1].mobile = false;
    const double heavy = contacts_of(*engine_of(approaching))[0].normal_force - rest;
    EXPECT_GT(one, 0);
    EXPECT_NEAR(heavy / one, std::sqrt(2.0), 1e-5);  // damping ~ sqrt(m*), m* doubled
}

TEST_P(ContactForces, OnlyTouchingPairsWithAMobileSphere) {
    EXPECT_TRUE(contacts_of(*engine_of(pair(1.0001 * diameter, true, 0))).empty());
    EXPECT_EQ(contacts_of(*engine_of(pair(0.99 * diameter, false, 0))).size(), 1U);
    dem::Setup frozen = pair(0.99 * diameter, false, 0);
    frozen.spheres[0].mobile = false;
    EXPECT_TRUE(contacts_of(*engine_of(frozen)).empty());
}

TEST_P(ContactForces, FrozenSpheresMayOverlap) {
    // A wall cut from a packing may be as tight as it likes: its pairs are never looked at.
    dem::Setup tight = pair(0.4 * diameter, false, 0);
    tight.spheres[0].mobile = false;
    tight.spheres.push_back({{0, 3 * diameter, 0}, {0.01, 0, 0}, {}, diameter / 2, true});
    const auto engine = engine_of(tight);
    engine->run(100);
    EXPECT_EQ(engine->fault(), "");
    EXPECT_EQ(engine->peak_overlap(), 0);
    EXPECT_EQ(engine->work().particle_steps, 100);
}

TEST_P(ContactForces, MoveTheParticlesAsNewtonSays) {
    // Velocity Verlet: v(t+dt) - v(t) = dt (g + (f(t) + f(t+dt))/2m), the same for spins.
    const dem::Setup setup = lossless_box();
    const auto engine = engine_of(setup);
    engine->run(700);
    ASSERT_EQ(engine->fault(), "");
    State before, after;
    engine->state(before);
    auto loads = loads_of(*engine, before);
    engine->run(1);
    engine->state(after);
    ASSERT_EQ(before.id, after.id);
    for (const auto& [id, load] : loads_of(*engine, after)) {
        loads[id].force += load.force;
        loads[id].torque += load.torque;
    }
    double largest_force = 0, largest_torque = 0, pushed = 0, turned = 0;
    for (const auto& [id, load] : loads) {
        largest_force = std::max(largest_force, geometry::norm(load.force));
        largest_torque = std::max(largest_torque, geometry::norm(load.torque));
        pushed += geometry::norm(load.force) > 0 ? 1 : 0;
        turned += geometry::norm(load.torque) > 0 ? 1 : 0;
    }
    EXPECT_GT(pushed, 15);
    EXPECT_GT(turned, 15);
    for (std::size_t i = 0; i < after.id.size(); ++i) {
        const double mass = sphere_mass(after.radius[i], setup.material.density);
        const double inertia = 0.4 * mass * after.radius[i] * after.radius[i];
        const Load& load = loads[after.id[i]];
        const Vec3 kick = after.velocity[i] - before.velocity[i] - setup.time_step * setup.gravity;
        const Vec3 spin = after.angular_velocity[i] - before.angular_velocity[i];
        for (std::size_t a = 0; a < 3; ++a) {
            EXPECT_NEAR(kick[a] * 2 * mass / setup.time_step / largest_force, load.force[a] / largest_force,
                        rounding());
            // Velocities are rounded too: spins of the mixed engine to single precision.
            EXPECT_NEAR(spin[a] * 2 * inertia / setup.time_step / largest_torque, load.torque[a] / largest_torque,
                        100 * rounding());
        }
    }
}

TEST(ContactForcesOfBothEngines, Agree) {
    dem::Setup setup = tests::boxed_lattice(4, 0.5, 0, 3);
    setup.material.cohesion = 30e3;
    setup.material.friction_limit = FrictionLimit::net;
    setup.spheres[17].mobile = setup.spheres[40].mobile = false;
    setup.spheres[17].velocity = setup.spheres[17].angular_velocity = {};
    setup.spheres[40].velocity = setup.spheres[40].angular_velocity = {};
    std::map<std::pair<std::int32_t, std::int32_t>, ContactForce> found[2];
    for (const auto precision : {Method::Precision::mixed, Method::Precision::double_precision}) {
        Method method;
        method.precision = precision;
        const auto engine = make_engine(setup, method);
        engine->run(600);
        ASSERT_EQ(engine->fault(), "");
        for (ContactForce c : contacts_of(*engine)) {
            if (c.second > c.first) {  // which comes first is left to the engine
                std::swap(c.first, c.second);
                c.normal = -1.0 * c.normal;
                c.tangential_force = -1.0 * c.tangential_force;
            }
            EXPECT_TRUE(found[static_cast<int>(precision)].emplace(std::pair{c.first, c.second}, c).second);
        }
    }
    ASSERT_GT(found[0].size(), 30U);
    ASSERT_EQ(found[0].size(), found[1].size());
    EXPECT_TRUE(std::ranges::any_of(found[0], [](const auto& entry) { return entry.first.second < 0; }));  // walls
    double largest = 0;
    for (const auto& [ids, c] : found[1]) largest = std::max(largest, std::abs(c.normal_force));
    for (const auto& [ids, a] : found[0]) {
        ASSERT_TRUE(found[1].contains(ids)) << ids.first << " " << ids.second;
        const ContactForce& b = found[1].at(ids);
        // Paths have drifted apart by 600 steps of rounding.
        EXPECT_NEAR(a.overlap / 1e-3, b.overlap / 1e-3, 1e-6);
        EXPECT_NEAR(a.normal_force / largest, b.normal_force / largest, 1e-3);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(a.normal[k], b.normal[k], 1e-5);
            EXPECT_NEAR(a.tangential_force[k] / largest, b.tangential_force[k] / largest, 1e-3);
        }
    }
}

TEST_P(ContactForces, PeakOverlapIsTheLargestOfAllSteps) {
    const dem::Setup setup = lossless_box();
    const auto at_once = engine_of(setup), stepwise = engine_of(setup);
    at_once->run(900);
    double peak = stepwise->largest_overlap();
    EXPECT_EQ(stepwise->peak_overlap(), peak);
    for (int k = 0; k < 900; ++k) {
        stepwise->run(1);
        peak = std::max(peak, stepwise->largest_overlap());
    }
    EXPECT_GT(peak, 1.5 * at_once->largest_overlap());  // the last step is not the deepest
    EXPECT_EQ(at_once->peak_overlap(), peak);

    std::vector<std::byte> bytes;
    at_once->save(bytes);
    const auto restored = engine_of(setup);
    restored->restore(bytes);
    EXPECT_EQ(restored->peak_overlap(), peak);
    restored->forget_peak_overlap();
    EXPECT_EQ(restored->peak_overlap(), 0);
    restored->run(1);
    EXPECT_EQ(restored->peak_overlap(), restored->largest_overlap());
}

}  // namespace grainsweep::tests::dem_contact_forces_test
