// Single spheres against closed forms: impacts after Hertz and Coulomb, rolling, sliding on an incline, and the
// convergence order of the time integration. After Chung & Ooi (2011), Granular Matter 13, 643.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::dem_closed_forms_test {

constexpr double radius = 0.001;

/// A sphere about to hit the plane z = 0.
dem::Setup above_plane(const dem::Vec3& velocity, const dem::Vec3& spin = {}) {
    auto setup = tests::empty_space();
    setup.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
    setup.spheres = {{{0, 0, radius + 1e-9}, velocity, spin, radius, true}};
    return setup;
}

struct Rebound {
    dem::Vec3 velocity{}, spin{};
    double duration = 0, deepest = 0;
};

/// Until the first sphere has left the plane again.
Rebound rebound(const dem::Setup& setup) {
    const auto engine = dem::make_engine(setup, {});
    Rebound r;
    for (;;) {
        engine->run(1);
        EXPECT_EQ(engine->fault(), "");
        const auto s = state_of(*engine);
        const double overlap = radius - s.position[0][2];
        r.deepest = std::max(r.deepest, overlap);
        if (overlap > 0) r.duration += setup.time_step;
        if (overlap <= 0 && s.velocity[0][2] > 0) return {s.velocity[0], s.angular_velocity[0], r.duration, r.deepest};
    }
}

// Elastic impact on a plane: duration 2.868 (m^2/(R E*^2 v))^(1/5), depth (15 m v^2/(16 sqrt(R) E*))^(2/5). The step
// resolves the contact into 2000, so the duration is known to one part in a thousand.
TEST(DemClosedForms, ElasticImpactLastsAndYieldsAsHertzSays) {
    for (const double v : {0.1, 1.0}) {
        auto setup = above_plane({0, 0, -v});
        setup.material.restitution = 1;
        setup.material.friction = 0;
        const double m = tests::mass(setup, radius);
        const double modulus = dem::effective_modulus(setup.material);
        const double duration = 2.868 * std::pow(m * m / (radius * modulus * modulus * v), 0.2);
        // The library's limit is that of two equal spheres: 2^(1/5) shorter.
        EXPECT_NEAR(dem::hertz_contact_time(setup.material, radius, v) * std::pow(2, 0.2) / duration, 1, 1e-12);
        setup.time_step = duration / 2000;
        const auto r = rebound(setup);
        EXPECT_NEAR(r.duration / duration, 1, 1e-3);
        EXPECT_NEAR(r.deepest / std::pow(15 * m * v * v / (16 * std::sqrt(radius) * modulus), 0.4), 1, 1e-5);
        EXPECT_NEAR(r.velocity[2] / v, 1, 1e-5);
    }
}

// The damping makes the restitution independent of speed and equal to its nominal value.
TEST(DemClosedForms, RestitutionIsTheOneAskedFor) {
    for (const double e : {0.2, 0.4, 0.6, 0.8, 0.95, 1.0})
        for (const double v : {0.05, 1.0}) {
            auto setup = above_plane({0, 0, -v});
            setup.material.restitution = e;
            setup.time_step = 2e-7;
            EXPECT_NEAR(rebound(setup).velocity[2] / v, e, 4e-3) << "e " << e << " v " << v;
        }
}

// Gross sliding: v_t' = v_t - mu (1 + e) v_n, R w' = R w - 5/2 mu (1 + e) v_n, with slip v_t + R w at the contact. The
// sphere sticks for the first few steps and the arm is R - d/2, d/R about 0.03: half a per cent of the change.
TEST(DemClosedForms, ObliqueImpactSlidesAsCoulombSays) {
    const double mu = 0.2;
    const double vn = 0.5;
    for (const double vt : {2.0, 4.0})
        for (const double rw : {0.0, 1.0}) {
            auto setup = above_plane({vt, 0, -vn}, {0, -rw / radius, 0});
            setup.material.youngs_modulus = 21e9;
            setup.material.restitution = 1;
            setup.material.friction = mu;
            setup.time_step = 1e-8;
            const auto r = rebound(setup);
            const double change = mu * 2 * vn;
            EXPECT_NEAR((vt - r.velocity[0]) / change, 1, 5e-3) << vt << " " << rw;
            EXPECT_NEAR((rw + r.spin[1] * radius) / (2.5 * change), 1, 5e-3) << vt << " " << rw;
        }
}

