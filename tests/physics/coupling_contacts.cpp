// Collisions of particles in a fluid: springs follow their law, projected contacts press as springs do.
#include "solver/coupling/suspension.hpp"
#include "solver/observables/flow_state.hpp"
#include "tests/support/flow_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::tests::coupling_contacts_test {

using namespace flow_boxes;

using flow::Boussinesq;

// Two spheres flying at each other through almost no fluid; what they do to it is not looked at.
struct Collision {
    Vec3 after_i{}, after_j{};
};
struct Nothing {
    Vec3 spin{};
    double vibration = 0;
    Surroundings operator()(std::size_t) const { return {}; }
    [[nodiscard]] Vec3 rotation(const Vec3&) const { return spin; }
};

Collision collide(double restitution, double speed, double offset, double friction) {
    const Sphere sphere{4, 1e-4, 1e-9, 0, 1};
    const double dt = 1e-3;
    const Walls around = box(closed, sphere.radius());
    const double mass = 4.5 * sphere.volume();
    // A contact of a hundred sub-steps and five steps.
    HystereticSpring spring{mass * 1e6, restitution, friction};
    SpringContacts contacts(sphere, around, spring, 2);
    Cloud cloud;
    const double r = sphere.radius();
    cloud.position = {{-1.2 * r, 0, 0}, {1.2 * r, offset, 0}};
    cloud.velocity = {{speed, 0, 0}, {-speed, 0, 0}};
    const Grid grid = cube(4);
    SolidsVolume solids(grid, closed, sphere.volume(), 0);
    std::vector<Vec3> handed(2);
    const Motion<StokesDrag> motion(sphere, dt);
    const int steps = static_cast<int>(1.6 * r / speed / dt) + 20;
    Collision found;
    for (int s = 0; s < steps; ++s) {
        contacts.move(cloud, motion, around, solids, 0, Nothing{}, handed);
    }
    found.after_i = cloud.velocity[0];
    found.after_j = cloud.velocity[1];
    return found;
}

// Head-on in vacuum: v' = -e v, whatever the speed; momentum untouched.
TEST(SpringContacts, ReturnTheRestitutionOfTheirLaw) {
    for (const double e : {0.3, 0.6, 0.9, 1.0})
        for (const double speed : {0.01, 1.0}) {
            const auto found = collide(e, speed, 0, 0.3);
            EXPECT_NEAR(found.after_i[0], -e * speed, 5e-3 * speed) << e << ' ' << speed;
            EXPECT_NEAR(found.after_j[0], e * speed, 5e-3 * speed) << e << ' ' << speed;
            EXPECT_NEAR(found.after_i[0] + found.after_j[0], 0, 1e-9 * speed);
            EXPECT_NEAR(found.after_i[1], 0, 1e-12);
        }
}

// A grazing collision with friction turns both spheres the same way and keeps momentum and angular momentum.
TEST(SpringContacts, FrictionConservesAngularMomentum) {
    const Sphere sphere{4, 1e-4, 1e-9, 0, 1};
    const double r = sphere.radius();
    const Walls around = box(closed, r);
    SpringContacts contacts(sphere, around, {4.5 * sphere.volume() * 1e6, 0.7, 0.3}, 2);
    Cloud cloud;
    cloud.position = {{-1.2 * r, 0, 0}, {1.2 * r, r, 0}};
    cloud.velocity = {{1, 0, 0}, {-1, 0, 0}};
    const Grid grid = cube(4);
    SolidsVolume solids(grid, closed, sphere.volume(), 0);
    std::vector<Vec3> handed(2);
    const Motion<StokesDrag> motion(sphere, 1e-3);
    const double mass = 4.5 * sphere.volume();
    const double inertia = 0.4 * 4 * sphere.volume() * r * r;
    const auto angular = [&] {
        double sum = 0;
        for (std::size_t p = 0; p < 2; ++p)
            sum += mass * (cloud.position[p][0] * cloud.velocity[p][1] - cloud.position[p][1] * cloud.velocity[p][0]) +
                   inertia * contacts.spins()[p][2];
        return sum;
    };
    const double before = angular();
    const double speed_before = cloud.velocity[0][0];
    for (int s = 0; s < 120; ++s) contacts.move(cloud, motion, around, solids, 0, Nothing{}, handed);
    EXPECT_NE(cloud.velocity[0][0], speed_before);
    EXPECT_GT(std::abs(contacts.spins()[0][2]), 1);
    EXPECT_NEAR(contacts.spins()[0][2], contacts.spins()[1][2], 1e-9 * std::abs(contacts.spins()[0][2]));
    EXPECT_NEAR(cloud.velocity[0][1] + cloud.velocity[1][1], 0, 1e-12);
    // The contact point lies half an overlap inside both spheres, whose torques are taken at the radius: the error of
    // soft spheres, of the size overlap/diameter.
    EXPECT_NEAR(angular(), before, 0.02 * std::abs(before));
}

