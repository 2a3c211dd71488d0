// Walls of a machine that the powder moves: a pressed lid, a driven blade; by phases, in pictures and checkpoints.
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace grainsweep::tests::machine_free_walls_test {

using nlohmann::json;

/// 60 spheres of 3 mm in a box of 12 mm, pressed by a lid of 5 g in two of four phases.
json press_machine() {
    return json::parse(R"({
      "name": "press",
      "parameters": {"force": {"unit": "N", "default": 2}},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
      "contacts": {"restitution": 0.5, "friction": 0.3},
      "species": {"bead": {"diameter": "3 mm"}},
      "domain": {"low": [0, 0, -0.006], "high": [0.012, 0.012, 0.04], "periodic": [1, 1, 0]},
      "walls": {
        "floor": {"plane": {"normal": [0, 0, 1]}},
        "lid": {"plane": {"point": [0, 0, "34 mm"], "normal": [0, 0, -1]},
                "motion": [{"press": {"along": [0, 0, -1], "force": "force", "mass": "5 g", "speed_at_most": 0.3},
                            "during": ["press", "rest"]}]}
      },
      "fill": [{"species": "bead", "count": 60, "in": {"box": {"low": [0, 0, 0], "high": [0.012, 0.012, 0.03]}}}],
      "phases": [{"name": "settle", "for": 0.1}, {"name": "press", "for": 0.2, "frames": 4}, {"name": "rest", "for": 0.2, "frames": 200}, {"name": "hold", "for": 0.05}],
      "measure": {
        "before": {"wall_position": {"wall": "lid", "along": [0, 0, -1]}, "during": "settle", "as": "max"},
        "way": {"wall_position": {"wall": "lid", "along": [0, 0, -1]}, "during": "rest", "as": "last"},
        "held": {"wall_position": {"wall": "lid", "along": [0, 0, -1]}, "during": "hold", "as": "change"},
        "load": {"wall_force": {"wall": "lid", "along": [0, 0, 1]}, "during": "rest"},
        "carried": {"wall_force": {"wall": "floor", "along": [0, 0, -1]}, "during": "rest"}
      }
    })");
}

TEST(MachineFreeWalls, ALidIsPressedInItsPhase) {
    for (const char* precision : {"mixed", "double"}) {
        const auto seen = answer_of(spec_of(press_machine(), {{"precision", std::string(precision)}})).scalars;
        EXPECT_EQ(seen.at("before"), 0);
        EXPECT_GT(seen.at("way"), 0.008);
        EXPECT_LT(seen.at("way"), 0.026);
        EXPECT_EQ(seen.at("held"), 0);
        EXPECT_NEAR(seen.at("load"), 2, 0.02);
        const double weight = 60 * 2500 * 3.14159265 / 6 * 27e-9 * 9.81;
        EXPECT_NEAR(seen.at("carried"), 2 + weight, 0.02);
    }
}

// It has no threshold: at this step the bed is lower than at a tenth of it, however long it is pressed.
TEST(MachineFreeWalls, APressedBedThatCreepsByItsConstantTorqueIsNamed) {
    const auto remark_with = [](const char* law, double fraction) {
        json machine = press_machine();
        machine["contacts"]["rolling_friction"] = 0.4;
        machine["contacts"]["rolling_law"] = law;
        machine::Run run(spec_of(machine, {{"time_step_fraction", fraction}}), 1);
        run.advance(1e9);
        return run.remark();
    };
    EXPECT_NE(remark_with("cdt", 0.2).find("rolling_law cdt turns loaded particles to and fro"), std::string::npos);
    EXPECT_EQ(remark_with("cdt", 0.01).find("rolling_law"), std::string::npos);
    EXPECT_EQ(remark_with("epsd", 0.2).find("rolling_law"), std::string::npos);
}

