// A machine as it runs: slices, checkpoints and threads change no bit; phases end by their conditions; walls come, go
// and move with phases.
#include "stats/random.hpp"
#include "sweep/campaign/input_error.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <stdexcept>

namespace grainsweep::tests::machine_run_test {

using Runner = machine::Run;
using machine::Spec;
using nlohmann::json;

std::string answer(Runner& run) {
    Observations observations;
    run.observe(observations);
    return text_of(observations);
}

Bytes saved(const Runner& run) {
    Bytes bytes;
    run.save(bytes);
    return bytes;
}

std::string whole(const Spec& spec, int threads = 1) {
    Runner run(spec, 7);
    run.use_threads(threads);
    run.advance(1e9);
    EXPECT_EQ(run.health().reason, "");
    EXPECT_TRUE(run.finished());
    return answer(run);
}

std::vector<Spec> both_precisions() {
    return {spec_of(small_machine()), spec_of(small_machine(), {{"precision", std::string("double")}})};
}

TEST(MachineRun, SlicesChangeNoBit) {
    for (const Spec& spec : both_precisions()) {
        const std::string at_once = whole(spec);
        EXPECT_NE(at_once.find("passed"), std::string::npos);
        Runner run(spec, 7);
        for (std::uint64_t n = 0; !run.finished(); ++n) {
            const double before = run.time();
            run.advance(run.time() + 2e-3 * stats::Stream(1, n).uniform(0));
            ASSERT_TRUE(run.finished() || run.time() > before);
            if (n % 7 == 0) (void)answer(run), (void)run.snapshot();
        }
        EXPECT_EQ(answer(run), at_once);
        EXPECT_EQ(run.progress(), 1);
    }
}

TEST(MachineRun, TwoThreadsGiveTheSameBits) {
    const Spec spec = both_precisions()[0];
    EXPECT_EQ(whole(spec, 2), whole(spec, 1));
}

// Twenty moments, spread over phases, feeds and their ends: saved, restored into a new run, gone on.
TEST(MachineRun, AContinuedRunGivesTheSameBits) {
    for (const Spec& spec : both_precisions()) {
        const std::string undisturbed = whole(spec);
        Runner run(spec, 7);
        auto going = std::make_unique<Runner>(spec, 7);
        double end = 0;
        {
            Runner clock(spec, 7);
            clock.advance(1e9);
            end = clock.time();
        }
        for (int moment = 0; moment < 20; ++moment) {
            const double when =
                end * (moment + 0.5 * stats::Stream(2, static_cast<std::uint64_t>(moment)).uniform(0)) / 20;
            run.advance(when);
            going->advance(when);
            const Bytes bytes = saved(*going);
            EXPECT_EQ(bytes, saved(run)) << moment;
            going = std::make_unique<Runner>(spec, 7);
            going->restore(bytes);
            EXPECT_EQ(saved(*going), bytes) << moment;
            EXPECT_EQ(going->time(), run.time());
            EXPECT_EQ(going->progress(), run.progress());
        }
        going->advance(1e9);
        EXPECT_EQ(answer(*going), undisturbed);
        // A finished run, too.
        Runner last(spec, 7);
        last.restore(saved(*going));
        EXPECT_TRUE(last.finished());
        EXPECT_EQ(answer(last), undisturbed);
    }
}

TEST(MachineRun, ARestoreRefusesOtherBytes) {
    const Spec spec = both_precisions()[0];
    Runner run(spec, 7);
    run.advance(0.06);
    const Bytes bytes = saved(run);
    for (const std::size_t length : {std::size_t{0}, std::size_t{7}, bytes.size() / 2, bytes.size() - 1}) {
        Runner other(spec, 7);
        EXPECT_THROW(other.restore(std::span(bytes).first(length)), std::invalid_argument) << length;
    }
}

/// One sphere above a floor, and phases of the test's own.
json falling_sphere() {
    return json::parse(R"({
      "name": "one",
      "domain": {"low": [-0.1, -0.1, -0.1], "high": [0.1, 0.1, 0.2]},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
      "contacts": {"restitution": 0.1},
      "species": {"a": {"diameter": "4 mm"}},
      "walls": {"floor": {"rectangle": {"corner": [-0.05, -0.05, 0], "along": [0.1, 0, 0], "across": [0, 0.1, 0]}}},
      "fill": [{"species": "a", "spheres": [{"at": [0, 0, 0.01]}]}],
      "phases": [{"name": "one", "for": 0.1}],
      "measure": {"height": {"mean_height": {}, "as": "series"}, "there": {"count": {}, "as": "last"}}
    })");
}

