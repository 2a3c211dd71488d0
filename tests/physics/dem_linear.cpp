// The linear spring and dashpot against closed forms, in both engines.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/dem/kinds.hpp"
#include "solver/dem/time_step.hpp"
#include "tests/support/granular_scenes.hpp"
#include "tests/support/moving_walls.hpp"
#include "tests/support/spheres.hpp"

namespace grainsweep::tests::dem_linear_test {

using namespace geometry;
using dem::Method;
using std::numbers::pi;

constexpr double radius = sphere_at_walls;
constexpr Method engines[] = {{Method::Precision::double_precision}, {Method::Precision::mixed}};

/// A sphere about to hit the plane z = 0, at a step of 1/2000 of the elastic impact.
dem::Setup above_plane(const Vec3& velocity, double stiffness = 1e4) {
    dem::Setup s = one_sphere({0, 0, radius * (1 + 1e-6)}, velocity, {dem::Plane{}});
    s.material.normal_law = dem::NormalLaw::linear;
    s.material.stiffness = stiffness;
    s.time_step = pi * std::sqrt(mass(s, radius) / stiffness) / 2000;
    return s;
}

struct Rebound {
    Vec3 velocity{}, spin{};
    double duration = 0;
};

/// Until the first sphere has parted from whatever it touches.
Rebound rebound(const dem::Setup& setup, const Method& method) {
    const auto engine = dem::make_engine(setup, method);
    std::vector<dem::ContactForce> contacts;
    int touching = 0;
    for (int step = 0; step < 40000; ++step) {
        engine->run(1);
        engine->contacts(contacts);
        if (contacts.empty() && touching > 0) break;
        touching += contacts.empty() ? 0 : 1;
    }
    EXPECT_EQ(engine->fault(), "");
    const dem::State s = state_of(*engine);
    return {s.velocity[0], s.angular_velocity[0], touching * setup.time_step};
}

double damping(double e) {
    return -std::log(e) / std::hypot(pi, std::log(e));
}

// t_c = pi/(w sqrt(1 - z^2)), e = exp(-pi z/sqrt(1 - z^2)), whatever the speed.
TEST(DemLinear, ImpactsLastAndReboundAsTheOscillatorDoes) {
    for (const Method& method : engines)
        for (const double e : {0.1, 0.3, 0.5, 0.9, 1.0})
            for (const double v : {0.02, 0.2, 2.0}) {
                dem::Setup s = above_plane({0, 0, -v});
                s.material.restitution = e;
                const double z = damping(e), elastic = pi * std::sqrt(mass(s, radius) / s.material.stiffness);
                const auto r = rebound(s, method);
                EXPECT_NEAR(r.velocity[2] / v, e, 2e-3) << e << " " << v;
                EXPECT_NEAR(r.duration / (elastic / std::sqrt(1 - z * z)), 1, 2e-3) << e << " " << v;
            }
}

TEST(DemLinear, PairsHaveTheirReducedMass) {
    for (const Method& method : engines)
        for (const double ratio : {1.0, 0.4}) {
            dem::Setup s = above_plane({0.1, 0, 0});
            s.walls.clear();
            const double other = ratio * radius;
            s.spheres[0].position = {};
            s.spheres.push_back({{(radius + other) * (1 + 1e-6), 0, 0}, {-0.1, 0, 0}, {}, other, true});
            const double m = mass(s, radius), n = mass(s, other), reduced = m * n / (m + n);
            s.material.restitution = 0.6;
            const double z = damping(0.6), elastic = pi * std::sqrt(reduced / s.material.stiffness);
            const double of_equal = dem::linear_contact_time(s.material, radius) * std::sqrt(2 * reduced / m);
            EXPECT_NEAR(of_equal / elastic, 1, 1e-12);
            EXPECT_EQ(dem::shortest_time(s.material, radius, 1), 0.25 * dem::linear_contact_time(s.material, radius));
            s.time_step = elastic / 2000;
            const auto r = rebound(s, method);
            EXPECT_NEAR(r.duration / (elastic / std::sqrt(1 - z * z)), 1, 2e-3);
            EXPECT_NEAR(r.velocity[0], 0.1 - reduced / m * 1.6 * 0.2, 4e-4);
        }
}

/// Of the contact, and energy over the mass.
double slip(const Vec3& v, const Vec3& spin) {
    return v[0] - radius * spin[1];
}
double energy(const Vec3& v, const Vec3& spin) {
    return 0.5 * dot(v, v) + 0.2 * radius * radius * dot(spin, spin);
}

// The slip oscillates with sqrt(7/2 k_t/m): after the elastic impact it is cos(pi sqrt(7/2 r)) of what it was. At r =
// 2/7 it has turned round, and nothing is lost.
TEST(DemLinear, TheTangentialSpringSwingsAtItsFrequency) {
    for (const Method& method : engines)
        for (const double r : {0.05, 0.15, 2.0 / 7, 0.5, 1.0}) {
            dem::Setup s = above_plane({0.3, 0, -0.5}, 1e7);
            s.spheres[0].angular_velocity = {0, 100, 0};
            s.material.restitution = 1;
            s.material.friction = 1e5;
            s.material.tangential_ratio = r;
            const Vec3 v = s.spheres[0].velocity, spin = s.spheres[0].angular_velocity;
            const auto after = rebound(s, method);
            EXPECT_NEAR(slip(after.velocity, after.spin) / slip(v, spin), std::cos(pi * std::sqrt(3.5 * r)), 1e-2) << r;
            EXPECT_NEAR(v[0] - after.velocity[0], 2.0 / 7 * (slip(v, spin) - slip(after.velocity, after.spin)), 1e-3);
            EXPECT_NEAR(after.velocity[2], 0.5, 1e-4);
            if (r == 2.0 / 7)
                EXPECT_NEAR(energy(after.velocity, after.spin) / energy(v, spin), 1, 2e-3);
            else
                EXPECT_LT(energy(after.velocity, after.spin), 1.001 * energy(v, spin)) << "what the spring holds";
        }
}

// With both ratios 2/7 the slip rebounds with the normal restitution; another damper damps otherwise.
TEST(DemLinear, TheTangentialDamperIsAShareOfTheNormalOne) {
    for (const Method& method : engines)
        for (const double e : {0.4, 0.8}) {
            dem::Setup s = above_plane({0.1, 0, -0.5}, 1e7);
            s.material.restitution = e;
            s.material.friction = 1e6;  // for the dampers alone: also while the normal force attracts
            s.material.tangential_limit = dem::TangentialLimit::spring;
            const auto slip_after = [&] {
                const auto r = rebound(s, method);
                return slip(r.velocity, r.spin) / 0.1;
            };
            EXPECT_NEAR(slip_after(), -e, 1e-2);
            // z_t = q/r z at the undamped frequency of the normal spring
            s.material.tangential_damping = 0.0;
            const double z = damping(e), phase = pi / std::sqrt(1 - z * z);
            EXPECT_NEAR(slip_after(), std::cos(phase), 1e-2);
        }
}

// v_t' = v_t - 2 mu v_n, R w' = 5/2 of it.
TEST(DemLinear, SlidingEndsAtCoulombsLimit) {
    for (const Method& method : engines) {
        dem::Setup s = above_plane({2, 0, -0.5}, 1e7);
        s.material.restitution = 1;
        s.material.friction = 0.2;
        const auto r = rebound(s, method);
        EXPECT_NEAR((2 - r.velocity[0]) / 0.2, 1, 5e-3);
        EXPECT_NEAR(radius * r.spin[1] / 0.5, 1, 5e-3);
    }
}

// Every pair of kinds, and every wall with every kind, has its own spring.
TEST(DemLinear, EveryPairHasItsStiffness) {
    for (const Method& method : engines) {
        dem::Setup s = above_plane({0, 0, -0.1});
        const auto with = [&](double stiffness) {
            dem::Material m = s.material;
            m.restitution = 1;
            m.stiffness = stiffness;
            return m;
        };
        s.kinds = {{2500, 5000}, {with(2e4), with(3e3), with(5e4)}};
        s.walls[0].materials = {with(8e3), with(1e4)};
        const double light = dem::sphere_mass(radius, 2500), heavy = 2 * light;
        for (const int kind : {0, 1}) {
            s.spheres[0].kind = static_cast<std::uint8_t>(kind);
            const double elastic = pi * std::sqrt((kind == 0 ? light : heavy) / (kind == 0 ? 8e3 : 1e4));
            s.time_step = elastic / 2000;
            EXPECT_NEAR(rebound(s, method).duration / elastic, 1, 2e-3) << kind;
        }
        s.spheres[0].kind = 0;
        s.spheres[0].position[2] = 10 * radius;
        s.spheres.push_back({{0, 0, (8 - 1e-6) * radius}, {}, {}, radius, true, 1});
        const double elastic = pi * std::sqrt(light * heavy / (light + heavy) / 3e3);
        s.time_step = elastic / 2000;
        EXPECT_NEAR(rebound(s, method).duration / elastic, 1, 2e-3);
    }
}

// sjkr2 takes 2 pi k R off the spring.
TEST(DemLinear, CohesionByAreaSoftensTheSpring) {
    for (const Method& method : engines) {
        dem::Setup s = above_plane({0, 0, -0.1});
        s.material.restitution = 1;
        s.material.cohesion = 5e5;
        s.material.cohesion_law = dem::CohesionLaw::sjkr2;
        const double softened = s.material.stiffness - 2 * pi * radius * s.material.cohesion;
        const auto r = rebound(s, method);
        EXPECT_NEAR(r.duration / (pi * std::sqrt(mass(s, radius) / softened)), 1, 2e-3);
        EXPECT_NEAR(r.velocity[2], 0.1, 1e-4);
    }
}

// Every combination of laws that is compiled with it, spheres of one size and of many.
TEST(DemLinear, BothEnginesComputeTheSame) {
    const auto compare = [](double spread, const char* name, void (*change)(dem::Material&)) {
        SCOPED_TRACE(name);
        dem::Setup s = boxed_lattice(4, 0.3, spread, 7);
        s.material.normal_law = dem::NormalLaw::linear;
        s.material.stiffness = 2000;
        s.time_step = 4e-6;
        change(s.material);
        const auto clear = dem::make_engine(s, engines[0]), mixed = dem::make_engine(s, engines[1]);
        clear->run(250), mixed->run(250);
        EXPECT_EQ(clear->fault() + mixed->fault(), "");
        EXPECT_GT(clear->peak_overlap(), 1e-3);
        const dem::State a = state_of(*clear), b = state_of(*mixed);
        EXPECT_LT(position_difference(a, b, s.domain, 1e-3), 2e-5);
        EXPECT_LT(velocity_difference(a, b), 2e-4);
    };
    for (const double spread : {0.0, 0.3}) {
        compare(spread, "friction", [](auto&) {});
        compare(spread, "frictionless", [](auto& m) { m.friction = 0; });
        compare(spread, "sjkr", [](auto& m) { m.cohesion = 1e5; });
        compare(spread, "epsd", [](auto& m) { m.rolling_friction = 0.2; });
        compare(spread, "cdt, sjkr2", [](auto& m) {
            m.rolling_friction = 0.2, m.rolling_law = dem::RollingLaw::cdt;
            m.cohesion = 1e5, m.cohesion_law = dem::CohesionLaw::sjkr2;
        });
    }
}

TEST(DemLinear, AStepThatDoesNotResolveItIsReported) {
    for (const Method& method : engines)
        for (const double phase : {0.9, 1.1}) {
            dem::Setup s = above_plane({0, 0, -0.1});
            s.material.restitution = 1;
            s.time_step = phase * std::sqrt(mass(s, radius) / s.material.stiffness);
            const auto engine = dem::make_engine(s, method);
            engine->run(3);
            EXPECT_EQ(engine->fault().empty(), phase < 1) << engine->fault();
            const bool named = engine->fault().find("the time step is too l") != std::string::npos;
            EXPECT_EQ(named, phase > 1);
        }
}

TEST(DemLinear, WhatDoesNotGoTogetherIsRefused) {
    const auto refused = [](auto&& change) {
        dem::Setup s = above_plane({});
        change(s);
        EXPECT_THROW(dem::require_possible(s), std::invalid_argument);
    };
    refused([](dem::Setup& s) { s.material.stiffness = 0; });
    refused([](dem::Setup& s) { s.material.tangential_ratio = 0; });
    refused([](dem::Setup& s) { s.material.tangential_ratio = 1.1; });
    refused([](dem::Setup& s) { s.material.tangential_damping = -1; });
    for (const auto law : {dem::CohesionLaw::jkr, dem::CohesionLaw::dmt})
        refused([law](dem::Setup& s) { s.material.cohesion_law = law, s.material.surface_energy = 0.1; });
    refused([](dem::Setup& s) {
        dem::Material hertz;
        s.kinds = {{2500, 2500}, {s.material, hertz, s.material}};
        s.walls[0].materials = {s.material, s.material};
    });
    refused([](dem::Setup& s) {
        s.kinds = {{2500}, {s.material}};
        s.walls[0].materials = {dem::Material{}};
    });
    EXPECT_NO_THROW(dem::require_possible(above_plane({})));
}

}  // namespace grainsweep::tests::dem_linear_test