TEST(MachineFreeWalls, PicturesAndCheckpointsHaveTheLidWhereItIs) {
    const auto spec = spec_of(press_machine());
    machine::Run whole(spec, 5);
    whole.advance(0.25);
    const auto top = [](const machine::Run& run) {
        const auto picture = run.snapshot();
        const auto lid = std::ranges::find(picture.walls, "lid", &WallSurface::name);
        return std::ranges::max(lid->corners, {}, [](const auto& x) { return x[2]; })[2];
    };
    EXPECT_LT(top(whole), 0.034 - 0.008);
    Bytes bytes;
    whole.save(bytes);
    machine::Run other(spec, 5);
    EXPECT_NEAR(top(other), 0.034, 1e-12);
    other.restore(bytes);
    EXPECT_EQ(top(other), top(whole));
    whole.advance(1), other.advance(1);
    Observations a, b;
    whole.observe(a), other.observe(b);
    EXPECT_EQ(text_of(a), text_of(b));
}

// A wheel of 2 g m2 on its axis, driven by 1 mN m without powder: 1/2 M/I t^2 in degrees, up to its speed.
TEST(MachineFreeWalls, ADrivenWheelTurns) {
    json document = press_machine();
    document["walls"]["wheel"] = json::parse(R"({"rectangle": {"corner": [0.004, 0.004, 0.036], "along": [0.002, 0, 0],
        "across": [0, 0, 0.002]}, "motion": [{"drive": {"axis": [0, 0, 1], "through": [0.005, 0.004, 0],
        "torque": "1e-3 N m", "inertia": "2e-3 kg m2", "speed_at_most": 2}}]})");
    document["domain"]["periodic"] = {0, 0, 0};
    document["phases"] = json::parse(R"([{"name": "settle", "for": 0}, {"name": "press", "for": 0.1, "frames": 2},
                                         {"name": "rest", "for": 0},
                                         {"name": "hold", "for": 0}])");
    document["measure"] =
        json::parse(R"({"angle": {"wall_angle": {"wall": "wheel", "axis": [0, 0, 1]}, "as": "max"}})");
    const auto seen = answer_of(spec_of(document)).scalars;
    EXPECT_NEAR(seen.at("angle"), 0.5 * 0.5 * 0.01 * 180 / 3.14159265, 1e-3);
}

// A plate of 9.5 x 10 x 4 mm and 0.6 g falls into the powder, which carries it; held until its phase.
TEST(MachineFreeWalls, AFreeBodyFallsOntoPowder) {
    json document = press_machine();
    document["walls"]["lid"] = json::parse(R"({"box": {"low": [0.001, 0.001, 0.032], "high": [0.0105, 0.011, 0.036]},
        "motion": [{"free": {"mass": "0.6 g", "speed_at_most": 2, "held": [1, 1, 0]}, "during": ["press", "rest"]}]})");
    document["domain"]["periodic"] = {0, 0, 0};
    for (const char* side : {"left", "right", "front", "back"}) {
        const std::string name = side;
        const bool x = name == "left" || name == "right", high = name == "right" || name == "back";
        json& wall = document["walls"][name];
        wall["plane"]["point"] = {x && high ? 0.012 : 0, !x && high ? 0.012 : 0, 0};
        wall["plane"]["normal"] = {x ? (high ? -1 : 1) : 0, x ? 0 : (high ? -1 : 1), 0};
    }
    document["measure"].erase("carried");
    document["measure"]["way"]["wall_position"]["of"] = {0.00575, 0.006, 0.034};
    document["measure"]["turned"] = json::parse(R"({"wall_angle": {"wall": "lid", "axis": [1, 0, 0]},
                                                    "during": "hold", "as": "max"})");
    const auto seen = answer_of(spec_of(document)).scalars;
    EXPECT_EQ(seen.at("before"), 0);
    EXPECT_GT(seen.at("way"), 0.008);
    EXPECT_EQ(seen.at("held"), 0);
    EXPECT_NEAR(seen.at("load"), 0.0006 * 9.81, 0.02 * 0.0006 * 9.81);
    EXPECT_GT(std::abs(seen.at("turned")), 0.01);
    EXPECT_LT(std::abs(seen.at("turned")), 90);
}

