// Loads of pressed and driven walls that change with time, against the integral of their course.
#include "tests/support/wrong_machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace grainsweep::tests::machine_loads_test {

using nlohmann::json;

/// A plate of 0.1 kg that nothing touches, beside one grain.
json lone_plate(const char* motion) {
    json machine = json::parse(R"json({
      "name": "plate",
      "gravity": [0, 0, 0],
      "domain": {"low": [-1, -1, -1], "high": [1, 1, 1]},
      "materials": {"rock": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.25}},
      "species": {"sand": {"diameter": "3 mm"}},
      "walls": {"plate": {"rectangle": {"corner": [-0.01, -0.01, 0], "along": [0.02, 0, 0], "across": [0, 0.02, 0]}}},
      "fill": [{"species": "sand", "spheres": [{"at": [0.5, 0.5, 0.5]}]}],
      "phases": [{"name": "wait", "for": 0.1, "frames": 1}, {"name": "push", "for": 0.4, "frames": 1}],
      "measure": {
        "way": {"wall_position": {"wall": "plate", "along": [0, 0, 1]}, "as": "last"},
        "turned": {"wall_angle": {"wall": "plate", "axis": [0, 0, 1]}, "as": "last"}
      }
    })json");
    machine["walls"]["plate"]["motion"] = {json::parse(motion)};
    return machine;
}

double seen_in(const char* motion, const char* measure, const char* precision) {
    return answer_of(spec_of(lone_plate(motion), {{"precision", precision}})).scalars.at(measure);
}

TEST(MachineLoads, APressFollowsTheCourseOfItsForce) {
    // F = 0.05 N/s t from the phase on: way = 0.05 t^3/(6 m).
    const double expected = 0.05 * std::pow(0.4, 3) / (6 * 0.1);
    for (const char* precision : {"double", "mixed"}) {
        const double table =
            seen_in(R"json({"press": {"along": [0, 0, 1], "times": [0, 1], "forces": [0, 0.05], "mass": 0.1,
            "speed_at_most": 1}, "from": "push"})json",
                    "way", precision);
        EXPECT_NEAR(table / expected, 1, 2e-3) << precision;
        const double expression =
            seen_in(R"json({"press": {"along": [0, 0, 1], "force": "0.05*t", "every": 0.05, "until": 1,
            "mass": 0.1, "speed_at_most": 1}, "from": "push"})json",
                    "way", precision);
        EXPECT_NEAR(expression, table, 1e-9) << precision;
    }
}

// A punch that its limit alone held back looked like one in equilibrium with its force.
TEST(MachineLoads, APressThatMovesAtItsLimitAtTheEndIsNamed) {
    const auto remark_with = [](const char* limit) {
        json machine = lone_plate(R"json({"press": {"along": [0, 0, 1], "force": 0.02, "mass": 0.1}})json");
        machine["walls"]["plate"]["motion"][0]["press"]["speed_at_most"] = limit;
        machine::Run run(spec_of(machine), 1);
        run.advance(1e9);
        return run.remark();
    };
    EXPECT_EQ(
        remark_with("50 mm/s"),
        "at the end wall 'plate' still moves at its speed_at_most of 0.05 m/s: the powder does not carry its force");
    EXPECT_EQ(remark_with("1 m/s"), "");
}

// The same of a wheel, and of a body that falls out of the machine.
TEST(MachineLoads, ADriveAndABodyAtTheirLimitAtTheEndAreNamed) {
    const auto wheel = [](const char* limit) {
        json machine = lone_plate(R"json({"drive": {"axis": [0, 0, 1], "torque": 1e-4, "inertia": 1e-5}})json");
        machine["walls"]["plate"]["motion"][0]["drive"]["speed_at_most"] = limit;
        machine::Run run(spec_of(machine), 1);
        run.advance(1e9);
        return run.remark();
    };
    EXPECT_EQ(
        wheel("2 rad/s"),
        "at the end wall 'plate' still turns at its speed_at_most of 2 rad/s: the powder does not carry its torque");
    EXPECT_EQ(wheel("100 rad/s"), "");
    const auto body = [](const char* limit) {
        json machine =
            lone_plate(R"json({"free": {"mass": 0.1, "inertia": [1e-5, 1e-5, 1e-5], "force": [0, 0, 0.1]}})json");
        machine["walls"]["plate"].erase("rectangle");
        machine["walls"]["plate"]["triangles"] = json::parse(R"json([[[0, 0, 0], [0, 0.01, 0], [0.01, 0, 0]],
            [[0, 0, 0], [0.01, 0, 0], [0, 0, 0.01]], [[0, 0, 0], [0, 0, 0.01], [0, 0.01, 0]],
            [[0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]]])json");
        machine["walls"]["plate"]["motion"][0]["free"]["speed_at_most"] = limit;
        machine::Run run(spec_of(machine), 1);
        run.advance(1e9);
        return run.remark();
    };
    EXPECT_EQ(
        body("0.1 m/s"),
        "at the end wall 'plate' still moves at its speed_at_most of 0.1 m/s: without this bound it would be faster");
    EXPECT_EQ(body("1 m/s"), "");
}