Observations of(const json& document) {
    return answer_of(spec_of(document));
}

// It falls 8 mm in sqrt(2 h/g) = 40 ms, bounces a little, and rests: seen sqrt(d/g) = 20 ms after it calmed down.
TEST(MachineRun, APhaseEndsAtRest) {
    json document = falling_sphere();
    document["phases"][0] = {{"name", "one"}, {"until", {{"at_rest", true}}}, {"at_most", 1}};
    auto answer = of(document);
    EXPECT_EQ(answer.scalars.at("one_ended"), 1);
    EXPECT_GT(answer.scalars.at("one_time"), 0.040 + 0.020);
    EXPECT_LT(answer.scalars.at("one_time"), 0.15);
    EXPECT_NEAR(answer.series.at("height").back().value, 0.002, 1e-5);
    document["phases"][0]["at_most"] = 0.05;
    answer = of(document);
    EXPECT_EQ(answer.scalars.at("one_ended"), 0);
    EXPECT_NEAR(answer.scalars.at("one_time"), 0.05, 1e-4);
}

TEST(MachineRun, APhaseEndsWhenARegionIsEmpty) {
    json document = falling_sphere();
    document["phases"][0] = json::parse(R"({"name": "one", "until": {"empty": {"half_space": {"point": [0, 0, 0.005],
                                            "normal": [0, 0, 1]}}}, "at_most": 1})");
    const auto answer = of(document);
    EXPECT_EQ(answer.scalars.at("one_ended"), 1);
    EXPECT_NEAR(answer.scalars.at("one_time"), std::sqrt(2 * 0.005 / 9.81), 0.006) << "checked four times in sqrt(d/g)";
}

// Nothing is below 5 mm for 32 ms, then the sphere is: the mass has not changed for 50 ms after that.
TEST(MachineRun, APhaseEndsWhenAFlowStops) {
    json document = falling_sphere();
    document["phases"][0] =
        json::parse(R"({"name": "one", "until": {"flow_stops": {"quiet": 0.05, "in": {"half_space": {
                                            "point": [0, 0, 0.005], "normal": [0, 0, -1]}}}}, "at_most": 1})");
    const auto answer = of(document);
    EXPECT_EQ(answer.scalars.at("one_ended"), 1);
    EXPECT_NEAR(answer.scalars.at("one_time"), std::sqrt(2 * 0.005 / 9.81) + 0.05, 0.012);
}

TEST(MachineRun, APhaseEndsWhenAMeasurementPasses) {
    json document = falling_sphere();
    document["phases"][0] = json::parse(
        R"({"name": "one", "until": {"measure": "height", "below": "6 mm"}, "at_most": 1, "frames": 1000})");
    document["measure"]["when"] = json::parse(R"({"time_of": "height", "below": "8 mm"})");
    document["measure"]["never"] = json::parse(R"({"time_of": "height", "above": "1 m"})");
    const auto answer = of(document);
    EXPECT_EQ(answer.scalars.at("one_ended"), 1);
    EXPECT_NEAR(answer.scalars.at("one_time"), std::sqrt(2 * 0.004 / 9.81), 0.006);
    EXPECT_NEAR(answer.scalars.at("when"), std::sqrt(2 * 0.002 / 9.81), 0.0011) << "at a frame, each of 1 ms";
    EXPECT_FALSE(answer.scalars.contains("never"));
}

TEST(MachineRun, APhaseEndsAtAFrameWhereItShall) {
    json document = falling_sphere();
    document["phases"][0] =
        json::parse(R"({"name": "one", "until": {"measure": "height", "below": "6 mm"}, "at_most": 1,
                                            "frames": 100, "ends_at_frames": true})");
    const auto answer = of(document);
    EXPECT_EQ(answer.scalars.at("one_ended"), 1);
    EXPECT_NEAR(answer.scalars.at("one_time"), 0.03, 1e-4) << "the first frame after sqrt(2*4 mm/g)";
    ASSERT_EQ(answer.series.at("height").size(), 4U);
    EXPECT_DOUBLE_EQ(answer.series.at("height").back().time, answer.scalars.at("one_time"));
}

