// Groups of phases that repeat, also within one another.
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace grainsweep::tests::machine_repeated_phases_test {

using nlohmann::json;

/// Two rounds of three strokes; a stroke goes down and comes back by half, and each round ends with a pause.
json strokes() {
    return json::parse(R"json({
      "name": "strokes",
      "gravity": [0, 0, 0],
      "parameters": {"rounds": {"whole": true, "default": 2, "bounds": [1, 5]}},
      "domain": {"low": [-1, -1, -1], "high": [1, 1, 1]},
      "materials": {"rock": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.25}},
      "species": {"sand": {"diameter": "3 mm"}},
      "walls": {"plate": {"rectangle": {"corner": [0, 0, 0], "along": [0.02, 0, 0], "across": [0, 0.02, 0]},
                          "motion": [{"shift": {"velocity": [0, 0, -0.1]}, "during": "down"},
                                     {"shift": {"velocity": [0, 0, 0.1]}, "during": "up"}]}},
      "fill": [{"species": "sand", "spheres": [{"at": [0.5, 0.5, 0.5]}]}],
      "phases": [{"name": "start", "for": 0.01, "frames": 1},
                 {"repeat": "rounds", "as": "r", "phases": [
                    {"repeat": 3, "as": "k", "phases": [
                      {"name": "down", "for": "0.02*(1 + r)", "frames": 1},
                      {"name": "up", "for": "0.01*(1 + r)", "frames": 1}]
},
                    {"name": "pause", "until": {"empty": {"ball": {"centre": [0, 0, 0.9], "radius": 0.01}}},
                     "at_most": 0.03, "frames": 1}]
}],
      "measure": {
    "way" : {"wall_position" : {"wall" : "plate", "along" : [ 0, 0, 1 ]}, "as" : "last"}, "heights" : {
        "wall_position" : {"wall" : "plate", "along" : [ 0, 0, 1 ]}, "during" : "up", "as" : "series"
    }
}
})json");
}

TEST(MachineRepeatedPhases, HappenInTheirOrderWithTheirCounters) {
    const auto spec = spec_of(strokes());
    ASSERT_EQ(spec.phases.size(), 1u + 2 * (3 * 2 + 1));
    EXPECT_EQ(spec.phases[1].name, "down");
    EXPECT_DOUBLE_EQ(spec.phases[1].duration, 0.02);
    EXPECT_EQ(spec.phases[7].name, "pause");
    EXPECT_DOUBLE_EQ(spec.phases[8].duration, 0.04);
    EXPECT_EQ(spec.walls[0].motions.size(), 12u);
    EXPECT_EQ(spec_of(strokes(), {{"rounds", std::int64_t{4}}}).phases.size(), 1u + 4 * 7);
}

TEST(MachineRepeatedPhases, MotionsActInEveryCopy) {
    for (const char* precision : {"double", "mixed"}) {
        const auto seen = answer_of(spec_of(strokes(), {{"precision", precision}}));
        // Each stroke: down by 2 mm (1 + r), back by 1 mm (1 + r).
        EXPECT_NEAR(seen.scalars.at("way"), -0.009, 1e-5) << precision;
        const auto& heights = seen.series.at("heights");
        ASSERT_EQ(heights.size(), 12u);
        EXPECT_NEAR(heights[0].value, -0.002, 1e-5);
        EXPECT_NEAR(heights[1].value, -0.001, 1e-5);
        EXPECT_NEAR(heights[11].value, -0.009, 1e-5);
        // The region is empty at once: a pause lasts until its first check.
        EXPECT_GT(seen.scalars.at("pause_time"), 0);
        EXPECT_LT(seen.scalars.at("pause_time"), 0.02);
        EXPECT_EQ(seen.scalars.at("pause_ended"), 1);
    }
}

TEST(MachineRepeatedPhases, WrongGroupsGetOneSentence) {
    const auto why = [](const char* path, const char* value) {
        json machine = strokes();
        machine[json::json_pointer(path)] = json::parse(value);
        try {
            (void)spec_of(machine);
        } catch (const std::exception& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_NE(why("/phases/1/repeat", "0").find("$.phases[1].repeat: got 0; a group of phases happens at least once."),
              std::string::npos)
        << why("/phases/1/repeat", "0");
    EXPECT_NE(why("/phases/1/name", R"("round")").find(R"(a group of phases has only "phases", "repeat" and "as")"),
              std::string::npos);
    EXPECT_NE(why("/phases/0/repeat", "2").find(R"(it belongs to a group: beside "phases")"), std::string::npos);
    EXPECT_NE(why("/phases/1/phases", "[]").find("a group needs a phase"), std::string::npos);
    EXPECT_NE(why("/phases/1/phases/1/name", R"("start")").find("a phase of this name is there twice"),
              std::string::npos);
    EXPECT_NE(why("/phases/1/phases/0/repeat", "1000").find("at most 3000 phases, repeated ones included"),
              std::string::npos);
}

}  // namespace grainsweep::tests::machine_repeated_phases_test
