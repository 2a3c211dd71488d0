// Regions of a machine: fillings, feeds and removals in regions that move with a wall, layers and velocities in a part
// of the domain, walls that start anew. Spheres at known places without gravity: every answer is a closed form.
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::machine_moving_regions_test {

using nlohmann::json;

constexpr double diameter = 1e-3;
const double sphere = std::numbers::pi / 6 * diameter * diameter * diameter;

/// 10 rows of 10 spheres, 2 mm apart, from x = y = 1 mm on; rows of y below 10 mm move at 1 m/s along x, others at 3
/// m/s. A plate above them moves at 2 m/s along x.
json rows() {
    json machine = json::parse(R"json({
      "name": "rows", "gravity": [0, 0, 0],
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}, "steel": {"youngs_modulus": "5 MPa"}},
      "species": {"bead": {"material": "glass", "diameter": 0.001}},
      "domain": {"low": [-0.1, 0, 0], "high": [0.1, 0.02, 0.02]},
      "walls": {"plate": {"rectangle": {"corner": [0, 0, 0.018], "along": [0.001, 0, 0], "across": [0, 0.001, 0]},
                          "motion": [{"shift": {"velocity": [2, 0, 0]}}]}},
      "fill": [{"species": "bead", "spheres": []}],
      "phases": [{"name": "go", "for": 0.005, "frames": 2}, {"name": "look", "for": 1e-6, "frames": 1}],
      "measure": {"count": {"count": {}, "as": "last"}}})json");
    for (int i = 0; i < 10; ++i)
        for (int k = 0; k < 10; ++k)
            machine["fill"][0]["spheres"].push_back({{"at", {(2 * i + 1) * 1e-3, (2 * k + 1) * 1e-3, 0.6e-3}}});
    return machine;
}

/// A region that moves with the plate.
json with_plate(const char* region) {
    return {{"moving", {{"with", "plate"}, {"in", json::parse(region)}}}};
}

TEST(MachineMovingRegions, FillingsFeedsAndRemovalsFollowTheirWall) {
    const char* behind = R"({"box": {"low": [-0.05, 0, 0], "high": [0, 0.02, 0.02]}})";
    const char* ahead = R"({"box": {"low": [0, 0, 0.005], "high": [0.004, 0.02, 0.015]}})";
    for (const char* precision : {"mixed", "double"}) {
        const Inputs inputs = {{"precision", std::string(precision)}};
        json machine = rows();
        machine["remove"] = {{{"in", with_plate(behind)}, {"at", "look"}}};
        auto seen = answer_of(spec_of(machine, inputs)).scalars;
        EXPECT_EQ(seen.at("count"), 50) << "the plate has moved by 10 mm";
        EXPECT_EQ(seen.at("lost"), 0) << "what is taken away left through no face";

        machine = rows();
        machine["measure"] = {{"x", {{"centre", {{"along", {1, 0, 0}}}}, {"during", "look"}, {"as", "last"}}}};
        machine["fill"] = {
            {{"species", "bead"}, {"count", 40}, {"at", "look"}, {"as", "random"}, {"in", with_plate(ahead)}}};
        EXPECT_NEAR(answer_of(spec_of(machine, inputs)).scalars.at("x"), 0.012, 0.001);

        machine.erase("fill");
        machine["phases"][1]["for"] = 1e-3;
        machine["feed"] = {
            {{"species", "bead"}, {"rate", 0.1}, {"every", 1}, {"during", "look"}, {"through", with_plate(ahead)}}};
        EXPECT_NEAR(answer_of(spec_of(machine, inputs)).scalars.at("x"), 0.012, 0.001);
    }
}

// Spheres of 1 mm in a period of 20 mm: one across the face, and one in the middle above the regions.
TEST(MachineMovingRegions, RemovalsTakeParticlesAcrossPeriodicFaces) {
    const auto left = [](double x, const char* region, const char* of) {
        json machine = rows();
        machine.erase("walls");
        machine["domain"] = {
            {"low", {0, 0, 0}}, {"high", {0.02, 0.02, 0.02}}, {"sides", {"periodic", "periodic", "open"}}};
        machine["fill"][0]["spheres"] = {{{"at", {x, 0.01, 0.01}}}, {{"at", {0.01, 0.01, 0.018}}}};
        machine["remove"] = {{{"in", json::parse(region)}, {"of", of}, {"at", "look"}}};
        return answer_of(spec_of(machine)).scalars.at("count");
    };
    const char* slab = R"({"box": {"low": [0, 0, 0.005], "high": [0.02, 0.02, 0.015]}})";
    const char* rod = R"({"cylinder": {"base": [0, 0.01, 0.01], "axis": [1, 0, 0], "radius": 0.002, "length": 0.02}})";
    const char* first = R"({"box": {"low": [0, 0, 0.005], "high": [0.002, 0.02, 0.015]}})";
    for (const double x : {0.0001, 0.0199, 0.007}) {
        EXPECT_EQ(left(x, slab, "whole"), 1) << "a slab without ends holds all of a sphere, also at " << x;
        EXPECT_EQ(left(x, rod, "whole"), 1) << x;
        EXPECT_EQ(left(x, first, "whole"), 2) << x;
    }
    EXPECT_EQ(left(0.001, first, "whole"), 1);
    EXPECT_EQ(left(0.0197, first, "part"), 1) << "its image reaches in";
    EXPECT_EQ(left(0.0194, first, "part"), 2);
    EXPECT_EQ(left(0.0197, first, "centre"), 2);
}