// The centre is between 6 and 8 mm from 20.2 to 28.6 ms; frames are each of 1 ms.
TEST(MachineRun, ValuesCountWhileAnotherMeasurementLiesWithinBounds) {
    json document = falling_sphere();
    document["phases"] = json::parse(R"([{"name": "one", "for": 0.01, "frames": 10},
                                         {"name": "two", "for": 0.03, "frames": 30}])");
    document["measure"]["fallen"] =
        json::parse(R"({"centre": {"along": [0, 0, -1]}, "as": "change", "while": {"height": ["6 mm", "8 mm"]}})");
    document["measure"]["late"] = json::parse(
        R"({"centre": {"along": [0, 0, 1]}, "as": "series", "during": "two", "since": "two", "while": {"height": [null, 0.006]}})");
    const auto answer = of(document);
    EXPECT_NEAR(answer.scalars.at("fallen"), 9.81 / 2 * (0.028 * 0.028 - 0.021 * 0.021), 3e-5);
    EXPECT_NEAR(answer.series.at("late").front().time, 0.019, 1e-4) << "29 ms, of which 10 in the first phase";
}

TEST(MachineRun, AMeasurementIsUndefinedWhereItsConditionHolds) {
    json document = small_machine();
    document["phases"][1]["frames"] = 200;
    document["measure"]["twice"] = "2*force";
    document["measure"]["noise"] = "2*force_error";
    const auto names = {"force", "force_error", "twice", "noise"};
    const auto always = of(document);
    json& force = document["measure"]["force"];
    for (const char* condition : {"low < 0", "force > 1e9", "low < 0 && friction > 0"}) {
        force["unless"] = condition;
        const auto answer = of(document);
        for (const char* name : names)
            EXPECT_EQ(answer.scalars.at(name), always.scalars.at(name)) << condition << ": " << name;
    }
    for (const char* condition : {"low > 0", "force < 1e9"}) {
        force["unless"] = condition;
        const auto answer = of(document);
        for (const char* name : names) EXPECT_FALSE(answer.scalars.contains(name)) << condition << ": " << name;
    }
    for (const char* wrong : {"twice > 0", "noise > 0", "highest > 0"}) {
        force["unless"] = wrong;
        EXPECT_THROW(static_cast<void>(of(document)), campaign::InputError) << wrong;
    }
    force["unless"] = "low > 0";
    document["measure"]["low"] = "low";
    EXPECT_THROW(static_cast<void>(of(document)), campaign::InputError) << "an expression of itself";
}

// The floor goes after 60 ms: the sphere falls out of the domain, 0.1 m below, and is lost.
TEST(MachineRun, WallsArePresentInTheirPhases) {
    json document = falling_sphere();
    document["phases"] = json::parse(R"([{"name": "one", "for": 0.06}, {"name": "two", "for": 0.2}])");
    EXPECT_EQ(of(document).scalars.at("lost"), 0);
    document["walls"]["floor"]["during"] = "one";
    EXPECT_EQ(of(document).scalars.at("lost"), 1);
    EXPECT_EQ(of(document).scalars.at("there"), 0);
    document["walls"]["floor"]["during"] = "two";
    EXPECT_EQ(of(document).scalars.at("lost"), 1) << "it comes when the sphere has passed";
    document["walls"]["floor"]["when"] = 0;
    EXPECT_EQ(of(document).scalars.at("lost"), 1);
}

// The floor rises at 0.1 m/s in the second phase, whose beginning is the end of the first, whenever that is.
TEST(MachineRun, MotionsFollowPhases) {
    json document = falling_sphere();
    document["walls"]["floor"]["motion"] = json::parse(R"([{"shift": {"velocity": [0, 0, 0.1]}, "from": "two",
                                                            "to": "two"}])");
    document["phases"] = json::parse(R"([{"name": "one", "until": {"at_rest": true}, "at_most": 1},
                                         {"name": "two", "for": 0.1}, {"name": "three", "for": 0.1}])");
    const auto height = [](const Observations& answer) { return answer.series.at("height").back().value; };
    EXPECT_NEAR(height(of(document)), 0.002 + 0.01, 2e-5);
    document["walls"]["floor"]["motion"][0].erase("to");
    EXPECT_NEAR(height(of(document)), 0.002 + 0.02, 2e-5) << "without end";
    document["walls"]["floor"]["motion"][0] = json::parse(R"({"shift": {"velocity": [0, 0, 0.1]}, "during": "three"})");
    EXPECT_NEAR(height(of(document)), 0.002 + 0.01, 2e-5);
    document["walls"]["floor"]["motion"][0] = json::parse(R"({"shift": {"velocity": [0, 0, 0.1]}, "to": "one"})");
    const auto first = of(document);
    EXPECT_NEAR(height(first), 0.002 + 0.1 * first.scalars.at("one_time"), 5e-5) << "from the start";
    document["walls"]["floor"]["motion"][0] =
        json::parse(R"({"shift": {"velocity": [0, 0, 0.1]}, "from": 0.02, "to": 0.04})");
    EXPECT_NEAR(height(of(document)), 0.002 + 0.002, 2e-5) << "by the clock";
}

