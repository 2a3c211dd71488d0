// Overlaps of a machine: with walls at the start and with walls that appear, their largest values, and the remark on
// deep ones.
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

namespace grainsweep::tests::machine_overlaps_test {

using nlohmann::json;

constexpr const char* precisions[] = {"mixed", "double"};

/// A sphere of 5 mm without gravity, `depth` diameters deep in a rectangle.
json sphere_at_wall(double depth) {
    json machine = json::parse(R"({
      "name": "overlap",
      "gravity": [0, 0, 0],
      "materials": {"grain": {"density": 2500, "youngs_modulus": 1e7}},
      "contacts": {"friction": 0, "restitution": 0.9},
      "species": {"ball": {"diameter": 0.005}},
      "domain": {"low": [-0.1, -0.1, -0.1], "high": [0.1, 0.1, 0.1]},
      "walls": {"plate": {"rectangle": {"corner": [-0.05, -0.05, 0], "along": [0.1, 0, 0], "across": [0, 0.1, 0]}}},
      "fill": [{"species": "ball", "spheres": [{"at": [0, 0, 0]}]}],
      "phases": [{"name": "first", "for": 0.001, "frames": 2}, {"name": "second", "for": 0.002, "frames": 2}],
      "measure": {"speed": {"rms_speed": {}, "as": "last"}}
    })");
    machine["fill"][0]["spheres"][0]["at"][2] = 0.0025 - 0.005 * depth;
    return machine;
}

/// Message, remark and answer of a machine that ends.
struct Ending {
    std::string reason, remark;
    Observations seen;
};

Ending ending(const json& machine, const char* precision) {
    machine::Run run(spec_of(machine, {{"precision", std::string(precision)}}), 1);
    run.advance(1e9);
    Ending end{run.health().reason, run.remark(), {}};
    if (run.health().stable()) run.observe(end.seen);
    return end;
}

std::string refusal(const json& machine) {
    try {
        (void)spec_of(machine);
    } catch (const std::runtime_error& why) {
        return why.what();
    }
    return {};
}

TEST(MachineOverlaps, RefuseASphereThatStartsDeepInAWall) {
    EXPECT_NE(refusal(sphere_at_wall(0.4))
                  .find("$.fill: ball: a sphere at (0, 0, 0.0005) m starts 0.4 diameters deep (limit 0.15) in wall "
                        "'plate'"),
              std::string::npos)
        << refusal(sphere_at_wall(0.4));
    EXPECT_NE(refusal(sphere_at_wall(0.151)), "");
    EXPECT_EQ(refusal(sphere_at_wall(0.149)), "");
    json glued = sphere_at_wall(0.4);
    glued["fill"][0]["glued"] = true;
    EXPECT_EQ(refusal(glued), "") << "part of the wall";
}

TEST(MachineOverlaps, AWallThatAppearsDeepInParticlesEndsTheRun) {
    for (const char* precision : precisions) {
        json machine = sphere_at_wall(0.2);
        machine["walls"]["plate"]["during"] = {"second"};
        const std::string reason = ending(machine, precision).reason;
        EXPECT_EQ(reason.find("wall 'plate' appears 0.2 diameters deep (limit 0.15) in a particle at "), 0U) << reason;
        machine = sphere_at_wall(0.149);
        machine["walls"]["plate"]["during"] = {"second"};
        EXPECT_EQ(ending(machine, precision).reason, "");
    }
}

TEST(MachineOverlaps, TheRemarkStatesDeepOnes) {
    for (const char* precision : precisions) {
        json machine = sphere_at_wall(-0.01);
        auto& ball = machine["fill"][0]["spheres"][0];
        ball["velocity"] = {0, 0, -1};
        const Ending shallow = ending(machine, precision);
        EXPECT_EQ(shallow.remark, "");
        EXPECT_GT(shallow.seen.scalars.at("max_wall_overlap"), 0.03);
        EXPECT_LT(shallow.seen.scalars.at("max_wall_overlap"), 0.05);
        EXPECT_EQ(shallow.seen.scalars.at("max_overlap"), 0);
        ball["velocity"] = {0, 0, -10};
        const Ending deep = ending(machine, precision);
        EXPECT_GT(deep.seen.scalars.at("max_wall_overlap"), 0.1);
        EXPECT_NE(deep.remark.find("particles overlapped a wall by up to 0.2"), std::string::npos) << deep.remark;
        // Two spheres, away from the wall.
        ball = {{"at", {0, 0, 0.02}}};
        machine["fill"][0]["spheres"].push_back({{"at", {0, 0, 0.0251}}, {"velocity", {0, 0, -5}}});
        const Ending pair = ending(machine, precision);
        EXPECT_GT(pair.seen.scalars.at("max_overlap"), 0.1);
        EXPECT_NE(pair.remark.find("particles overlapped each other by up to 0.1"), std::string::npos) << pair.remark;
    }
}

