// Measurements that depend on no choice of frames: passages, stays, means of loads, times of passing a value, and means
// beside a vibration.
#include "solver/machine/frames.hpp"
#include "solver/machine/plan.hpp"
#include "tests/support/machines.hpp"
#include "tests/support/spheres.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace grainsweep::tests::machine_frames_test {

using nlohmann::json;

constexpr std::array<const char*, 2> precisions = {"mixed", "double"};

json in_box(const char* measures, double duration, std::int64_t frames) {
    json machine = json::parse(R"({
        "name": "m", "gravity": [0, 0, 0], "contacts": {"restitution": 1, "friction": 0},
        "materials": {"p": {"density": 2500, "youngs_modulus": "5 MPa"}, "w": {"youngs_modulus": "5 MPa"}},
        "species": {"b": {"material": "p", "diameter": "2 mm"}},
        "domain": {"low": [-0.05, -0.05, -0.05], "high": [0.05, 0.05, 0.05]}})");
    machine["phases"] = {{{"name", "p"}, {"for", duration}, {"frames", frames}}};
    machine["measure"] = json::parse(measures);
    return machine;
}

json plate(double z, double up) {
    return {{"plane", {{"point", {0, 0, z}}, {"normal", {0, 0, up}}}}, {"material", "w"}};
}

Observations answer(const json& machine, const char* precision) {
    Inputs inputs;
    inputs["precision"] = std::string(precision);
    return answer_of(spec_of(machine, inputs));
}

TEST(MachineFrames, WhatIsFedAndLeavesBetweenTwoFramesPasses) {
    // 2 g/s at 0.5 m/s, 45 mm to the plane and 50 mm on to the end of the domain: 0.2 s on the way.
    for (const char* precision : precisions) {
        std::set<double> found;
        for (const std::int64_t frames : {200, 40, 7, 1}) {
            json machine =
                in_box(R"({"passed": {"passed_mass": {"point": [0, 0, 0], "normal": [0, 0, -1]}, "as": "last"},
                                      "gone": {"discharged_mass": {}, "as": "last"},
                                      "below": {"mass": {"in": {"half_space": {"normal": [0, 0, -1]}}}, "as": "last"}})",
                       1, frames);
            machine["walls"]["a"] = plate(-0.9, 1);
            machine["feed"] = json::parse(R"([{"species": "b", "rate": 0.002, "velocity": [0, 0, -0.5],
                "through": {"box": {"low": [-0.01, -0.01, 0.04], "high": [0.01, 0.01, 0.05]}}}])");
            const Observations seen = answer(machine, precision);
            const double passed = seen.scalars.at("passed");
            EXPECT_NEAR(passed, seen.scalars.at("gone") + seen.scalars.at("below"), 1e-12) << frames;
            EXPECT_GT(passed, 0.0015);
            found.insert(passed);
        }
        EXPECT_EQ(found.size(), 1U) << "the same to the last bit at any number of frames";
    }
}

TEST(MachineFrames, StaysAreExact) {
    // To and fro between two plates at 0.5 m/s: 10 mm in 20 ms. An impact changes the speed by 0.13 % at this step.
    for (const char* precision : precisions) {
        std::set<double> found;
        for (const std::int64_t frames : {1000, 30, 3}) {
            json machine = in_box(
                R"({"stay": {"residence_time": {"along": [0, 0, 1], "from": -0.005, "to": 0.005}, "as": "last"}})", 0.5,
                frames);
            machine["walls"] = {{"a", plate(-0.01, 1)}, {"b", plate(0.01, -1)}};
            machine["fill"] =
                json::parse(R"([{"species": "b", "spheres": [{"at": [0, 0, 0.002], "velocity": [0, 0, 0.5]}]}])");
            found.insert(answer(machine, precision).scalars.at("stay"));
        }
        EXPECT_EQ(found.size(), 1U) << "the same to the last bit";
        EXPECT_NEAR(*found.begin(), 0.02, 5e-5);
    }
}

