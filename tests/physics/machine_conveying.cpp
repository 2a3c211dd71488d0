// Installed machines that convey and mix, against conservation of mass and the theory of plastic impacts of a point
// mass.
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/machine.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>
#include <string>

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

// Along the belt its ends do not move: a sphere that meets one rebounds from a wall at rest.
TEST(MachineConveying, OnlyThePartOfAVelocityAlongTheSurfaceCounts) {
    auto machine = nlohmann::json::parse(R"({
      "name": "ends", "gravity": [0, 0, 0],
      "materials": {"m": {"density": 2500, "youngs_modulus": 1e7}},
      "contacts": {"restitution": 0.5},
      "species": {"p": {"material": "m", "diameter": "5 mm"}},
      "domain": {"low": [-0.5, -0.5, -0.5], "high": [0.5, 0.5, 0.5]},
      "walls": {"w": {"box": {"low": [-0.1, -0.1, 0], "high": [0.1, 0.1, 0.1], "open": ["+z"]},
                      "motion": [{"convey": {"velocity": [0.5, 0, 0]}}]}},
      "fill": [{"species": "p", "spheres": [{"at": [0.09, 0, 0.05], "velocity": [1, 0, 0]}]}],
      "phases": [{"name": "s", "for": 0.03, "frames": 5}],
      "measure": {"vx": {"velocity": {"along": [1, 0, 0]}, "as": "last"}, "work": {"wall_work": {"wall": "w"}, "as": "last"}}
    })");
    for (const char* precision : {"mixed", "double"}) {
        const auto conveyed = answer_of(spec_of(machine, {{"precision", precision}})).scalars;
        auto still = machine;
        still["walls"]["w"].erase("motion");
        const auto at_rest = answer_of(spec_of(still, {{"precision", precision}})).scalars;
        EXPECT_NEAR(at_rest.at("vx"), -0.5, 0.05);
        EXPECT_NEAR(conveyed.at("vx"), at_rest.at("vx"), 1e-6) << precision;
        EXPECT_NEAR(conveyed.at("work"), 0, 1e-12) << precision;
        // with friction, the floor carries it along, to two sevenths of its speed as it comes to roll
        auto rough = machine;
        rough["gravity"] = {0, 0, -9.81};
        rough["contacts"]["friction"] = 0.5;
        rough["fill"][0]["spheres"][0] = {{"at", {0, 0, 0.0025}}};
        rough["phases"][0]["for"] = 0.1;
        EXPECT_NEAR(answer_of(spec_of(rough, {{"precision", precision}})).scalars.at("vx"), 0.5 * 2 / 7, 0.003)
            << precision;
    }
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

/// Larger grains than by default: fewer of them.
const Inputs coarse_vanes = {
    {"diameter", 0.005}, {"clearance", 0.006}, {"particles", std::int64_t{2200}}, {"settle_time", 0.3}};

TEST(MachineConveying, AVaneFeederDeliversSpeedTimesVolumeOfPocketsTimesSolidFraction) {
    const double pi = std::numbers::pi, density = 2500;
    const double pockets = pi * (0.046 * 0.046 - 0.01 * 0.01) * 0.024;  // m3, between hub and casing
    double filling_before = 1;
    for (const double rpm : {60.0, 200.0}) {
        Inputs changed = coarse_vanes;
        changed["speed"] = rpm;
        const auto seen = answer_with("vane_feeder", changed).scalars;
        const double solid = seen.at("solid_fraction");
        EXPECT_NEAR(seen.at("rate") / (rpm / 60 * pockets * density * solid), 1, 0.1) << rpm;
        EXPECT_TRUE(solid > 0.4 && solid < 0.6) << solid;
        // Pockets that open for a shorter time fill less.
        EXPECT_LT(seen.at("filling"), filling_before);
        filling_before = seen.at("filling");
        // A grain between the edge of the inlet and a vane 1 mm away would overlap each by 0.4 diameters.
        EXPECT_LT(seen.at("max_wall_overlap"), 0.15) << rpm;
    }
}

TEST(MachineConveying, AVaneFeederWarnsOfGrainsThatDoNotPassItsClearance) {
    const auto machine = campaign::installed_machine("vane_feeder");
    const auto kinds = [&](double clearance) {
        Inputs changed = coarse_vanes;
        changed["clearance"] = clearance;
        std::set<std::string> all;
        for (const Warning& warning : campaign::machine_spec(*machine, inputs_of(*machine, changed)).warnings)
            all.insert(warning.kind);
        return all;
    };
    EXPECT_TRUE(kinds(0.001).contains("pinched grains"));
    EXPECT_FALSE(kinds(0.006).contains("pinched grains"));
    EXPECT_FALSE(kinds(0.006).contains("wide clearance"));
    EXPECT_TRUE(kinds(0.015).contains("wide clearance"));
}

TEST(MachineConveying, RibbonsMixByTurnsAtATorqueThatSpeedHardlyChanges) {
    double mixed_before = 0, torque_before = 0;
    for (const double rpm : {60.0, 120.0}) {
        const auto seen = answer_with(
            "ribbon_mixer",
            {{"speed", rpm}, {"diameter", 0.006}, {"particles", std::int64_t{1200}}, {"revolutions", std::int64_t{3}}});
        const double apart = seen.series.at("mixing").front().value, mixed = seen.scalars.at("lacey");
        EXPECT_LT(apart, 0.25) << rpm;
        EXPECT_GT(mixed, 0.6) << rpm;
        EXPECT_EQ(seen.scalars.at("lost"), 0);
        EXPECT_LT(seen.scalars.at("max_wall_overlap"), 0.2) << "no grain is pinched between ribbon and trough";
        const double torque = seen.scalars.at("torque");
        EXPECT_LT(torque, 0) << "the powder resists";
        EXPECT_NEAR(seen.scalars.at("power") / (-torque * rpm / 60 * 2 * std::numbers::pi), 1, 1e-9);
        if (mixed_before > 0) {
            EXPECT_NEAR(mixed, mixed_before, 0.1);
            EXPECT_NEAR(torque / torque_before, 1, 0.2);
        }
        mixed_before = mixed, torque_before = torque;
    }
}

}  // namespace grainsweep::tests::machine_conveying_test