TEST(MachineMovingRegions, LayersEndWhereTheirRegionDoes) {
    for (const bool periodic : {false, true}) {
        json machine = rows();
        machine["domain"] = {{"low", {0, 0, 0}},
                             {"high", {0.02, 0.02, 0.02}},
                             {"sides", {"open", periodic ? "periodic" : "open", "open"}}};
        const auto part = [&](double low, double high) {
            return json{{"box", {{"low", {0, low, 0}}, {"high", {0.02, high, 0.02}}}}};
        };
        const json ahead = {{"half_space", {{"point", {0.01, 0, 0}}, {"normal", {1, 0, 0}}}}};
        machine["measure"] = {
            {"all", {{"layer_fraction", {{"in", part(-1, 1)}, {"height", diameter}}}, {"as", "last"}}},
            {"half", {{"layer_fraction", {{"in", part(0.005, 0.015)}, {"height", diameter}}}, {"as", "last"}}},
            {"ahead", {{"layer_fraction", {{"in", ahead}, {"height", diameter}}}, {"as", "last"}}},
            {"even",
             {{"layer_unevenness", {{"in", part(0.004, 0.016)}, {"height", diameter}, {"side", 0.002}}},
              {"as", "last"}}},
            {"bare", {{"layer_bare_share", {{"in", part(0.004, 0.016)}, {"pitch", 2e-5}}}, {"as", "last"}}},
            {"cut", {{"layer_bare_share", {{"in", part(0.005, 0.006)}, {"pitch", 2e-5}}}, {"as", "last"}}}};
        const auto seen = answer_of(spec_of(machine)).scalars;
        const double fraction = 100 * sphere / (4e-4 * diameter);
        EXPECT_NEAR(seen.at("all"), fraction, 1e-12);
        EXPECT_NEAR(seen.at("half"), fraction, 1e-12);
        EXPECT_NEAR(seen.at("ahead"), fraction, 1e-12);
        EXPECT_NEAR(seen.at("even"), 0, 1e-12) << "a sphere in each patch";
        const double bare = 1 - std::numbers::pi / 4 * diameter * diameter / 4e-6;
        EXPECT_NEAR(seen.at("bare"), bare, 2e-3);
        EXPECT_NEAR(seen.at("cut"), bare, 2e-3) << "halves of spheres, and none of the other side";
    }
}

TEST(MachineMovingRegions, VelocitiesOfLayersAreThoseOfTheirRegion) {
    json machine = rows();
    for (json& one : machine["fill"][0]["spheres"]) one["velocity"] = {one["at"][1] < 0.01 ? 1 : 3, 0, 0};
    const auto layers = [](const char* in) {
        return json{{"velocity_above", {{"in", json::parse(in)}, {"thickness", 1e-3}, {"layers", 3}}},
                    {"as", "last_profile"}};
    };
    machine["measure"] = {{"slow", layers(R"({"box": {"low": [0, 0, 0], "high": [0.03, 0.01, 0.02]}})")},
                          {"below", layers(R"({"box": {"low": [0, 0, 0], "high": [0.03, 0.02, 0.0005]}})")}};
    const auto seen = answer_of(spec_of(machine)).series;
    ASSERT_EQ(seen.at("slow").size(), 1U);
    EXPECT_NEAR(seen.at("slow")[0].value, 1, 1e-6);
    EXPECT_FALSE(seen.contains("below")) << "no centre lies there";
}