TEST(MachineFrames, MeansOfLoadsAreImpulsesOverTime) {
    // A sphere between two plates: of the upper one, 2 m v at each of its three impacts, and the torque of this about
    // the y axis, 5 mm away. Between frames nothing is lost.
    for (const char* precision : precisions) {
        std::vector<double> pushes;
        for (const std::int64_t frames : {50, 13, 2}) {
            json machine = in_box(R"({"force": {"wall_force": {"wall": "b", "along": [0, 0, 1]}},
                           "push": {"wall_force": {"wall": "b", "along": [0, 0, 1]}, "as": "integral"},
                           "pressure": {"wall_pressure": {"wall": "b", "along": [0, 0, 1], "area": 0.5}},
                           "torque": {"wall_torque": {"wall": "b", "axis": [0, 1, 0]}},
                           "about": {"wall_torque": {"wall": "b", "axis": [0, 1, 0], "about": [0.005, 0, 0]}}})",
                                  0.2, frames);
            machine["walls"] = {{"a", plate(-0.01, 1)}, {"b", plate(0.01, -1)}};
            machine["fill"] =
                json::parse(R"([{"species": "b", "spheres": [{"at": [0.005, 0, 0], "velocity": [0, 0, 0.5]}]}])");
            const auto seen = answer(machine, precision).scalars;
            const double mass = 2500 * std::acos(-1.0) / 6 * 8e-9, push = seen.at("push");
            pushes.push_back(push);
            EXPECT_NEAR(push, 3 * 2 * mass * 0.5, 1e-3 * push) << "an impact changes the speed by 0.13 %";
            EXPECT_NEAR(seen.at("force"), push / 0.2, 1e-3 * push);
            EXPECT_NEAR(seen.at("pressure"), seen.at("force") / 0.5, 1e-9 * seen.at("pressure"));
            EXPECT_NEAR(seen.at("torque"), -0.005 * seen.at("force"), 1e-6 * push);
            EXPECT_NEAR(seen.at("about"), 0, 1e-6 * push);
        }
        EXPECT_NEAR(pushes[1], pushes[0], 1e-12 * pushes[0]);
        EXPECT_NEAR(pushes[2], pushes[0], 1e-12 * pushes[0]);
    }
}

// One sphere passes z = 0 at 0.05 s of 0.2 s: the mean over frames would be 3/4 of it.
TEST(MachineFrames, WhatCountsAllSoFarIsItsLastValueByDefault) {
    json machine = in_box(
        R"({"default": {"passed_number": {"point": [0, 0, 0], "normal": [0, 0, 1]}},
            "last": {"passed_number": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "as": "last"},
            "mean": {"passed_number": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "as": "mean"},
            "density": {"residence_time_density": {"along": [0, 0, 1], "from": -0.004, "to": 0.004, "longest": 0.1,
                                                   "bins": 2}}})",
        0.2, 15);
    machine["fill"] =
        json::parse(R"([{"species": "b", "spheres": [{"at": [0, 0, -0.005], "velocity": [0, 0, 0.1]}]}])");
    machine["gravity"] = {0, 0, 0};
    const auto found = answer_of(spec_of(machine));
    EXPECT_EQ(found.scalars.at("default"), 1);
    EXPECT_EQ(found.scalars.at("last"), 1);
    EXPECT_NEAR(found.scalars.at("mean"), 0.75, 0.07);
    EXPECT_EQ(found.scalars.contains("default_error"), false) << "a sum has no error of a mean";
    double integral = 0;
    for (const auto& sample : found.series.at("density")) integral += sample.value * 0.05;
    EXPECT_NEAR(integral, 1, 1e-12) << "of the last frame, not the mean of all";
}