// Impacts while powder is poured are no reason to doubt what is measured afterwards.
TEST(MachineOverlaps, TheRemarkIsOnPhasesThatAreMeasured) {
    for (const char* precision : precisions) {
        json machine = sphere_at_wall(-0.01);
        machine["fill"][0]["spheres"][0]["velocity"] = {0, 0, -10};
        machine["phases"][0]["for"] = 0.003;
        for (const auto& [during, as, remarked] :
             {std::tuple{"first", "last", true}, {"first", "first", false}, {"second", "last", false}}) {
            machine["measure"]["speed"] = {{"rms_speed", json::object()}, {"during", during}, {"as", as}};
            const Ending end = ending(machine, precision);
            EXPECT_GT(end.seen.scalars.at("max_wall_overlap"), 0.1);
            EXPECT_EQ(!end.remark.empty(), remarked) << during << as << end.remark;
        }
    }
}

TEST(MachineOverlaps, ContinueFromACheckpoint) {
    json machine = sphere_at_wall(-0.01);
    machine["fill"][0]["spheres"][0]["velocity"] = {0, 0, -10};
    for (const char* precision : precisions) {
        const auto spec = spec_of(machine, {{"precision", std::string(precision)}});
        machine::Run whole(spec, 1);
        whole.advance(0.002);
        Bytes bytes;
        whole.save(bytes);
        machine::Run resumed(spec, 1);
        resumed.restore(bytes);
        whole.advance(1e9), resumed.advance(1e9);
        Observations one, other;
        whole.observe(one), resumed.observe(other);
        EXPECT_EQ(text_of(one), text_of(other));
        EXPECT_EQ(whole.remark(), resumed.remark());
        EXPECT_NE(whole.remark(), "");
    }
}

TEST(MachineOverlaps, AWallThatIsTooFastIsNamed) {
    for (const char* precision : precisions) {
        json machine = sphere_at_wall(-4);
        const double step = spec_of(machine).time_step;
        machine["walls"]["plate"]["motion"] = {{{"shift", {{"velocity", {0, 0, 0.8 * 0.0025 / step}}}}}};
        const auto run = ending(machine, precision);
        const bool mixed = std::string(precision) == "mixed";
        EXPECT_EQ(run.reason.find("wall 'plate' moves at ") == 0, mixed)
            << run.reason << ", the limits are 0.5 and 1 radius";
        machine["walls"]["plate"]["motion"][0]["shift"]["velocity"][2] = 3 * 0.0025 / step;
        EXPECT_EQ(ending(machine, precision).reason.find("wall 'plate' moves at "), 0U)
            << ending(machine, precision).reason;
    }
}

// They do not touch each other: such a wall would go on through the particle.
TEST(MachineOverlaps, AWallThatForcesMoveEndsTheRunAtAGluedParticle) {
    const char* walls[] = {
        R"({"rectangle": {"corner": [-0.02, -0.02, 0.03], "along": [0.04, 0, 0], "across": [0, 0.04, 0]},
            "motion": [{"press": {"along": [0, 0, -1], "force": 1, "mass": 0.01, "speed_at_most": 1}}]})",
        R"({"rectangle": {"corner": [0.003, -0.03, -0.02], "along": [0, 0.06, 0], "across": [0, 0, 0.04]},
            "motion": [{"drive": {"axis": [0, 0, 1], "through": [0.003, -0.03, 0], "torque": 0.001, "inertia": 1e-5,
                                  "speed_at_most": 10}}]})",
        R"({"box": {"low": [-0.004, -0.004, 0.03], "high": [0.004, 0.004, 0.038]},
            "motion": [{"free": {"mass": 0.001, "speed_at_most": 1}}]})"};
    for (const char* wall : walls)
        for (const char* precision : precisions) {
            json machine = sphere_at_wall(-2);
            machine["gravity"] = {0, 0, -9.81};
            machine["domain"] = {{"low", {-0.2, -0.2, -0.2}}, {"high", {0.2, 0.2, 0.2}}};
            machine["walls"]["moved"] = json::parse(wall);
            machine["fill"][0]["glued"] = true;
            machine["phases"][1]["for"] = 0.3;
            const std::string reason = ending(machine, precision).reason;
            EXPECT_EQ(reason.find("wall 'moved', which forces move, has reached a glued particle, and they do not "
                                  "touch each other: leave the particle free, or hold the wall before it"),
                      0U)
                << wall << precision << reason;
            machine["phases"][1]["for"] = 0.001;
            EXPECT_EQ(ending(machine, precision).reason, "") << "not reached yet";
        }
}

}  // namespace grainsweep::tests::machine_overlaps_test