// Two walls slide past each other: what rests against one of them turns with half the vorticity, which the half of
// its neighbourhood that is fluid tells.
TEST(SpringContacts, TurnWithTheShearBesideAWall) {
    const Sphere sphere{3.49, 3.1e-4, 18, 1.09e6, 1};
    const double r = sphere.radius();
    const double shear = 40;
    flow::Sides sides = endless;
    sides[1] = {flow::NoSlip{{-0.5 * shear, 0, 0}}, flow::NoSlip{{0.5 * shear, 0, 0}}};
    const Grid grid = cube(8);
    const double dt = 1e-5;
    auto fluid = still_fluid(grid, sides, 18, dt);
    fluid.set_velocity([&](double, double y, double) { return Vec3{shear * y, 0, 0}; });
    const Walls around{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {true, false, true}, 0, 1};  // contact of the centre
    Cloud cloud;
    cloud.position = {{0, 0.5, 0}, {0.25, 0.5 - 0.4 * r, 0.25}};
    cloud.velocity = {{0.5 * shear, 0, 0}, {0.5 * shear, 0, 0}};
    const HystereticSpring smooth{SpringContacts::stiffness(sphere, 0.01, dt), 0.8, 0};
    Dense<SpringContacts> together(std::move(fluid), {}, Motion<SchillerNaumann>(sphere, dt), around, cloud,
                                   SpringContacts(sphere, around, smooth, 2), 0.1);
    for (int s = 0; s < 400; ++s) together.step();
    for (const Vec3& spin : together.interaction().spins()) EXPECT_NEAR(spin[2], -0.5 * shear, 0.03 * shear);
}

// Dense particles that vibrate against a wall rest on it with the overlap asked for, and the fluid does not feel the
// force that the wall takes.
TEST(SpringContacts, AParticlePressedToAWallRestsThere) {
    const Sphere sphere{3.49, 3.1e-4, 18, 1.09e8, 1};
    const double r = sphere.radius();
    const BoxCase setting{cube(6), closed, sphere, 1e-5, 1};
    Cloud cloud;
    cloud.position = {{0, 0.5 - 1.02 * r, 0}};
    cloud.velocity = {{}};
    auto together = setting.together<SpringContacts>({}, cloud);  // a steady force towards +y
    for (int s = 0; s < 400; ++s) together.step();
    const double overlap = together.cloud().position[0][1] - (0.5 - r);
    const double force = 2.49 * 1.09e8 * sphere.volume();
    EXPECT_GT(overlap, 0.99 * force / SpringContacts::stiffness(sphere, 0.01, setting.dt));
    EXPECT_LT(overlap, 0.0105 * 2 * r);
    EXPECT_NEAR(together.cloud().velocity[0][1], 0, 1e-3);
    const double fluid = observables::peak_velocity(setting.grid, together.fluid().velocity());
    // Released in the middle it drives the fluid for as long as it falls.
    cloud.position = {{0, -0.2, 0}};
    auto falling = setting.together<SpringContacts>({}, cloud);
    for (int s = 0; s < 20; ++s) falling.step();
    EXPECT_LT(fluid, 0.05 * observables::peak_velocity(setting.grid, falling.fluid().velocity()));
}

// Displacement instead of springs: not a part in 1e9 of the force reaches the fluid, whether the step is shorter or
// longer than the relaxation time.
TEST(ProjectedContacts, WhatRestsOnAWallGivesTheFluidNothing) {
    const Sphere sphere{3.49, 3.1e-4, 18, 1.09e8, 1};  // tau = 6.9e-5
    const double r = sphere.radius();
    for (const double dt : {5e-6, 1e-4}) {
        const BoxCase setting{cube(6), closed, sphere, dt, 2};
        Cloud cloud;
        cloud.position = {{0, 0.5 - 1.02 * r, 0}, {0.2, 0.5 - 1.5 * r, 0.2}};
        cloud.velocity = {{}, {}};
        auto together = setting.together<ProjectedContacts>({}, cloud);
        for (int s = 0; s < 0.05 / dt; ++s) together.step();  // until the fluid is at rest, too
        const double drive = together.budget().drive;
        EXPECT_NEAR(drive, 2 * 2.49 * 1.09e8 * sphere.volume(), 1e-9 * drive);
        EXPECT_LT(std::abs(together.budget().given), 1e-9 * drive) << dt;
    }
}

// A cloud pressed to a wall by a steady force: springs without friction and displacement end in the same layer, and
// neither leaves overlaps.
TEST(ProjectedContacts, PressACloudToAWallAsSpringsDo) {
    const Sphere sphere{3.49, 3.1e-4, 18, 1.09e6, 1};
    const double r = sphere.radius();
    const std::size_t particles = 60;
    BoxCase setting{cube(6), closed, sphere, 2e-4, particles};
    setting.friction = 0;
    const auto cloud = random_cloud(particles, box(closed, r), stats::Stream(6, 1));
    const auto pressed = [&]<class Interaction>(Interaction) {
        auto together = setting.together<Interaction>({}, cloud);
        for (int s = 0; s < 200; ++s) together.step();
        auto positions = together.cloud().position;
        double mean = 0;
        double overlap = 0;
        for (std::size_t p = 0; p < particles; ++p) {
            mean += positions[p][1] / static_cast<double>(particles);
            overlap = std::max(overlap, positions[p][1] - (0.5 - r));
            for (std::size_t q = 0; q < p; ++q) {
                double square = 0;
                for (std::size_t d = 0; d < 3; ++d) square += std::pow(positions[p][d] - positions[q][d], 2);
                overlap = std::max(overlap, 2 * r - std::sqrt(square));
            }
        }
        EXPECT_LT(overlap, 0.05 * 2 * r);
        return mean;
    };
    const double soft = pressed(setting.make<SpringContacts>());
    const double hard = pressed(setting.make<ProjectedContacts>());
    EXPECT_GT(hard, 0.5 - 3 * r);
    EXPECT_NEAR(soft, hard, 0.3 * r);
}

}  // namespace grainsweep::tests::coupling_contacts_test