TEST(MachineFrames, ResumedOneGivesTheSameBits) {
    for (const char* precision : precisions) {
        json machine = in_box(
            R"({"force": {"wall_force": {"wall": "b", "along": [0, 0, 1]}},
                "stays": {"residence_time": {"along": [0, 0, 1], "from": -0.005, "to": 0.005}},
                "spread": {"residence_time_sd": {"along": [0, 0, 1], "from": -0.005, "to": 0.005}},
                "density": {"residence_time_density": {"along": [0, 0, 1], "from": -0.005, "to": 0.005,
                            "longest": 0.1}, "as": "last_profile"},
                "mass": {"passed_mass": {"point": [0, 0, 0.001], "normal": [0, 0, 1]}},
                "passed": {"passed_number": {"point": [0, 0, 0], "normal": [0, 0, 1]}, "as": "slope"}})",
            0.2, 15);
        machine["walls"] = {{"a", plate(-0.01, 1)}, {"b", plate(0.01, -1)}};
        machine["fill"] =
            json::parse(R"([{"species": "b", "spheres": [{"at": [0.005, 0, 0], "velocity": [0, 0, 0.5]}]}])");
        Inputs inputs;
        inputs["precision"] = std::string(precision);
        const auto spec = spec_of(machine, inputs);
        machine::Run whole(spec, 1), first(spec, 1);
        whole.advance(1);
        Observations expected, found;
        whole.observe(expected);
        Bytes bytes;
        for (const double until : {0.0107, 0.0555, 0.1201}) {
            first.advance(until);
            first.save(bytes);
            machine::Run next(spec, 1);
            next.restore(bytes);
            first.restore(bytes);
        }
        machine::Run last(spec, 1);
        last.restore(bytes);
        last.advance(1);
        last.observe(found);
        EXPECT_EQ(text_of(found), text_of(expected));
    }
}

// Passages of steps that a restored state undoes are no passages.
TEST(MachineFrames, ARestoredEngineForgetsPassagesOfLaterSteps) {
    for (const auto precision : {dem::Method::Precision::mixed, dem::Method::Precision::double_precision}) {
        dem::Setup setup = empty_space();
        setup.spheres = {{{0, 0, 0}, {0.1, 0, 0}, {}, 0.001, true}};
        setup.counting = {{{0.001, 0, 0}, {1, 0, 0}}};
        const auto engine = dem::make_engine(setup, {precision});
        const auto passage = std::llround(0.01 / setup.time_step);
        engine->run(passage / 2);
        std::vector<std::byte> bytes;
        engine->save(bytes);
        engine->run(passage);
        engine->restore(bytes);
        std::vector<dem::Crossing> found;
        engine->take_crossings(found);
        EXPECT_TRUE(found.empty());
        engine->run(passage);
        engine->take_crossings(found);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_NEAR(found[0].steps * setup.time_step, 0.01, 1e-6);
    }
}

TEST(MachineFrames, TimesOfPassingLieBetweenFrames) {
    const auto samples = [](std::initializer_list<std::pair<double, double>> all) {
        std::vector<Sample> made;
        for (const auto& [time, value] : all) made.push_back({.time = time, .value = value});
        return made;
    };
    const auto rising = samples({{0, 0}, {1, 2}, {2, 6}});
    EXPECT_EQ(machine::crossing_time(rising, 3, true), 1.25);
    EXPECT_EQ(machine::crossing_time(rising, -1, true), 0);
    EXPECT_EQ(machine::crossing_time(rising, 7, true), std::nullopt);
    EXPECT_EQ(machine::crossing_time(samples({{0, 4}, {2, 0}}), 1, false), 1.5);
    EXPECT_EQ(machine::crossing_time({}, 1, false), std::nullopt);
}

json trough() {
    return json::parse(R"({
        "name": "trough", "contacts": {"friction": 0.6, "rolling_friction": 0.3},
        "materials": {"g": {"density": 2500, "youngs_modulus": "5 MPa"}, "s": {"youngs_modulus": "5 MPa"}},
        "species": {"b": {"material": "g", "diameter": "4 mm"}},
        "domain": {"low": [0, 0, "-5 mm"], "high": ["40 mm", "20 mm", "40 mm"], "sides": ["periodic", "periodic", "open"]},
        "walls": {"floor": {"plane": {"normal": [0, 0, 1]}, "material": "s",
            "motion": [{"vibrate": {"amplitude": ["0.05 mm", 0, 0], "frequency": "50 Hz"}, "from": "convey"}]}},
        "fill": [{"species": "b", "count": 60,
                  "in": {"box": {"low": [0, 0, 0], "high": ["40 mm", "20 mm", "30 mm"]}}}],
        "phases": [{"name": "settle", "for": "0.2 s"}, {"name": "convey", "for": "1 s", "frames": 50}],
        "measure": {"speed": {"velocity": {"along": [1, 0, 0]}, "during": "convey"}}})");
}