// Three steps of 1 mm, 10 ms each, one every 20 ms.
TEST(MachineRun, AMotionMayRepeat) {
    json document = falling_sphere();
    document["phases"] = json::parse(R"([{"name": "one", "for": 0.3}])");
    document["walls"]["floor"]["motion"] = json::parse(R"([{"repeat": 3, "as": "n",
        "shift": {"velocity": [0, 0, 0.1]}, "from": "0.2 + 0.02*n", "to": "0.21 + 0.02*n"}])");
    EXPECT_NEAR(of(document).series.at("height").back().value, 0.002 + 0.003, 2e-5);
    document["walls"]["floor"]["motion"][0]["repeat"] = 0;
    EXPECT_NEAR(of(document).series.at("height").back().value, 0.002, 2e-5);
}

// The frame at the end of a phase is the one at the beginning of the next: counted once.
TEST(MachineRun, AMomentIsMeasuredOnce) {
    json document = falling_sphere();
    document["gravity"] = {0, 0, 0};
    document["fill"][0]["spheres"][0]["velocity"] = {0.1, 0, 0};
    document["phases"] = json::parse(R"([{"name": "one", "for": 0.01, "frames": 1}, {"name": "two", "for": 0.01,
                                         "frames": 1}])");
    document["measure"] = json::parse(R"({"x": {"centre": {"along": [1, 0, 0]}, "as": "series"},
        "layers": {"profile": {"along": [1, 0, 0], "from": -0.0005, "to": 0.0025, "bins": 3, "quantity": "share",
                               "of": "a"}},
        "solid": {"profile": {"along": [1, 0, 0], "from": -0.0005, "to": 0.0025, "bins": 3}}})");
    const auto answer = of(document);
    ASSERT_EQ(answer.series.at("x").size(), 3U);
    EXPECT_NEAR(answer.series.at("x")[1].value, 0.001, 1e-5);
    const double third = 3.14159265358979 / 6 * 6.4e-8 / 3;
    for (const auto& sample : answer.series.at("solid")) EXPECT_NEAR(sample.value, third, 1e-6 * third);
}

// A sphere leaves the region in which it is measured: its last frame there is not the last one.
TEST(MachineRun, WhatTheLastFrameLacksHasNoLastValue) {
    json document = falling_sphere();
    document["gravity"] = {0, 0, 0};
    document["fill"][0]["spheres"][0]["velocity"] = {0.1, 0, 0};
    document["phases"] = json::parse(R"([{"name": "one", "for": 0.02, "frames": 4}])");
    const auto measured = [](double end, const char* as) {
        json measure = json::parse(R"({"centre": {"along": [1, 0, 0], "in": {"box": {"low": [-1, -1, -1]}}}})");
        measure["centre"]["in"]["box"]["high"] = {end, 1, 1};
        measure["as"] = as;
        return measure;
    };
    for (const std::string as : {"first", "max", "last", "change"}) {
        document["measure"][as + "_near"] = measured(0.0012, as.c_str());
        document["measure"][as + "_far"] = measured(0.5, as.c_str());
    }
    const auto answer = of(document);
    EXPECT_NEAR(answer.scalars.at("max_near"), 0.001, 1e-5);
    EXPECT_TRUE(answer.scalars.contains("first_near"));
    EXPECT_FALSE(answer.scalars.contains("last_near"));
    EXPECT_FALSE(answer.scalars.contains("change_near"));
    EXPECT_NEAR(answer.scalars.at("last_far"), 0.002, 1e-5);
    EXPECT_NEAR(answer.scalars.at("change_far"), 0.002, 1e-5);
}

TEST(MachineRun, ExpressionsUseMeasurementsAndOneAnother) {
    json document = falling_sphere();
    document["measure"]["a_quarter"] = "z_half/2";
    document["measure"]["z_half"] = "there/2";
    document["measure"]["absent"] = "never + 1";
    document["measure"]["never"] = json::parse(R"({"time_of": "height", "above": 1})");
    const auto answer = of(document);
    EXPECT_EQ(answer.scalars.at("z_half"), 0.5);
    EXPECT_EQ(answer.scalars.at("a_quarter"), 0.25);
    EXPECT_FALSE(answer.scalars.contains("absent"));
}

}  // namespace grainsweep::tests::machine_run_test
