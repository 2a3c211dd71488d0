// Machines of the powder laboratory, small: laws that hold whatever the powder, and limits. Their comparison with
// published figures, with the scatter of seeds, is docs/scenes/laboratory.md.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::laboratory_test {

Observations run(const char* machine, const Inputs& changed) {
    NoArtefacts none;
    const SceneInfo& info = *campaign::scene_named(machine);
    Inputs inputs = info.defaults();
    for (const auto& [name, value] : changed) inputs.at(name) = value;
    const auto one = info.make(inputs, 1, none);
    one->advance(1e9);
    EXPECT_TRUE(one->finished());
    EXPECT_EQ(one->health().reason, "");
    Observations seen;
    one->observe(seen);
    return seen;
}

const Inputs coarse_hall = {{"particles", std::int64_t{700}}, {"diameter", 0.0004}};

TEST(Laboratory, TimeOfTheHallFlowmeterIsThatOf50GramsAtTheRate) {
    const auto seen = run("hall_flow", coarse_hall);
    EXPECT_NEAR(seen.scalars.at("flow_time") * seen.scalars.at("rate"), 0.05, 1e-12);
    EXPECT_EQ(seen.scalars.at("jammed"), 0);
    EXPECT_GE(seen.scalars.at("discharged"), 0.6);
}

TEST(Laboratory, AnOrificeOfOneAndAHalfGrainsStopsTheFlow) {
    Inputs inputs = coarse_hall;
    inputs["opening"] = 0.0006;
    const auto seen = run("hall_flow", inputs);
    EXPECT_EQ(seen.scalars.at("jammed"), 1);
    EXPECT_TRUE(!seen.scalars.contains("flow_time") || std::isnan(seen.scalars.at("flow_time")));
}

TEST(Laboratory, TheCupWeighsWhatIsInItAndTheBladeTakesTheRest) {
    const auto seen = run("apparent_density", {{"cup_diameter", 0.006},
                                               {"cup_height", 0.006},
                                               {"drop_height", 0.005},
                                               {"opening", 0.005},
                                               {"blade_speed", 0.3}});
    const double volume = std::numbers::pi * 0.003 * 0.003 * 0.006;
    EXPECT_NEAR(seen.scalars.at("apparent_density") * volume, seen.scalars.at("cup_mass"), 1e-12);
    EXPECT_GT(seen.scalars.at("fraction"), 0.40);  // 6 diameters wide: walls take a tenth and more of 0.58
    EXPECT_LT(seen.scalars.at("fraction"), 0.60);
    EXPECT_GT(seen.scalars.at("struck"), 0.01);
    EXPECT_EQ(seen.scalars.at("filled"), 1);
}

// No packing of spheres that is poured is looser than 0.45 or denser than 0.64, and taps never loosen one by more than
// a jammed bed dilates.
TEST(Laboratory, TapsMakeABedDenser) {
    const auto seen = run("tapped_density",
                          {{"particles", std::int64_t{500}}, {"cylinder_diameter", 0.008}, {"taps", std::int64_t{6}}});
    EXPECT_GT(seen.scalars.at("hausner"), 1.01);
    EXPECT_LT(seen.scalars.at("hausner"), 1.25);
    EXPECT_NEAR(seen.scalars.at("carr"), 100 * (1 - 1 / seen.scalars.at("hausner")), 1e-9);
    EXPECT_GT(seen.scalars.at("poured_fraction"), 0.45);
    EXPECT_LT(seen.scalars.at("tapped_fraction"), 0.64);
    EXPECT_EQ(seen.series.at("level").size(), 7U);
    EXPECT_NEAR(2 * seen.series.at("level").front().value * seen.scalars.at("poured_fraction"),
                2 * seen.series.at("level").back().value * seen.scalars.at("tapped_fraction"), 1e-9)
        << "the solid volume stays";
}

TEST(Laboratory, TheAngleOfReposeIsThatOfTheHeightAndRisesWithFriction) {
    const auto angle = [](double friction) {
        const auto seen = run("angle_of_repose", {{"plate_diameter", 0.018},
                                                  {"drop_height", 0.009},
                                                  {"opening", 0.006},
                                                  {"friction", friction},
                                                  {"rolling_friction", friction / 3}});
        EXPECT_EQ(seen.scalars.at("full"), 1);
        EXPECT_NEAR(std::tan(seen.scalars.at("angle") * std::numbers::pi / 180) * 0.009, seen.scalars.at("height"),
                    1e-9);
        return seen.scalars.at("angle_moment");
    };
    EXPECT_GT(angle(0.9), angle(0.4) + 3);
}

// The moment of a bed that fills half of the drum's section, 4 R/(3 pi) from the axis, about the axis. What walls give
// against rolling is no part of `torque`, and a loose bed is a little wider: together less than a tenth.
TEST(Laboratory, TheTorqueOfTheDrumCarriesTheWeightOfTheBed) {
    constexpr double radius = 0.042, length = 0.02, density = 1580;
    const auto seen = run("drum", {{"particles_scale", 4.0}, {"turning_time", 0.6}, {"measured_time", 0.6}});
    const double bed = 0.454 * 0.58 * std::numbers::pi * radius * radius * length * density * 9.81;  // N
    const double arm =
        4 * radius / (3 * std::numbers::pi) * std::sin(seen.scalars.at("angle_cm") * std::numbers::pi / 180);
    EXPECT_NEAR(seen.scalars.at("torque"), -bed * arm, 0.15 * bed * arm);
    EXPECT_EQ(seen.scalars.at("lost"), 0);
}

}  // namespace grainsweep::tests::laboratory_test
