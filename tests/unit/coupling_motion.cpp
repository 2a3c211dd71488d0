#include "solver/coupling/drag.hpp"
#include "solver/coupling/motion.hpp"
#include "solver/coupling/walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace grainsweep::tests::coupling_motion_test {

using namespace coupling;

constexpr double pi = 3.14159265358979323846;

// Amplitude and phase of the particle's motion over the fluid's, fluid u = U cos(Omega t), from the positions of the
// last period. (For dt >> tau the stored velocity is that of the middle of the step; positions are what counts.)
std::complex<double> response(double eps, double xi, int steps_per_period, int periods) {
    const double frequency = 100;
    const double prandtl = 2;
    const Sphere sphere{xi, eps * prandtl / frequency, prandtl, 0, 1};
    const double dt = 2 * pi / frequency / steps_per_period;
    const Motion<StokesDrag> motion(sphere, dt);
    Vec3 x{};
    Vec3 v{};
    std::complex<double> sum = 0;
    for (int n = 0; n < periods * steps_per_period; ++n) {
        // The fluid as a flow would hand it over: averages and differences of time levels.
        const double before = std::cos(frequency * n * dt);
        const double after = std::cos(frequency * (n + 1) * dt);
        motion.advance(x, v, {{0, 0.5 * (before + after), 0}, {0, (after - before) / dt, 0}, 0, {}});
        if (n >= (periods - 1) * steps_per_period)
            sum += x[1] * std::exp(std::complex<double>(0, -frequency * (n + 1) * dt)) * 2.0 / double(steps_per_period);
    }
    return sum * std::complex<double>(0, frequency);
}

// V_p/U = (1 + 3/2 i eps)/(1 + i (xi + 1/2) eps), eps = Omega St/Pr: exact for linear drag (Maxey-Riley without
// history). Transients of the slowest case, (xi + 1/2) eps = 40, have died after 60 periods.
TEST(Motion, FollowsAnOscillatingFluidAsTheExactSolution) {
    for (const double xi : {0.177, 1.65, 3.49})
        for (const double eps : {0.1, 1.0, 10.0}) {
            const std::complex<double> i(0, 1);
            const auto exact = (1.0 + 1.5 * i * eps) / (1.0 + i * (xi + 0.5) * eps);
            const auto found = response(eps, xi, 512, 120);
            EXPECT_NEAR(std::abs(found), std::abs(exact), 1e-4 * std::abs(exact)) << xi << ' ' << eps;
            EXPECT_NEAR(std::arg(found), std::arg(exact), 1e-4) << xi << ' ' << eps;
        }
    // The formula's own values, independently computed.
    const std::complex<double> i(0, 1);
    EXPECT_NEAR(std::abs((1.0 + 1.5 * i) / (1.0 + 0.677 * i)), 1.492842, 1e-6);
    EXPECT_NEAR(std::arg((1.0 + 15.0 * i) / (1.0 + 21.5 * i)), -0.020090, 1e-6);
}

TEST(Motion, IsOfSecondOrderForStepsAboveAndBelowTheRelaxationTime) {
    const std::complex<double> i(0, 1);
    for (const double eps : {1e-3, 1.0}) {  // dt/tau from 20 to 400, and from 0.005 to 0.1
        const double xi = 1.65;
        const auto exact = (1.0 + 1.5 * i * eps) / (1.0 + i * (xi + 0.5) * eps);
        const int n = eps < 0.1 ? 16 : 64;
        const double coarse = std::abs(response(eps, xi, n, 20) - exact);
        const double fine = std::abs(response(eps, xi, 2 * n, 20) - exact);
        EXPECT_NEAR(std::log2(coarse / fine), 2, 0.1) << eps;
    }
}