// The bucket rises by 0.02 m and then turns by half about z = 0.03 m. Its axis, drawn at 0.01 m, rises with it.
TEST(MachineLoads, TheAxisOfARotationMovesWithTheWall) {
    json machine = lone_plate(R"json({"shift": {"velocity": [0, 0, 0.2]}, "from": "wait", "to": "wait"})json");
    machine["walls"]["plate"]["motion"].push_back(json::parse(
        R"json({"rotate": {"axis": [0, 1, 0], "through": [0, 0, 0.01], "speed": "pi/0.4"}, "from": "push", "to": "push"})json"));
    machine["measure"] =
        json::parse(R"json({"way": {"wall_position": {"wall": "plate", "along": [0, 0, 1]}, "as": "last"}})json");
    EXPECT_NEAR(answer_of(spec_of(machine)).scalars.at("way"), 0.04, 1e-5);
}

TEST(MachineLoads, BeforeAndAfterItsTimesALoadIsThatOfTheEnds) {
    // 0.02 N until 0.2 s, then falling to 0 at 0.3 s.
    const double m = 0.1, f = 0.02, speed = f * 0.2 / m + f * 0.1 / (2 * m);
    const double way = f / (2 * m) * 0.04 + f * 0.2 / m * 0.1 + f / m * (0.01 / 2 - 0.001 / (6 * 0.1)) + speed * 0.1;
    EXPECT_NEAR(seen_in(R"json({"press": {"along": [0, 0, 1], "times": [0.2, 0.3], "forces": [0.02, 0], "mass": 0.1,
                    "speed_at_most": 1}, "from": "push"})json",
                        "way", "double") /
                    way,
                1, 2e-3);
}

TEST(MachineLoads, ADriveFollowsTheCourseOfItsTorque) {
    const double expected = 1e-4 * std::pow(0.4, 3) / (6 * 1e-5) * 180 / std::numbers::pi;  // degrees
    for (const char* precision : {"double", "mixed"})
        EXPECT_NEAR(seen_in(R"json({"drive": {"axis": [0, 0, 1], "times": [0, 2], "torques": [0, 2e-4], "inertia": 1e-5,
                        "speed_at_most": 10}, "from": "push"})json",
                            "turned", precision) /
                        expected,
                    1, 2e-3)
            << precision;
}

/// Way of a damped oscillator that a constant load moves from rest: load/k (1 - e^-at (cos wt + a/w sin wt)).
double sprung_way(double load, double stiffness, double damping, double inertia, double t) {
    const double a = damping / (2 * inertia), w = std::sqrt(stiffness / inertia - a * a);
    return load / stiffness * (1 - std::exp(-a * t) * (std::cos(w * t) + a / w * std::sin(w * t)));
}

TEST(MachineLoads, SpringsAndDampersOscillateAsInTheory) {
    for (const char* precision : {"double", "mixed"}) {
        EXPECT_NEAR(seen_in(R"json({"press": {"along": [0, 0, 1], "force": "20 mN", "mass": 0.1, "speed_at_most": 1,
                        "stiffness": "10 N/m", "damping": "0.4 N s/m"}, "from": "push"})json",
                            "way", precision) /
                        sprung_way(0.02, 10, 0.4, 0.1, 0.4),
                    1, 1e-3)
            << precision;
        EXPECT_NEAR(seen_in(R"json({"drive": {"axis": [0, 0, 1], "torque": 1e-3, "inertia": 1e-5, "speed_at_most": 100,
                        "stiffness": "4 N mm/rad", "damping": 1e-4}, "from": "push"})json",
                            "turned", precision) /
                        (sprung_way(1e-3, 4e-3, 1e-4, 1e-5, 0.4) * 180 / std::numbers::pi),
                    1, 1e-3)
            << precision;
    }
}

TEST(MachineLoads, TheTimeStepFollowsStiffSprings) {
    const auto longest = [](const char* spring) {
        json machine =
            lone_plate(R"json({"press": {"along": [0, 0, 1], "force": 0.02, "mass": 0.1, "speed_at_most": 1}})json");
        machine["walls"]["plate"]["motion"][0]["press"].update(json::parse(spring));
        return machine::time_step_of(spec_of(machine), 1, 1);
    };
    EXPECT_EQ(longest("{}"), longest(R"({"stiffness": 1e4, "damping": 1})"));
    EXPECT_NEAR(longest(R"({"stiffness": "1 GN/m"})"), std::sqrt(0.1 * 0.1 / 1e9), 1e-12);
    EXPECT_NEAR(longest(R"({"damping": 1e5})"), 0.05 * 0.1 / 1e5, 1e-15);
}

