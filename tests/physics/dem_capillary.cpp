// Liquid bridges (solver/dem/laws/capillary.hpp) against closed forms, in both
// engines.
#include "solver/dem/engine.hpp"
#include "solver/dem/laws/compiled.hpp"
#include "solver/dem/material.hpp"
#include "solver/geometry/vector.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/plain_dem.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::tests::dem_capillary_test {

using dem::CohesionLaw;
using dem::Method;
using dem::Partner;
using dem::Vec3;
using std::numbers::pi;

constexpr double radius = 1e-3, tension = 0.072, angle = 0.3, share = 0.005;
constexpr double volume_of_sphere = 4.0 / 3 * pi * radius * radius * radius;

/// Millimetre glass spheres, softened and wet.
dem::Material wet() {
    dem::Material m;
    m.youngs_modulus = 5e6;
    m.poisson_ratio = 0.25;
    m.density = 2500;
    m.restitution = 1;
    m.friction = 0;
    m.cohesion_law = CohesionLaw::capillary;
    m.surface_tension = tension;
    m.contact_angle = angle;
    m.bridge_volume = share;
    return m;
}

constexpr Method::Precision both[] = {Method::Precision::double_precision, Method::Precision::mixed};

/// Willett's closed form in its own words: radius of Derjaguin, volume, gap.
double force(double derjaguin, double volume, double gap) {
    const double x = gap * std::sqrt(derjaguin / volume);
    return 2 * pi * derjaguin * tension * std::cos(angle) / (1 + 1.05 * x + 2.5 * x * x);
}
double rupture(double volume) {
    return (1 + angle / 2) * std::cbrt(volume);
}
/// The work of pulling a bridge apart, by Simpson's rule.
double work(double derjaguin, double volume) {
    constexpr int parts = 2000;
    const double end = rupture(volume), h = end / parts;
    double sum = 0;
    for (int k = 0; k <= parts; ++k)
        sum += (k == 0 || k == parts ? 1 : k % 2 == 0 ? 2 : 4) * force(derjaguin, volume, k * h);
    return sum * h / 3;
}

template <Partner partner>
dem::Touch<partner> touch(double effective, double overlap) {
    dem::Touch<partner> t;
    t.effective_radius = effective;
    t.overlap = overlap;
    t.root = std::sqrt(effective * std::max(overlap, 0.0));
    t.reduced_mass = 1e-5;
    t.normal = {1, 0, 0};
    return t;
}

using Wet = dem::Contact<double, dem::Hertz, dem::Capillary>;

// Unequal spheres by the radius 2 R1 R2/(R1 + R2), a wall by 2 R with the
// volume of its sphere.
TEST(Capillary, HasWillettsForceAndLiansRupture) {
    const auto m = wet();
    const auto contact = Wet::of(m);
    const auto check = [&]<Partner partner>(double effective, double volume) {
        const double end = rupture(volume), derjaguin = 2 * effective;
        for (const double part : {0.0, 0.1, 0.5, 0.9, 0.999}) {
            auto t = touch<partner>(effective, -part * end);
            double bridge = 1;
            contact.begin(t, &bridge);
            ASSERT_EQ(t.touching, true) << part;
            EXPECT_NEAR(contact.template respond<true>(t, &bridge).normal / -force(derjaguin, volume, part * end), 1,
                        1e-12);
            EXPECT_EQ(bridge, 1);
        }
        auto beyond = touch<partner>(effective, -1.0001 * end), near = touch<partner>(effective, -1e-12);
        const double bridge = 1, none = 0;
        contact.begin(beyond, &bridge), contact.begin(near, &none);
        EXPECT_FALSE(beyond.touching) << "it breaks";
        EXPECT_FALSE(near.touching) << "it forms at touch only";
        auto pressed = touch<partner>(effective, 1e-6);
        contact.begin(pressed, &none);
        EXPECT_TRUE(pressed.touching);
        EXPECT_LE(end, Wet::beyond(m, effective) * (1 + 1e-12)) << "lists reach as far";
        // The energy is minus the work that is left.
        auto at = touch<partner>(effective, 0);
        EXPECT_NEAR(contact.energy(at, &bridge) / -work(derjaguin, volume), 1, 1e-9);
        auto at_end = touch<partner>(effective, -end);
        EXPECT_NEAR(contact.energy(at_end, &bridge) / work(derjaguin, volume), 0, 1e-12);
    };
    check.operator()<Partner::particle>(radius / 2, share * volume_of_sphere);
    const double other = 0.4 * radius, effective = radius * other / (radius + other);
    check.operator()<Partner::particle>(effective, share * volume_of_sphere * std::pow(2 * effective / radius, 3));
    check.operator()<Partner::wall>(radius, share * volume_of_sphere);
}

