// Error of the restitution against the time step: contacts see the velocity of the half step, as in LIGGGHTS, so that
// damping is of first order. With the velocity extrapolated to the full step, v + a dt (Groot & Warren 1997, doi
// 10.1063/1.474784, lambda = 1), it is of second order. docs/tried_and_dropped.md has the figures and the decision.
#include "solver/dem/engine.hpp"
#include "solver/dem/material.hpp"
#include "tests/support/spheres.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::restitution_order_test {

constexpr double radius = 0.001, speed = 0.5;
constexpr int phases = 10;  // of the first contact within a step

dem::Setup impact(double restitution) {
    auto setup = tests::empty_space();
    setup.walls = {dem::Plane{{0, 0, 0}, {0, 0, 1}}};
    setup.material.restitution = restitution;
    setup.material.friction = 0;
    return setup;
}

/// Of an elastic impact on the plane, s (Johnson 1985, eq. 11.24).
double duration(const dem::Setup& setup) {
    const double m = tests::mass(setup, radius), modulus = dem::effective_modulus(setup.material);
    return 2.868 * std::pow(m * m / (radius * modulus * modulus * speed), 0.2);
}

/// Mean over the phases of rebound speed divided by impact speed.
double by_the_engine(double restitution, double step_share) {
    double sum = 0;
    for (int phase = 0; phase < phases; ++phase) {
        auto setup = impact(restitution);
        setup.time_step = step_share * duration(setup);
        setup.spheres = {
            {{0, 0, radius + speed * setup.time_step * (phase + 0.5) / phases}, {0, 0, -speed}, {}, radius, true}};
        const auto engine = dem::make_engine(setup, {});
        for (auto s = state_of(*engine); !(s.velocity[0][2] > 0 && s.position[0][2] >= radius);) {
            engine->run(1);
            s = state_of(*engine);
            if (s.velocity[0][2] > 0 && s.position[0][2] >= radius) sum += s.velocity[0][2] / speed / phases;
        }
    }
    return sum;
}

/// The same by the law written plainly (Tsuji et al. 1992; Antypov & Elliott 2011), at either velocity.
double plainly(double restitution, double step_share, bool full_step) {
    const auto setup = impact(restitution);
    const double m = tests::mass(setup, radius), modulus = dem::effective_modulus(setup.material);
    const double log_e = std::log(restitution);
    const double damping = -log_e / std::hypot(log_e, std::numbers::pi);
    const auto force = [&](double overlap, double closing) {
        if (!(overlap > 0)) return 0.0;
        const double root = std::sqrt(radius * overlap);
        return 4.0 / 3 * modulus * root * overlap +
               2 * std::sqrt(5.0 / 6) * damping * std::sqrt(2 * modulus * root * m) * closing;
    };
    const double dt = step_share * duration(setup);
    double sum = 0;
    for (int phase = 0; phase < phases; ++phase) {
        double overlap = -speed * dt * (phase + 0.5) / phases, closing = speed, f = 0;
        do {
            const double half = closing - f / m * dt / 2, full = closing - f / m * dt;
            overlap += half * dt;
            f = force(overlap, full_step ? full : half);
            closing = half - f / m * dt / 2;
        } while (overlap > 0 || closing > 0);
        sum -= closing / speed / phases;
    }
    return sum;
}

TEST(RestitutionOrder, IsOneByTheVelocityOfTheHalfStep) {
    for (const double share : {0.05, 0.02})
        EXPECT_NEAR(by_the_engine(0.1, share), plainly(0.1, share, false), 1e-9) << "the law of the engine";
    double half[2], full[2];
    for (const int k : {0, 1}) {
        const double share = k == 0 ? 0.04 : 0.01;
        half[k] = by_the_engine(0.1, share) - 0.1;
        full[k] = plainly(0.1, share, true) - 0.1;
    }
    EXPECT_LT(half[0], 0) << "the sphere rebounds too slowly";
    EXPECT_NEAR(half[0] / half[1], 4, 0.4);
    EXPECT_GT(full[0] / full[1], 8);
    EXPECT_LT(std::abs(full[0]), 0.2 * std::abs(half[0]));
}

}  // namespace grainsweep::tests::restitution_order_test
