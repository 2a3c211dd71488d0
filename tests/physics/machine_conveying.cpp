// Installed machines that convey, against conservation of mass and the theory of plastic impacts of a point mass.
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/machine.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::machine_conveying_test {

Observations answer_with(const char* name, const Inputs& changed) {
    const auto machine = campaign::installed_machine(name);
    return answer_of(campaign::machine_spec(*machine, inputs_of(*machine, changed)));
}

/// Mean transport speed over the largest speed of the trough along itself. The mass leaves the trough at the phase a
/// with sin a = 1/K, lands after the angle t and sticks.
double efficiency_of_plastic_impacts(double throw_number) {
    const double a = std::asin(1 / throw_number);
    const auto above = [&](double t) {
        return std::sin(a) + std::cos(a) * t - t * t / (2 * throw_number) - std::sin(a + t);
    };
    double low = 0.5, high = 2 * std::numbers::pi;
    while (high - low > 1e-12) (above((low + high) / 2) > 0 ? low : high) = (low + high) / 2;
    return (low * std::cos(a) - std::sin(a + low) + std::sin(a)) / (2 * std::numbers::pi);
}

TEST(MachineConveying, ABeltKeepsTheFedMass) {
    const auto seen = answer_with("belt", {{"speed", 0.6}, {"measured_time", 0.5}}).scalars;
    EXPECT_NEAR(seen.at("load") * 0.6 / 0.15, 1, 0.03);
    EXPECT_NEAR(seen.at("flux") / 0.15, 1, 0.03);
    EXPECT_NEAR(seen.at("slip"), 0, 0.005);
}

TEST(MachineConveying, AVibratingTroughThrowsABedAsAPlasticMass) {
    EXPECT_NEAR(efficiency_of_plastic_impacts(2), 0.864, 0.001);
    for (const double throw_number : {1.6, 2.0, 2.4})
        EXPECT_NEAR(answer_with("vibrating_conveyor", {{"throw_number", throw_number}}).scalars.at("efficiency") /
                        efficiency_of_plastic_impacts(throw_number),
                    1, 0.05)
            << throw_number;
}

TEST(MachineConveying, NoGrainLargerThanTheApertureIsScreened) {
    const auto seen = answer_with("screen", {{"slope", 20.0}, {"start_time", 1.0}, {"measured_time", 1.0}}).scalars;
    EXPECT_EQ(seen.at("under_coarse"), 0);
    EXPECT_GT(seen.at("passed_fine"), 0.95);
    EXPECT_GT(seen.at("passed_near"), 0.8);
}

}  // namespace grainsweep::tests::machine_conveying_test