TEST(MachineFreeWalls, HaveOneSentenceWhereTheyAreWrong) {
    const auto refusal = [](const char* path, const char* value) {
        json document = press_machine();
        document[json::json_pointer(path)] = json::parse(value);
        try {
            (void)spec_of(document);
        } catch (const std::exception& wrong) {
            return std::string(wrong.what());
        }
        return std::string("accepted");
    };
    const char* press = "/walls/lid/motion/0/press";
    EXPECT_NE(refusal(press, R"({"along": [0, 0, -1], "force": 1, "mass": 1})").find("'speed_at_most' is missing"),
              std::string::npos);
    EXPECT_NE(refusal(press, R"({"along": [0, 0, -1], "force": "1 kg", "mass": 1, "speed_at_most": 1})")
                  .find("'kg' does not fit 'N'"),
              std::string::npos);
    EXPECT_NE(refusal(press, R"({"along": [0, 0, 0], "force": 1, "mass": 1, "speed_at_most": 1})")
                  .find("a direction must not be 0"),
              std::string::npos);
    EXPECT_NE(refusal(press, R"({"along": [0, 0, -1], "force": 1, "mass": 0, "speed_at_most": 1})")
                  .find("must be a number above 0, kg"),
              std::string::npos);
    EXPECT_NE(refusal("/walls/lid/motion/0/drive", R"({"axis": [0, 0, 1], "torque": 1, "inertia": 1,
                                                       "speed_at_most": 1})")
                  .find(R"(a motion is one of "rotate", "shift", "convey", "vibrate", "press", "drive" and "free")"),
              std::string::npos);
    const auto refusal_of_free = [&](const char* value) {
        return refusal("/walls/lid/motion/0", (std::string(R"({"free": )") + value + "}").c_str());
    };
    EXPECT_NE(
        refusal_of_free(R"({"mass": 1, "speed_at_most": 1})").find(R"(of this shape it needs "centre" and "inertia")"),
        std::string::npos);
    EXPECT_NE(refusal_of_free(R"({"mass": 1, "speed_at_most": 1, "centre": [0, 0, 0], "inertia": [1, 1, 3]})")
                  .find("none is more than the sum of the others"),
              std::string::npos);
    EXPECT_NE(refusal_of_free(R"({"mass": 1, "speed_at_most": 1, "centre": [0, 0, 0], "inertia": [1, 1, 1]})")
                  .find("a wall without end cannot move freely"),
              std::string::npos);
}

// A block fell through the floor, and the case was complete.
TEST(MachineFreeWalls, ABodyThatPassesThroughAWallIsRefused) {
    const auto fault_on = [](const char* floor, int frames) {
        json document = json::parse(R"json({
          "name": "block",
          "domain": {"low": [-0.05, -0.05, -0.05], "high": [0.05, 0.05, 0.1]},
          "materials": {"rock": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.25}},
          "species": {"sand": {"diameter": "3 mm"}},
          "walls": {"block": {"box": {"low": [-0.01, -0.01, 0.01], "high": [0.01, 0.01, 0.03]},
            "motion": [{"free": {"mass": 0.05, "speed_at_most": 2}}]}},
          "fill": [{"species": "sand", "spheres": [{"at": [0.04, 0.04, 0.06]}]}],
          "phases": [{"name": "fall", "for": 0.08}],
          "measure": {"z": {"wall_position": {"wall": "block", "along": [0, 0, 1]}, "as": "last"}}})json");
        document["walls"]["floor"] = json::parse(floor);
        document["phases"][0]["frames"] = frames;
        machine::Run run(spec_of(document), 1);
        run.advance(1e9);
        return run.health().reason;
    };
    const std::string passed = "free wall 'block' has passed through wall 'floor' before 0.064 s, at (";
    EXPECT_EQ(fault_on(R"({"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}})", 10).substr(0, passed.size()), passed);
    EXPECT_EQ(
        fault_on(R"({"rectangle": {"corner": [-0.02, -0.02, 0], "along": [0.04, 0, 0], "across": [0, 0.04, 0]}})", 10)
            .substr(0, passed.size()),
        passed);
    EXPECT_NE(fault_on(R"({"plane": {"point": [0, 0, 0], "normal": [0, 0, 1]}})", 1), "");
    EXPECT_EQ(fault_on(R"({"plane": {"point": [0, 0, -0.02], "normal": [0, 0, 1]}})", 10), "");
    EXPECT_EQ(
        fault_on(R"({"rectangle": {"corner": [0.011, -0.02, 0], "along": [0.02, 0, 0], "across": [0, 0.04, 0]}})", 10),
        "");
}

}  // namespace grainsweep::tests::machine_free_walls_test
