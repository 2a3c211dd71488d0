// Contacts read from a state, against forces printed by LIGGGHTS for two spheres at rest.
#include "solver/dem/state_contacts.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/observables/histogram.hpp"

using namespace grainsweep;
using namespace grainsweep::dem;

namespace {

constexpr double diameter = 45e-6;

Material powder(double cohesion) {
    Material m;
    m.youngs_modulus = 2.11e6;
    m.poisson_ratio = 0.3;
    m.density = 7980;
    m.restitution = 0.64;
    m.friction = 0.5;
    m.cohesion = cohesion;
    return m;
}

State pair(double distance, bool first_mobile, bool second_mobile) {
    State state;
    state.id = {0, 1};
    state.position = {Vec3{0, 0, 0}, Vec3{distance, 0, 0}};
    state.velocity = state.angular_velocity = {Vec3{}, Vec3{}};
    state.radius = {diameter / 2, diameter / 2};
    state.mobile = {static_cast<char>(first_mobile), static_cast<char>(second_mobile)};
    return state;
}

}  // namespace

TEST(StateContacts, NetForceIsThatOfAnotherProgram) {
    // README of the tpms reference: overlap 0.45 um, contact area 3.16496e-11 m2, net force 4.57375e-07 N.
    const double overlap = 0.45e-6;
    const auto contacts = contacts_of(pair(diameter - overlap, true, true), powder(35e3));
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].overlap / overlap, 1, 1e-9);
    EXPECT_NEAR(contacts[0].normal_force / 4.57375e-07, 1, 5e-6);  // six digits
    const auto dry = contacts_of(pair(diameter - overlap, true, true), powder(0));
    EXPECT_NEAR((dry[0].normal_force - contacts[0].normal_force) / 35e3 / 3.16496e-11, 1, 5e-6);
}

TEST(StateContacts, ApproachIsDampedAndFrozenPartnersAreHeavy) {
    State approaching = pair(0.99 * diameter, true, true);
    const double rest = contacts_of(approaching, powder(0))[0].normal_force;
    approaching.velocity[0][0] = 0.1;
    const double one = contacts_of(approaching, powder(0))[0].normal_force - rest;
    approaching.mobile[1] = 0;
    const double heavy = contacts_of(approaching, powder(0))[0].normal_force - rest;
    EXPECT_GT(one, 0);
    EXPECT_NEAR(heavy / one, std::sqrt(2.0), 1e-12);  // damping ~ sqrt(m*), m* doubled
}

TEST(StateContacts, OnlyTouchingPairsWithAMobileSphere) {
    EXPECT_TRUE(contacts_of(pair(1.0001 * diameter, true, true), powder(0)).empty());
    EXPECT_TRUE(contacts_of(pair(0.99 * diameter, false, false), powder(0)).empty());
    EXPECT_EQ(contacts_of(pair(0.99 * diameter, false, true), powder(0)).size(), 1U);
    EXPECT_TRUE(contacts_of(State{}, powder(0)).empty());
}

TEST(Histogram, SharesOfBinsThatHoldSomething) {
    const std::vector<double> values = {0, 0.4, 0.5, 0.99, 7.2};
    const auto shares = observables::histogram(values, 0.5);
    ASSERT_EQ(shares.size(), 3U);
    EXPECT_EQ(shares[0], (std::pair{0.25, 0.4}));
    EXPECT_EQ(shares[1], (std::pair{0.75, 0.4}));
    EXPECT_EQ(shares[2], (std::pair{7.25, 0.2}));
    EXPECT_TRUE(observables::histogram({}, 1).empty());
}