TEST(MachineLoads, ACheckpointKeepsTheCourse) {
    const json machine =
        lone_plate(R"json({"press": {"along": [0, 0, 1], "force": "0.05*sin(20*t)", "every": 0.01, "until": 0.5,
        "mass": 0.1, "speed_at_most": 1, "stiffness": 2, "damping": 0.1}})json");
    expect_same_resumed(machine, 0.2);
}

/// Refusal of the plate with two motions; "accepted" without one.
std::string refusal_of_two(std::string first, const std::string& second) {
    json machine = lone_plate(first.c_str());
    machine["walls"]["plate"]["motion"].push_back(json::parse(second));
    return refusal_of(machine);
}

std::string press(const char* along, const char* when) {
    return R"({"press": {"force": 0.02, "mass": 0.1, "speed_at_most": 1, "along": )" + std::string(along) + "}, " +
           when + "}";
}

// Each press took the whole load: 0.5 N and 2 N gave 1.16 N or 0.76 N.
TEST(MachineLoads, OnlyOnePressActsAlongALine) {
    const std::string early = press("[0, 0, -1]", R"("to": "wait")"), late = press("[0, 0, 1]", R"("from": "push")");
    const std::string always = press("[0, 0, 1]", R"("from": "wait")"),
                      across = press("[1, 0, 0]", R"("from": "wait")");
    const std::string sentence =
        "$.walls.plate.motion: a wall is pressed along one line by one press at a time; add the forces, or press "
        "across.";
    EXPECT_EQ(refusal_of_two(always, late), sentence);
    EXPECT_EQ(refusal_of_two(late, always), sentence);
    EXPECT_EQ(refusal_of_two(always, press("[0.6, 0, 0.8]", R"("from": "wait")")), sentence);
    EXPECT_EQ(refusal_of_two(always, press("[0, 0, 1]", R"("from": "0.3 s")")), sentence);
    EXPECT_EQ(refusal_of_two(early, late), "accepted");
    EXPECT_EQ(refusal_of_two(always, across), "accepted");
    EXPECT_EQ(refusal_of_two(early, press("[0, 0, 1]", R"("from": "0.1 s")")), "accepted");
}

TEST(MachineLoads, AShiftActsAcrossAPressOrAtAnotherTime) {
    const std::string shift = R"({"shift": {"velocity": [0, 0, 0.1]}, "from": "wait", "to": "wait"})";
    const std::string sentence =
        "$.walls.plate.motion: along the line of a press only its force and the powder move a wall; the other motion "
        "must lie across it, or act at another time.";
    EXPECT_EQ(refusal_of_two(shift, press("[0, 0, 1]", R"("from": "wait")")), sentence);
    EXPECT_EQ(refusal_of_two(press("[0, 0, 1]", R"("from": 0)"),
                             R"({"follow": {"times": [0, 0.1], "positions": [[0, 0, 0], [0, 0, 0.01]]}})"),
              sentence);
    EXPECT_EQ(refusal_of_two(shift, press("[1, 0, 0]", R"("from": "wait")")), "accepted");
    EXPECT_EQ(refusal_of_two(shift, press("[0, 0, 1]", R"("from": "push")")), "accepted");
}

TEST(MachineLoads, OnlyOneDriveTurnsAWallAboutAnAxis) {
    const auto turning = [](const char* load, const char* axis, const char* when) {
        return std::string("{\"") + load + R"(, "axis": )" + axis + "}, " + when + "}";
    };
    const char* drive = R"(drive": {"torque": 1e-4, "inertia": 1e-5, "speed_at_most": 10)";
    const char* rotate = R"(rotate": {"speed": 1)";
    const std::string driven = turning(drive, "[0, 0, 1]", R"("from": "push")");
    EXPECT_EQ(refusal_of_two(driven, driven),
              "$.walls.plate.motion: a wall is driven about one axis by one drive; add the torques.");
    EXPECT_EQ(refusal_of_two(turning(rotate, "[0, 0, -1]", R"("from": "wait")"), driven),
              "$.walls.plate.motion: about the axis of a drive only its torque and the powder turn a wall; a rotation "
              "about it must act at another time.");
    EXPECT_EQ(refusal_of_two(turning(rotate, "[0, 0, 1]", R"("to": "wait")"), driven), "accepted");
    EXPECT_EQ(refusal_of_two(turning(rotate, "[1, 0, 0]", R"("from": "push")"), driven), "accepted");
    EXPECT_EQ(refusal_of_two(turning(drive, "[0, 0, 1]", R"("to": "wait")"), driven),
              "$.walls.plate.motion: nothing may turn a wall after a drive, or after it moves freely.");
}

}  // namespace grainsweep::tests::machine_loads_test