dem::Setup two(double speed, bool at_wall) {
    dem::Setup s;
    s.domain = {{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, {}};
    s.gravity = {};
    s.material = wet();
    s.time_step = 2e-6;
    s.spheres = {{{0, 0, 1e-5 + radius}, {0, 0, -speed}, {}, radius, true}};
    if (at_wall)
        s.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 1}});
    else
        s.spheres.push_back({{0, 0, -radius}, {}, {}, radius, false});
    return s;
}

// Without damping an impact loses the work of the bridge, and slower ones
// stick. On the way the force is the closed form at every gap, none before
// touch, and the contact ends at the rupture distance.
TEST(Capillary, AnImpactLosesTheWorkOfTheBridge) {
    const double mass = dem::sphere_mass(radius, 2500);
    for (const auto precision : both)
        for (const bool at_wall : {false, true}) {
            const double derjaguin = at_wall ? 2 * radius : radius, volume = share * volume_of_sphere;
            const double escape = std::sqrt(2 * work(derjaguin, volume) / mass);
            for (const double ratio : {0.95, 1.05, 2.0}) {
                const auto engine = dem::make_engine(two(ratio * escape, at_wall), method(precision));
                bool met = false, broken = false;
                double widest = 0;
                std::vector<dem::ContactForce> contacts;
                for (int k = 0; k < 20000 && !broken; ++k) {
                    engine->run(1);
                    engine->contacts(contacts);
                    broken = met && contacts.empty();
                    for (const auto& c : contacts) {
                        met = true;
                        if (c.overlap > 0) continue;
                        widest = std::max(widest, -c.overlap);
                        EXPECT_NEAR(c.normal_force / -force(derjaguin, volume, -c.overlap), 1, 1e-5);
                    }
                }
                ASSERT_EQ(engine->fault(), "");
                ASSERT_TRUE(met);
                EXPECT_EQ(broken, ratio > 1) << ratio;
                if (ratio < 1) continue;
                const double speed = tests::state_of(*engine).velocity[0][2];
                EXPECT_NEAR(speed / (ratio * escape), std::sqrt(1 - 1 / (ratio * ratio)), 5e-3) << ratio << at_wall;
                EXPECT_NEAR(widest / rupture(volume), 1, 2 * ratio * escape * 2e-6 / rupture(volume) + 1e-5);
            }
        }
}

// A sphere hangs from a wall by its bridge: below the force at touch it rests where Hertz's force makes up the
// difference, above it falls.
TEST(Capillary, HoldsUpToItsForceAtTouch) {
    for (const auto precision : both)
        for (const double load : {0.99, 1.01}) {
            dem::Setup s = two(0, true);
            const double at_touch = force(2 * radius, share * volume_of_sphere, 0);
            const double left = std::max(1 - load, 0.0) * at_touch, modulus = dem::effective_modulus(s.material);
            const double overlap = std::pow(0.75 * left / (modulus * std::sqrt(radius)), 2.0 / 3) + 1e-10;
            s.spheres[0].position[2] = radius - overlap;
            s.gravity = {0, 0, load * at_touch / dem::sphere_mass(radius, 2500)};
            const auto engine = dem::make_engine(s, method(precision));
            engine->run(20000);
            ASSERT_EQ(engine->fault(), "");
            EXPECT_EQ(engine->size(), load < 1 ? 1U : 0U) << "what falls leaves the domain";
            if (load > 1) continue;
            EXPECT_NEAR(tests::state_of(*engine).position[0][2], radius - overlap, 0.01 * overlap);
        }
}

dem::Setup wet_lattice(dem::RollingLaw rolling, dem::FrictionLimit limit, double spread) {
    dem::Setup s = tests::boxed_lattice(4, 1, spread, 15);
    s.material.cohesion_law = CohesionLaw::capillary;
    s.material.surface_tension = 2;
    s.material.contact_angle = 0.2;
    s.material.bridge_volume = 0.01;
    s.material.rolling_friction = spread > 0 ? 0.1 : 0;
    s.material.rolling_law = rolling;
    s.material.friction_limit = limit;
    return s;
}

