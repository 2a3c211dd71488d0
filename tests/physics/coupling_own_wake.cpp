// A sphere alone in a two-way coupled box moves as its drag law says: it does not feel its own wake.
#include "tests/support/lone_sphere.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

namespace grainsweep::tests::coupling_own_wake_test {

using namespace lone_sphere;

// One grid and kernel, two distances; slow_wake has more of each.
TEST(OwnWake, SettlingIsStokes) {
    for (const double z : {0.04, 0.5})
        for (const int axis : {0, 1}) {
            const Place at{cube(16), 0.07, {-0.497 + z, 0.011, 0.007}, axis};
            EXPECT_LT(std::abs(settling<Subtracted>(at) - 1), 0.01) << "z " << z << ", axis " << axis;
            EXPECT_GT(settling<Kept>(at) - 1, axis == 0 && z < 0.1 ? 0.001 : 0.015);
        }
}

/// Amplitude and phase of the last period of `values`.
std::complex<double> harmonic(const std::vector<double>& values, int period, double frequency) {
    std::complex<double> sum = 0;
    const auto n = static_cast<int>(values.size());
    for (int s = n - period; s < n; ++s)
        sum += values[static_cast<std::size_t>(s)] * std::polar(1.0, -frequency * (s + 1) * dt);
    return sum * (2.0 / period);
}

TEST(OwnWake, AVibratedSphereAnswersAsInAStillFluid) {
    const int period = 40;
    const flow::Vibration vibration{2 * std::numbers::pi / (period * dt), 0};
    const Place at{cube(24), 0.06, {0.013, 0.011, 0.007}, 1};
    const auto answer = [&](const std::vector<double>& values) {
        return harmonic(values, period, vibration.frequency);
    };
    const auto still = answer(velocities<OneWay>(at, vibration, 12 * period));
    const auto kept = answer(velocities<Kept>(at, vibration, 12 * period)) / still;
    const auto subtracted = answer(velocities<Subtracted>(at, vibration, 12 * period)) / still;
    EXPECT_GT(std::abs(kept - 1.0), 0.01);
    EXPECT_LT(std::abs(subtracted - 1.0), 0.005);
}

// The modes are the kernel (nu T + s2/2)^(-3/2)/(12 pi^(3/2)), whose integral is 1/(6 pi nu) sqrt(2/pi)/s.
TEST(OwnWake, ModesAreTheResponseOfAGaussian) {
    const double viscosity = 18, least = 1e-3;
    const WakeModes modes(least, viscosity);
    for (const double variance : {least, 4 * least}) {
        const auto weight = modes.weight(variance);
        for (const double time : {0.0, 1e-6, 1e-5, 1e-4, 1e-3}) {
            double sum = 0;
            for (std::size_t m = 0; m < WakeModes::count; ++m) sum += weight[m] * std::exp(-modes.rate()[m] * time);
            const double exact =
                std::pow(viscosity * time + variance / 2, -1.5) / (12 * std::pow(std::numbers::pi, 1.5));
            EXPECT_NEAR(sum, exact, 0.01 * exact) << variance << ' ' << time;
        }
        double steady = 0;
        for (std::size_t m = 0; m < WakeModes::count; ++m) steady += weight[m] / modes.rate()[m];
        const double exact = std::sqrt(2 / std::numbers::pi / variance) / (6 * std::numbers::pi * viscosity);
        EXPECT_NEAR(steady, exact, 0.02 * exact);
    }
}

}  // namespace grainsweep::tests::coupling_own_wake_test