TEST(MachineFrames, ScatteredOnesMeetEveryPhaseOfAMotion) {
    constexpr std::int64_t frames = 100;
    double before = -1, sine = 0, cosine = 0;
    for (std::int64_t k = 0; k <= frames; ++k) {
        const double share = machine::share_of_frame(k, frames, true);
        EXPECT_GT(share, before);
        before = share;
        if (k == 0 || k == frames) continue;
        // One period of the motion for each interval.
        const double phase = 2 * std::acos(-1.0) * static_cast<double>(frames) * share;
        sine += std::sin(phase) / 99, cosine += std::cos(phase) / 99;
    }
    EXPECT_EQ(before, 1);
    EXPECT_LT(std::hypot(sine, cosine), 0.02) << "1 for equal frames";
    EXPECT_EQ(machine::share_of_frame(3, 12, false), 0.25);
}

TEST(MachineFrames, InStepWithAVibrationAreFoundAndWarnedOf) {
    json machine = trough();
    const auto frames = [&](std::optional<std::int64_t> count) {
        machine["phases"][1].erase("frames");
        if (count) machine["phases"][1]["frames"] = *count;
        return spec_of(machine);
    };
    const auto warned = [](const machine::Spec& spec) {
        const auto all = machine::warnings_of(spec);
        return std::ranges::count(all, "frames in step with a motion", &Warning::kind);
    };
    for (const std::int64_t count : {1, 5, 10, 25, 50, 100, 200}) {
        ASSERT_TRUE(machine::in_step(frames(count), 1).has_value()) << count;
        EXPECT_EQ(machine::in_step(frames(count), 1)->wall, "floor");
        EXPECT_EQ(warned(frames(count)), count < 10 ? 0 : 1) << count;
    }
    EXPECT_EQ(machine::in_step(frames(100), 1)->phases, 2);
    for (const std::int64_t count : {7, 49, 51, 81, 123, 500, 5000}) {
        EXPECT_FALSE(machine::in_step(frames(count), 1).has_value()) << count;
        EXPECT_EQ(warned(frames(count)), 0) << count;
    }
    EXPECT_FALSE(machine::in_step(frames(50), 0).has_value()) << "nothing moves in this phase";
    EXPECT_EQ(warned(frames(std::nullopt)), 0) << "these are scattered";
}

TEST(MachineFrames, NothingIsConveyedByAVibrationWithoutADirection) {
    json machine = trough();
    machine["phases"][1].erase("frames");
    const auto seen = answer_of(spec_of(machine)).scalars;
    // In step with the floor the powder would seem to move at about 0.6 of 2 pi 50 Hz 0.05 mm = 16 mm/s.
    EXPECT_LT(std::abs(seen.at("speed")), 4 * seen.at("speed_error"));
    EXPECT_LT(std::abs(seen.at("speed")), 1e-3);
}

json fed_chute() {
    return json::parse(R"({
        "name": "chute", "gravity": {"size": 9.81, "tilt": 0.45}, "contacts": {"friction": 0.5, "rolling_friction": 0.1},
        "materials": {"g": {"density": 2500, "youngs_modulus": "5 MPa"}, "s": {"youngs_modulus": "5 MPa"}},
        "species": {"b": {"material": "g", "diameter": "4 mm"}},
        "domain": {"low": [0, 0, "-5 mm"], "high": ["120 mm", "20 mm", "60 mm"], "sides": ["open", "periodic", "open"]},
        "walls": {"floor": {"plane": {"normal": [0, 0, 1]}, "material": "s"}},
        "feed": [{"species": "b", "rate": 0.05, "velocity": [0.3, 0, 0],
                  "through": {"box": {"low": [0.004, 0, 0.004], "high": [0.02, 0.02, 0.02]}}}],
        "phases": [{"name": "start", "for": "0.5 s"}, {"name": "convey", "for": "1 s"}],
        "measure": {"speed": {"velocity": {"along": [1, 0, 0]}, "during": "convey"},
                    "load": {"wall_force": {"wall": "floor", "along": [0, 0, -1]}, "during": "convey"},
                    "held": {"mass": {}, "during": "convey"}, "height": {"mean_height": {}, "during": "convey"},
                    "motion": {"kinetic_energy": {}, "during": "convey"},
                    "flow": {"passed_mass": {"point": [0.1, 0, 0], "normal": [1, 0, 0]}, "during": "convey",
                             "as": "slope"}}})");
}