// Fluid at rest: slip amplitude (xi - 1) gamma (St/Pr)/sqrt(1 + ((xi + 1/2) eps)^2), the three published runs.
TEST(Motion, AnswersTheVibrationWithThePublishedSlip) {
    struct Run {
        double xi, gamma, frequency, slip;
    };
    for (const Run& run : {Run{1.65, 1.72e9, 1.667e4, 192.541}, Run{0.177, 1.69e9, 2.33e4, 239.538},
                           Run{3.49, 1.09e9, 2.33e4, 467.368}}) {
        const Sphere sphere{run.xi, 3.1e-6, 18, run.gamma, 1};
        EXPECT_NEAR(sphere.radius(), 3.735e-3, 1e-6);
        const int steps = 256;
        const double dt = 2 * pi / run.frequency / steps;
        const Motion<StokesDrag> motion(sphere, dt);
        Vec3 x{};
        Vec3 v{};
        double fastest = 0;
        for (int n = 0; n < 3 * steps; ++n) {
            motion.advance(x, v, {{}, {}, std::sin(run.frequency * (n + 0.5) * dt), {}});
            if (n >= 2 * steps) fastest = std::max(fastest, std::abs(v[1]));
        }
        EXPECT_NEAR(fastest, run.slip, 2e-4 * run.slip);
    }
}

// Terminal velocity: Re (1 + 0.15 Re^0.687) = Re_S, the Reynolds number of Stokes' law.
TEST(Motion, SettlesWithSchillerNaumannDrag) {
    const std::pair<double, double> table[] = {{0.01, 0.009937}, {0.1, 0.097067},  {1, 0.879268},     {5, 3.660803},
                                               {50, 22.131275},  {100, 36.169987}, {1000, 165.949837}};
    for (const auto& [stokes_reynolds, reynolds] : table) {
        Sphere sphere{2.5, 1e-3, 1, 0, 1};
        const double per_velocity = 2 * sphere.radius() / sphere.prandtl;
        // (xi - 1) gamma = (Pr/St) v_S
        sphere.acceleration = sphere.prandtl / sphere.stokes * (stokes_reynolds / per_velocity) / 1.5;
        const Motion<SchillerNaumann> motion(sphere, 1e-3);
        Vec3 x{};
        Vec3 v{};
        for (int n = 0; n < 400; ++n) motion.advance(x, v, {{}, {}, 1, {}});
        EXPECT_NEAR(v[1] * per_velocity, reynolds, 1e-6 + 1e-6 * reynolds) << stokes_reynolds;
    }
}

// Light particles are the trap: with the added mass on the right each step would multiply errors by -2.8.
TEST(Motion, IsStableForLightParticlesAtAnyStep) {
    for (const double dt : {1e-9, 1e-6, 1e-3, 1.0}) {
        const Motion<SchillerNaumann> motion({0.177, 3.1e-6, 18, 0, 1}, dt);
        Vec3 x{};
        Vec3 v{100, 0, 0};
        for (int n = 0; n < 1000; ++n) {
            motion.advance(x, v, {});
            ASSERT_LE(std::abs(v[0]), 100) << dt;
        }
    }
}

TEST(Walls, ReflectAtRadiusOrCentreWithRestitution) {
    Walls walls{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, 0.1, 1};
    Vec3 x{0.45, -0.47, 0};
    Vec3 v{1, -2, 3};
    walls.apply(x, v);
    EXPECT_DOUBLE_EQ(x[0], 0.35);
    EXPECT_DOUBLE_EQ(x[1], -0.33);
    EXPECT_EQ(v, (Vec3{-1, 2, 3}));
    walls.contact = 0;
    walls.restitution = 0.5;
    x = {0.6, 0, 0};
    v = {1, 0, 0};
    walls.apply(x, v);
    EXPECT_DOUBLE_EQ(x[0], 0.45);
    EXPECT_DOUBLE_EQ(v[0], -0.5);
    walls.periodic = {true, false, false};
    x = {0.6, 0, 0};
    v = {1, 0, 0};
    walls.apply(x, v);
    EXPECT_NEAR(x[0], -0.4, 1e-15);
    EXPECT_EQ(v[0], 1);
    // However far it flew, a particle ends inside.
    walls.periodic = {};
    x = {9, -9, 0};
    walls.apply(x, v);
    EXPECT_LE(std::abs(x[0]), 0.5);
    EXPECT_LE(std::abs(x[1]), 0.5);
}

}  // namespace grainsweep::tests::coupling_motion_test