// The clear engine against the law written down plainly, through rebuilds of
// lists, at walls, with friction and both rolling laws; and both engines go on
// bit for bit from what they save among bridges.
TEST(Capillary, ManySpheresAsPlainly) {
    for (const auto rolling : {dem::RollingLaw::epsd, dem::RollingLaw::cdt})
        for (const auto limit : {dem::FrictionLimit::contact, dem::FrictionLimit::net}) {
            const dem::Setup s = wet_lattice(rolling, limit, 0.25);
            tests::PlainDem plain(s);
            plain.run(400);
            const auto engine = dem::make_engine(s, {});
            bool bridged = false;
            std::vector<dem::ContactForce> contacts;
            for (int k = 0; k < 20; ++k) {
                engine->run(20);
                engine->contacts(contacts);
                bridged = bridged || std::ranges::any_of(contacts, [](const auto& c) { return c.overlap < 0; });
            }
            ASSERT_EQ(engine->fault(), "");
            EXPECT_TRUE(bridged);
            const auto state = tests::state_of(*engine);
            double worst = 0;
            for (std::size_t k = 0; k < state.id.size(); ++k)
                for (std::size_t a = 0; a < 3; ++a)
                    worst = std::max(worst, std::abs(state.position[k][a] -
                                                     plain.position()[static_cast<std::size_t>(state.id[k])][a]));
            EXPECT_LT(worst, 1e-10 * 2e-3) << static_cast<int>(rolling) << static_cast<int>(limit);
        }
}

TEST(Capillary, GoesOnFromWhatItSavesBitForBit) {
    for (const auto precision : both)
        for (const int threads : {1, 2}) {
            const dem::Setup s = wet_lattice(dem::RollingLaw::epsd, dem::FrictionLimit::contact, 0.25);
            const auto engine = dem::make_engine(s, method(precision));
            engine->run(700);
            std::vector<std::byte> saved;
            engine->save(saved);
            engine->run(500);
            ASSERT_EQ(engine->fault(), "");
            const auto again = dem::make_engine(s, method(precision));
            again->set_threads(threads);
            again->restore(saved);
            again->run(500);
            EXPECT_EQ(tests::state_of(*again).position, tests::state_of(*engine).position);
            EXPECT_EQ(tests::state_of(*again).velocity, tests::state_of(*engine).velocity);
        }
}

// Bridges form and break for thousands of steps: what they hold is accounted
// for, and momentum stays.
TEST(Capillary, TheEngineFindsNoEnergyFromNowhere) {
    for (const auto precision : both) {
        dem::Setup s = tests::thrown_lattice(5, 0.3, 0.25, 16);
        s.material.cohesion_law = CohesionLaw::capillary;
        s.material.surface_tension = 2;
        s.material.restitution = 1;
        s.material.friction = 0;
        const auto engine = dem::make_engine(s, method(precision));
        engine->run(4000);
        EXPECT_EQ(engine->fault(), "");
    }
}

TEST(Capillary, RefusesWhatNoBridgeIs) {
    const auto refused = [](auto&& change) {
        dem::Setup s = two(0.1, true);
        change(s.material);
        EXPECT_THROW((void)dem::make_engine(s, {}), std::invalid_argument);
    };
    refused([](dem::Material& m) { m.surface_tension = -1; });
    refused([](dem::Material& m) { m.contact_angle = 1.6; });
    refused([](dem::Material& m) { m.bridge_volume = 0; });
    refused([](dem::Material& m) { m.bridge_volume = 0.04; });
    refused([](dem::Material& m) { m.normal_law = dem::NormalLaw::linear, m.stiffness = 1e3; });
    dem::Setup narrow = two(0.1, false);
    narrow.domain.periodic[0] = true;
    narrow.domain.low[0] = -0.00205, narrow.domain.high[0] = 0.00205;
    for (const auto precision : both)
        EXPECT_THROW((void)dem::make_engine(narrow, method(precision)), std::invalid_argument) << "a period too short";
}

}  // namespace grainsweep::tests::dem_capillary_test