// Two equal spheres exchange their normal velocities; the pair obeys the same sliding law with half the slip change.
TEST(DemClosedForms, SpinningPairSlidesAsCoulombSays) {
    auto setup = tests::empty_space();
    setup.material.youngs_modulus = 21e9;
    setup.material.restitution = 1;
    setup.time_step = 1e-8;
    const double rw = 3;
    setup.spheres = {{{-radius - 1e-9, 0, 0}, {0.5, 0, 0}, {0, 0, rw / radius}, radius, true},
                     {{radius + 1e-9, 0, 0}, {-0.5, 0, 0}, {0, 0, rw / radius}, radius, true}};
    const auto engine = dem::make_engine(setup, {});
    engine->run(2000);
    const auto s = state_of(*engine);
    EXPECT_NEAR(s.velocity[0][0], -0.5, 1e-3);  // the normal turns by half a milliradian meanwhile
    // J = mu (1 + e) m* v_n = mu 2 (m/2) 1: each gains mu v_n sideways and loses 5/2 of it in R w.
    EXPECT_NEAR(s.velocity[0][1] / -0.2, 1, 5e-3);
    EXPECT_NEAR(s.velocity[1][1] / 0.2, 1, 5e-3);
    EXPECT_NEAR((rw - s.angular_velocity[0][2] * radius) / (2.5 * 0.2), 1, 5e-3);
}

// A sphere thrown flat ends rolling. With the arm a = R - d/2 of this law: v'/v = q/(1 + q), q = 5/2 (a/R)^2; 5/7 for a
// = R.
TEST(DemClosedForms, ThrownSphereEndsRollingAtFiveSevenths) {
    auto setup = above_plane({0.1, 0, 0});
    setup.gravity = {0, 0, -9.81};
    setup.material.youngs_modulus = 1e8;
    const double m = tests::mass(setup, radius);
    const double overlap =
        std::pow(0.75 * m * 9.81 / (dem::effective_modulus(setup.material) * std::sqrt(radius)), 2.0 / 3.0);
    setup.spheres[0].position[2] = radius - overlap;
    setup.time_step = 2e-6;
    const auto engine = dem::make_engine(setup, {});
    engine->run(60000);  // sliding ends after 2 v/(7 mu g) = 15 ms
    const auto s = state_of(*engine);
    const double arm = 1 - overlap / (2 * radius);
    const double q = 2.5 * arm * arm;
    EXPECT_NEAR(s.velocity[0][0] / 0.1, q / (1 + q), 1e-6);
    EXPECT_NEAR(s.velocity[0][0] / 0.1, 5.0 / 7.0, 1e-3);
    EXPECT_NEAR(s.angular_velocity[0][1] * radius * arm / s.velocity[0][0], 1, 1e-6);
}

// On an incline a sphere rolls with 5/7 g sin(a) while tan(a) < 7 mu/2, and slides with g (sin(a) - mu cos(a)) beyond.
TEST(DemClosedForms, SphereOnAnInclineRollsUntilSevenHalvesOfFriction) {
    const double mu = 0.2;
    for (const double share : {0.5, 0.95, 1.05, 1.5}) {
        const double angle = std::atan(share * 3.5 * mu);
        auto setup = above_plane({});
        setup.gravity = {9.81 * std::sin(angle), 0, -9.81 * std::cos(angle)};
        setup.material.youngs_modulus = 1e8;
        setup.material.friction = mu;
        const double overlap = std::pow(0.75 * tests::mass(setup, radius) * 9.81 * std::cos(angle) /
                                            (dem::effective_modulus(setup.material) * std::sqrt(radius)),
                                        2.0 / 3.0);
        setup.spheres[0].position[2] = radius - overlap;
        setup.time_step = 2e-6;
        const auto engine = dem::make_engine(setup, {});
        engine->run(10000);
        const double v0 = state_of(*engine).velocity[0][0];
        engine->run(20000);
        const double acceleration = (state_of(*engine).velocity[0][0] - v0) / (20000 * setup.time_step);
        const double rolling = 5.0 / 7.0 * 9.81 * std::sin(angle);
        const double sliding = 9.81 * (std::sin(angle) - mu * std::cos(angle));
        EXPECT_NEAR(acceleration / (share < 1 ? rolling : sliding), 1, 1e-3) << share;
    }
}

// Velocity Verlet is of second order where the force is smooth: inside an elastic contact, half a swing from an
// overlap.
TEST(DemClosedForms, IntegrationIsOfSecondOrder) {
    const auto position_after = [](std::int64_t steps) {
        auto setup = tests::empty_space();
        setup.material.restitution = 1;
        setup.material.friction = 0;
        setup.spheres = {{{-0.00098, 0, 0}, {0.2, 0, 0}, {}, radius, true},
                         {{0.00098, 0, 0}, {-0.2, 0, 0}, {}, radius, true}};
        setup.time_step = 6e-5 / static_cast<double>(steps);
        const auto engine = dem::make_engine(setup, {});
        engine->run(steps);
        EXPECT_GT(engine->largest_overlap(), 0.01);
        return state_of(*engine).position[0][0];
    };
    const double exact = position_after(1 << 16);
    double last = 0;
    for (const std::int64_t steps : {32, 64, 128, 256}) {
        const double error = std::abs(position_after(steps) - exact);
        if (last > 0) {
            EXPECT_NEAR(std::log2(last / error), 2, 0.05) << steps;
        }
        last = error;
    }
}

}  // namespace grainsweep::tests::dem_closed_forms_test
