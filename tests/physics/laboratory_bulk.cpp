// The laboratory's tests of powder in bulk: each machine, small, against a balance or a law.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/machine.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>

namespace grainsweep::tests::laboratory_bulk_test {

using Scalars = std::map<std::string, double, std::less<>>;

Scalars answer(const char* machine, const Inputs& set, std::uint64_t seed = 1) {
    const auto shared = campaign::enter_machine(campaign::installed_machine(machine));
    const SceneInfo& scene = *shared;
    Inputs inputs = scene.defaults();
    for (const auto& [name, value] : set) inputs[name] = value;
    NoArtefacts none;
    const auto run = scene.make(inputs, seed, none);
    while (!run->finished() && run->health().stable()) run->advance(run->time() + 0.5);
    EXPECT_TRUE(run->health().stable()) << run->health().reason;
    Observations observations;
    run->observe(observations);
    return observations.scalars;
}

// Without friction at the walls the bottom carries the plate and the weight: at 5 cm/s inertia is small.
TEST(LaboratoryBulk, ADieWithoutWallFrictionPassesItsLoadOn) {
    const Inputs small = {{"particles", 300.0}, {"width", 0.03}};
    Inputs smooth = small;
    smooth["wall_friction"] = 0.0;
    const auto seen = answer("compaction", smooth);
    const double area = 0.03 * 0.03, weight = 9.81 * seen.at("mass") / area;
    EXPECT_NEAR(seen.at("bottom_stress"), seen.at("top_stress") + weight, 0.01 * seen.at("top_stress"));
    EXPECT_GT(seen.at("strain"), seen.at("strain_half"));
    EXPECT_GT(seen.at("strain_half"), 0);
    EXPECT_LT(seen.at("strain_left"), seen.at("strain"));

    const auto rough = answer("compaction", small);
    EXPECT_LT(rough.at("bottom_ratio"), 0.8);
    EXPECT_GT(rough.at("side_ratio"), 0.3);
    EXPECT_LT(rough.at("side_ratio"), 0.6);
}

// Four times as stiff: at most four times the modulus, and more than twice, because contacts are Hertzian.
TEST(LaboratoryBulk, HardPowderIsStiffer) {
    const Inputs small = {{"particles", 300.0}, {"width", 0.03}, {"wall_friction", 0.0}};
    Inputs hard = small;
    hard["hard"] = 1.0;
    const auto soft = answer("compaction", small), stiff = answer("compaction", hard);
    EXPECT_LT(stiff.at("strain"), soft.at("strain"));
    EXPECT_GT(stiff.at("unloading_modulus"), 1.5 * soft.at("unloading_modulus"));
    EXPECT_LT(stiff.at("unloading_modulus"), 4 * soft.at("unloading_modulus"));
}

// The work of the blades is that of their torque and force; friction raises it.
TEST(LaboratoryBulk, FlowEnergyIsTheWorkOfTheBlades) {
    Inputs small = {{"particles", 700.0}, {"vessel", 0.032}, {"top", 0.03}, {"bottom", 0.01}, {"friction", 0.6}};
    const auto rough = answer("rheometer", small);
    EXPECT_NEAR(rough.at("torque_energy"), rough.at("rotation_energy"), 0.03 * rough.at("flow_energy"));
    EXPECT_GT(rough.at("axial_energy"), 0);
    small["friction"] = 0.1;
    EXPECT_LT(answer("rheometer", small).at("flow_energy"), 0.8 * rough.at("flow_energy"));
}

// The lid carries its force, friction between particles raises the friction angle, and stresses are proportional.
TEST(LaboratoryBulk, TheShearBoxMeasuresFriction) {
    const Inputs small = {{"width", 0.06}, {"displacement", 0.009}, {"depth", 0.012}, {"height", 0.03}};
    const auto with = [&](double friction, double stress) {
        Inputs set = small;
        set["friction"] = friction;
        set["stress"] = stress;
        const auto seen = answer("shear_box", set);
        EXPECT_EQ(seen.at("lost"), 0);
        EXPECT_NEAR(seen.at("lid_load") / (0.06 * 0.012), 1000 * stress, 20 * stress);
        return seen;
    };
    const double smooth = with(0, 5).at("friction_angle");
    const auto rough = with(0.5, 5), heavier = with(0.5, 15);
    EXPECT_GT(smooth, 4);
    EXPECT_LT(smooth, 11);
    EXPECT_GT(rough.at("friction_angle"), smooth + 10);
    EXPECT_LT(rough.at("friction_angle"), 31);
    EXPECT_NEAR(heavier.at("stress_ratio"), rough.at("stress_ratio"), 0.08);
}

// Uehara et al. 2003: the depth grows as the cube root of the way from rest to rest.
TEST(LaboratoryBulk, DepthGrowsAsTheCubeRootOfTheFall) {
    const auto fallen = [](double height) {
        return answer(
            "impact",
            {{"fall", height}, {"modulus", 5.0}, {"vessel", 0.08}, {"bed_height", 0.045}, {"ball_diameter", 0.016}});
    };
    const auto low = fallen(0.04), high = fallen(0.5);
    EXPECT_NEAR(low.at("fall_height"), 0.04, 0.012);
    EXPECT_NEAR(high.at("fall_height"), 0.5, 0.012);
    const double expected = std::cbrt(high.at("drop") / low.at("drop"));
    EXPECT_NEAR(high.at("depth") / low.at("depth") / expected, 1, 0.25);
}

// Angular momentum is steady in the mean: the torque of the mill is the weight of the balls times their offset.
TEST(LaboratoryBulk, TheMillsTorqueIsTheMomentOfTheWeight) {
    Inputs small = {{"mill_diameter", 0.15}, {"length", 0.03}, {"revolutions", 4.0}};
    const auto tumbling = answer("mill", small);
    EXPECT_NEAR(tumbling.at("torque"), tumbling.at("arm_torque"), 0.02 * tumbling.at("arm_torque"));
    small["speed"] = 1.5;
    small["start"] = 3.0;
    EXPECT_LT(answer("mill", small).at("torque"), 0.6 * tumbling.at("torque")) << "balls that stick to the wall";
}

// Bond's standard mill: 305 mm wide and long, smooth, 20.1 kg of balls, 70 rpm, about 70 W (Steiner 1996, Int. J.
// Miner. Process. 44-45, 373). Its balls have several sizes, and it holds ore: a tenth is what this is known to.
TEST(LaboratoryBulk, BondsMillTakesItsPower) {
    const auto bond = answer("mill", {{"mill_diameter", 0.305},
                                      {"length", 0.305},
                                      {"ball", 0.025},
                                      {"filling", 0.193},
                                      {"speed", 0.876},
                                      {"lifters", std::int64_t{0}},
                                      {"friction", 0.4},
                                      {"revolutions", 2.0}});
    EXPECT_NEAR(bond.at("mass"), 20.1, 0.2);
    EXPECT_NEAR(bond.at("power"), 70, 7);
    EXPECT_NEAR(bond.at("power") / bond.at("torque"), 70 * 2 * std::numbers::pi / 60, 0.02) << "rad/s";
}

}  // namespace grainsweep::tests::laboratory_bulk_test