json small_drum() {
    return json::parse(R"({
        "name": "drum", "contacts": {"friction": 0.5, "rolling_friction": 0.05},
        "materials": {"g": {"density": 2500, "youngs_modulus": "5 MPa"}, "s": {"youngs_modulus": "5 MPa"}},
        "species": {"b": {"material": "g", "diameter": "5 mm"}},
        "domain": {"low": [0, null, null], "high": [0.02, null, null], "sides": ["periodic", "open", "open"]},
        "walls": {"drum": {"cylinder": {"point": [0.01, 0, 0], "axis": [1, 0, 0], "radius": 0.03}, "material": "s",
                           "motion": [{"rotate": {"axis": [1, 0, 0], "speed": 6}}]}},
        "fill": [{"species": "b", "count": 150, "in": {"cylinder": {"base": [0, 0, 0], "axis": [1, 0, 0],
                                                                    "radius": 0.03, "length": 0.02}}}],
        "phases": [{"name": "settle", "for": "0.6 s"}, {"name": "convey", "for": "1.3 s"}],
        "measure": {"torque": {"wall_torque": {"wall": "drum", "axis": [1, 0, 0]}, "during": "convey"},
                    "pressure": {"wall_pressure": {"wall": "drum", "along": [0, 0, -1], "area": 0.001},
                                 "during": "convey"},
                    "aside": {"centre": {"along": [0, 1, 0]}, "during": "convey"},
                    "motion": {"kinetic_energy": {}, "during": "convey"},
                    "heat": {"granular_temperature": {}, "during": "convey"},
                    "contacts": {"coordination": {}, "during": "convey"},
                    "power": {"wall_work": {"wall": "drum"}, "during": "convey", "as": "slope"}}})");
}

// Frames change no trajectory: means over some of its moments differ by no more than their errors.
TEST(MachineFrames, MeansAgreeWithinTheirErrorsAtAnyNumberOfFrames) {
    json vibrated = trough();
    for (const auto& [name, probe] : std::initializer_list<std::pair<const char*, json>>{
             {"load", {{"wall_force", {{"wall", "floor"}, {"along", {0, 0, -1}}}}}},
             {"height", {{"mean_height", json::object()}}},
             {"motion", {{"kinetic_energy", json::object()}}}}) {
        vibrated["measure"][name] = probe;
        vibrated["measure"][name]["during"] = "convey";
    }
    vibrated["phases"][1].erase("frames");
    int compared = 0, beyond = 0;
    for (const json& machine : {vibrated, fed_chute(), small_drum()}) {
        std::vector<decltype(Observations::scalars)> seen;
        for (const std::int64_t frames : {300, 100, 30, 10}) {
            machine::Spec spec = spec_of(machine);
            spec.phases[1].frames = frames;  // as by default: scattered where they are in step with a motion
            seen.push_back(answer_of(spec).scalars);
            for (const auto& [name, value] : seen.front()) {
                const std::string error = name + "_error";
                if (!seen.front().contains(error) || !seen.back().contains(error) || seen.size() == 1) continue;
                const double apart = std::abs(seen.back().at(name) - value),
                             allowed = std::hypot(seen.back().at(error), seen.front().at(error));
                EXPECT_LT(apart, 3 * allowed + 1e-9 * std::abs(value)) << machine["name"] << " " << name << frames;
                ++compared;
                beyond += apart > 1.96 * allowed + 1e-9 * std::abs(value) ? 1 : 0;
            }
        }
    }
    EXPECT_GT(compared, 30);
    EXPECT_LT(beyond, 0.1 * compared) << compared;
}

}  // namespace grainsweep::tests::machine_frames_test