TEST(MachineMovingRegions, WallsStartAnewWithoutAPause) {
    for (const bool named : {false, true}) {
        json machine = rows();
        machine["phases"] = json::parse(
            R"([{"repeat": 3, "as": "n", "phases": [{"name": "go", "for": 0.001, "frames": 2}, {"name": "on", "for": 0.001, "frames": 2}]}])");
        machine["walls"]["plate"]["again"] = {{"each", "go"}, {"by", {0, 1e-4, 0}}};
        if (named) machine["walls"]["plate"]["motion"][0]["during"] = {"go", "on"};
        for (const char* phase : {"go", "on"})
            machine["measure"][phase] = {{"wall_position", {{"wall", "plate"}, {"along", {1, 0, 0}}}},
                                         {"as", "last"},
                                         {"during", phase},
                                         {"repeats", "each"}};
        machine["measure"]["aside"] = {{"wall_position", {{"wall", "plate"}, {"along", {0, 1, 0}}}}, {"as", "last"}};
        const auto seen = answer_of(spec_of(machine));
        ASSERT_EQ(seen.series.at("on").size(), 3U);
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(seen.series.at("go")[k].value, 0.002, 5e-5) << k;
            EXPECT_NEAR(seen.series.at("on")[k].value, 0.004, 1e-4) << k;
        }
        EXPECT_NEAR(seen.scalars.at("aside"), 2e-4, 1e-12);
    }
}

TEST(MachineMovingRegions, APressedWallStartsAnewAtRest) {
    for (const bool named : {false, true}) {
        json machine = rows();
        machine["phases"] =
            json::parse(R"([{"repeat": 3, "as": "n", "phases": [{"name": "go", "for": 0.002, "frames": 2}]}])");
        machine["walls"]["plate"]["again"] = {{"each", "go"}, {"by", {0, 1e-4, 0}}};
        machine["walls"]["plate"]["motion"] =
            json::parse(R"([{"press": {"along": [1, 0, 0], "force": 0.2, "mass": 0.01, "speed_at_most": 10}}])");
        if (named) machine["walls"]["plate"]["motion"][0]["during"] = "go";
        machine["measure"]["x"] = {{"wall_position", {{"wall", "plate"}, {"along", {1, 0, 0}}}}, {"as", "series"}};
        for (const char* precision : {"mixed", "double"}) {
            const auto x = answer_of(spec_of(machine, {{"precision", std::string(precision)}})).series.at("x");
            ASSERT_EQ(x.size(), 7U);
            for (const std::size_t k : {2U, 4U, 6U})  // a t^2/2, a = 20 m/s2
                EXPECT_NEAR(x[k].value, 4e-5, 1e-6) << k;
        }
    }
}

TEST(MachineMovingRegions, OfAClumpItsSpheresAreInTheRegion) {
    const auto left = [](const char* of, double plane) {
        json machine = rows();
        machine["domain"]["low"] = {-0.1, -0.1, 0};
        machine["species"]["bead"] = {{"material", "glass"}, {"diameter", 5e-3}, {"shape", {{"aspect_ratio", 4}}}};
        machine["fill"][0]["spheres"] = {{{"at", {0, 0, 0.01}}}, {{"at", {0.04, 0, 0.01}}}};  // 11.4 mm along x
        machine["remove"] = {
            {{"in", {{"half_space", {{"point", {plane, 0, 0}}, {"normal", {1, 0, 0}}}}}}, {"of", of}, {"at", "look"}}};
        return answer_of(spec_of(machine)).scalars.at("count");
    };
    EXPECT_EQ(left("centre", 0.045), 2);
    EXPECT_EQ(left("part", 0.045), 1) << "its end is at 45.7 mm";
    EXPECT_EQ(left("part", 0.046), 2);
    EXPECT_EQ(left("whole", 0.036), 2) << "its other end is at 34.3 mm";
    EXPECT_EQ(left("whole", 0.034), 1);
}

TEST(MachineMovingRegions, PassagesCountWhereTheRegionIs) {
    json machine = rows();
    machine["fill"][0]["spheres"] = {{{"at", {0.008, 0.005, 0.01}}, {"velocity", {0, 1, 0}}}};
    machine["phases"][0] = {{"name", "go"}, {"for", 0.01}, {"frames", 1}};  // it passes y = 9 mm after 4 ms
    const auto passed = [](const char* region) {
        return json{{"passed_number", {{"point", {0, 0.009, 0}}, {"normal", {0, 1, 0}}, {"in", with_plate(region)}}},
                    {"as", "last"}};
    };
    machine["measure"] = {{"there", passed(R"({"box": {"low": [-0.001, 0, 0], "high": [0.001, 0.02, 0.02]}})")},
                          {"start", passed(R"({"box": {"low": [0.007, 0, 0], "high": [0.009, 0.02, 0.02]}})")}};
    for (const char* precision : {"mixed", "double"}) {
        const auto seen = answer_of(spec_of(machine, {{"precision", std::string(precision)}})).scalars;
        EXPECT_EQ(seen.at("there"), 1) << "the plate is 8 mm farther by then";
        EXPECT_EQ(seen.at("start"), 0);
    }
}

}  // namespace grainsweep::tests::machine_moving_regions_test
