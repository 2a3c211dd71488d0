// What a case of a machine chooses: files, sizes by a word, checks, glued particles, ends of a phase, names of
// measurements.
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_parameters.hpp"
#include "tests/support/machines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace grainsweep::tests::machine_choices_test {

using nlohmann::json;

/// A box of 40 mm with spheres of 2 mm, at rest for one step.
json box() {
    return json::parse(R"json({
      "name": "choices",
      "parameters": {
        "law": {"words": ["monodisperse", "uniform", "lognormal", "weibull_wide", "file"], "default": "monodisperse"},
        "measured": {"file": "sizes", "default": "none", "only_if": {"law": "file"}},
        "spread": {"default": 0.2, "only_if": {"law": ["uniform", "lognormal"]}},
        "particles": {"whole": true, "default": 60, "bounds": [0, 1000]},
        "held": {"default": 0, "only_if": {"particles": "set"}}
      },
      "let": {"room": "20*bead_largest", "double_room": "2*room"},
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa"}},
      "species": {"bead": {"diameter": "2 mm", "sizes": {"spread": "{law}", "half_width": "spread", "sigma": "spread",
                           "file": "{measured}"}}},
      "walls": {"floor": {"plane": {"normal": [0, 0, 1]}}},
      "fill": [{"species": "bead", "count": "particles", "when": "particles > 0",
                "in": {"box": {"low": [0, 0, 0.001], "high": ["room", "room", "double_room"]}}}],
      "phases": [{"name": "rest", "for": 0}],
      "checks": [{"when": "bead_smallest < 0.0011", "warn": "fine", "that": "{law} has {1000*bead_smallest} mm"}],
      "measure": {"particles": {"count": {}, "as": "first"},
                  "solid": {"volume": {}, "as": "last"},
                  "mean_volume": "bead_volume", "largest": "bead_largest", "none": "if(held > 0, held, nan)"
}
})json");
}

TEST(MachineChoices, AWordChoosesSizesAndAFileBringsThem) {
    const auto machine = machine_of(box());
    for (const std::string law : {"monodisperse", "uniform", "lognormal", "weibull_wide"}) {
        const auto seen = answer_of(campaign::machine_spec(*machine, inputs_of(*machine, {{"law", law}}))).scalars;
        EXPECT_EQ(seen.at("particles"), 60) << law;
        EXPECT_GE(seen.at("largest"), law == "monodisperse" ? 0.002 : 0.00239) << law;
    }
    const std::string sizes = "diameter,number_below\n0.001,0\n0.002,0.5\n0.003,1\n";
    const std::string word = "file:" + campaign::content_hash(sizes) + ":/somewhere/sizes.csv";
    const Inputs inputs = inputs_of(*machine, {{"law", std::string("file")}, {"measured", word}});
    const auto spec = campaign::machine_spec(*machine, inputs, {{"measured", sizes}});
    const auto seen = answer_of(spec).scalars;
    EXPECT_NEAR(seen.at("largest"), 0.003, 1e-12);
    // Uniform from 1 to 3 mm: the mean of d^3 is 10 mm3.
    EXPECT_NEAR(seen.at("mean_volume"), 3.14159265 / 6 * 10e-9, 1e-12);
    ASSERT_EQ(spec.warnings.size(), 1U);
    EXPECT_EQ(spec.warnings[0].kind, "fine");
    EXPECT_EQ(spec.warnings[0].sentence, "file has 1 mm");
    EXPECT_THROW((void)campaign::machine_spec(*machine, inputs), campaign::InputError) << "contents are not given";
}

// A number with a unit is an SI number in an expression, as it is alone.
TEST(MachineChoices, ExpressionsTakeQuantities) {
    const auto plain = [](std::string_view text) { return campaign::with_si_numbers(text); };
    EXPECT_EQ(plain("29 mm - hub"), "(0.029) - hub");
    EXPECT_EQ(plain("0.5*(high + 3 mm)/2 s"), "0.5*(high + (0.003))/(2)");
    EXPECT_EQ(plain("2 mm/hub + 60 rpm"), "(0.002)/hub + (6.283185307179586)");
    EXPECT_EQ(plain("3 mm/s*t"), "(0.003)*t");
    EXPECT_EQ(plain("5 mm/2"), "(0.005)/2");
    EXPECT_EQ(plain("5 m/s2"), "");
    EXPECT_EQ(plain("5 mm/hub"), "");
    EXPECT_EQ(plain("29 mm"), "");
    EXPECT_EQ(plain("1e-3 N m"), "");
    EXPECT_EQ(plain("5 kg m-3"), "");
    EXPECT_EQ(plain("-29 mm"), "");
    EXPECT_EQ(plain("2*hub + 1e-3"), "");
    EXPECT_EQ(plain("x2 + y3"), "");
    EXPECT_EQ(campaign::unclear_quotient("1/2 mm"), "'(1/2)*(1 mm)' or '1/(2 mm)'");
    EXPECT_NE(campaign::unclear_quotient("gap + 5/2.5 mm"), "");
    for (const char* clear : {"1/2", "gap/2 mm", "(1/2)*2 mm", "1/(2 mm)", "29 mm/2", "3 mm/4 mm", "1/2*d"})
        EXPECT_EQ(campaign::unclear_quotient(clear), "") << clear;
    EXPECT_EQ(campaign::value_in_expressions("rpm", 120), "12.57 rad/s");
    EXPECT_EQ(campaign::value_in_expressions("Hz", 25), "");
    EXPECT_EQ(campaign::value_in_expressions("mm", 3), "0.003 m");
}

// A wall that follows a table or an expression is where they say at every stated time.
TEST(MachineChoices, WallsFollowTheTime) {
    auto document = box();
    document["walls"]["floor"]["motion"] = json::parse(R"([{"follow": {"times": [0, "10 ms", 0.03], "positions":
        [[0, 0, 0], [0, 0, "1 mm"], ["2 mm", 0, 0]]}, "from": 0.1}])");
    document["walls"]["lid"] =
        json::parse(R"json({"disc": {"centre": [0, 0, 0.1], "radius": 0.01}, "motion": [{"follow":
        {"angle": "2*pi*t^2", "axis": [0, 0, 1], "every": "5 ms", "until": 0.5}}, {"follow":
        {"position": ["1 mm*sin(40*t)", 0, 0], "every": 1e-3, "until": 0.2
}
}]
})json");
    const auto machine = machine_of(document);
    const auto spec = campaign::machine_spec(*machine, inputs_of(*machine));
    const auto pose = [&](const char* name, double time) {
        for (const auto& wall : spec.walls)
            if (wall.name == name) {
                std::vector<geometry::Motion> motions;
                for (const auto& one : wall.motions) motions.push_back(one.motion);
                return geometry::pose_at(motions, time);
            }
        return geometry::Pose{};
    };
    EXPECT_NEAR(pose("floor", 0.05).shift[2], 0, 1e-15);
    EXPECT_NEAR(pose("floor", 0.105).shift[2], 0.0005, 1e-12);
    EXPECT_NEAR(pose("floor", 0.11).shift[2], 0.001, 1e-12);
    EXPECT_NEAR(pose("floor", 1).shift[0], 0.002, 1e-12);
    EXPECT_NEAR(pose("floor", 1).shift[2], 0, 1e-12);
    EXPECT_NEAR(pose("lid", 0.1).shift[0], 0.001 * std::sin(4.0), 1e-9);
    EXPECT_NEAR(pose("lid", 0.5).rows[0][0], std::cos(2 * 3.14159265358979 * 0.25), 1e-9);
    const auto refused = [&](const char* follow) {
        document["walls"]["floor"]["motion"] = json::array({{{"follow", json::parse(follow)}}});
        try {
            (void)machine_of(document);
        } catch (const campaign::InputError& wrong) {
            return std::string(wrong.what());
        }
        return std::string("accepted");
    };
    const auto says = [&](const char* follow, const char* rule) {
        EXPECT_NE(refused(follow).find(rule), std::string::npos) << refused(follow);
    };
    says(R"({"times": [0, 1, 1], "angles": [0, 1, 2], "axis": [0, 0, 1]})", "times must rise");
    says(R"({"times": [0, 1], "angles": [0], "axis": [0, 0, 1]})", "as many as \"times\": 2");
    says(R"({"times": [0, 1]})", "\"positions\" or \"angles\"");
    says(R"({"angle": "t", "every": 1e-6, "until": 1, "axis": [0, 0, 1]})", "at most 200 are possible");
    says(R"({"angle": "t", "every": 0.1, "until": 1})", "'axis' is missing");
    says(R"({"times": [0, 1], "positions": [[0, 0, "5 mm"], [0, 0, "5 mm"]]})",
         "its first position is [0, 0, 0.005], and must be 0");
    says(R"({"angle": "0.5 + t", "every": 0.1, "until": 1, "axis": [0, 0, 1]})", "its first angle is 0.5");
    says(R"({"position": ["1/t", 0, 0], "every": 0.1, "until": 1})", "no finite value");
}

TEST(MachineChoices, ParametersSayWhenTheyMatter) {
    const auto machine = machine_of(box());
    const auto of = [&](std::string_view name) {
        return std::ranges::find(machine->parameters, name, &ParameterSpec::name)->relevant_if;
    };
    ASSERT_EQ(of("spread").size(), 1U);
    EXPECT_EQ(of("spread")[0].condition, Relevance::Condition::is_word);
    EXPECT_EQ(of("spread")[0].words, (std::vector<std::string>{"uniform", "lognormal"}));
    EXPECT_EQ(of("held")[0].condition, Relevance::Condition::nonzero);
    EXPECT_TRUE(
        std::get<Words>(machine
                            ->parameters[std::ranges::find(machine->parameters, "measured", &ParameterSpec::name) -
                                         machine->parameters.begin()]
                            .bounds)
            .file_allowed);
}

TEST(MachineChoices, AnExpressionMayHaveNoValue) {
    EXPECT_FALSE(answer_of(spec_of(box())).scalars.contains("none"));
    EXPECT_EQ(answer_of(spec_of(box(), {{"held", 2.0}})).scalars.at("none"), 2);
}

TEST(MachineChoices, GluedParticlesArePartOfAWall) {
    json document = box();
    document["measure"].erase("particles");
    document["measure"]["height"] = json::parse(R"({"mean_height": {}, "as": "last"})");
    document["fill"].push_back(json::parse(R"({"species": "bead", "count": 200, "as": "random", "glued": true,
        "shaken": 0.1, "in": {"box": {"low": [0, 0, -0.002], "high": ["room", "room", 0]}}})"));
    document["walls"]["floor"]["plane"]["point"] = {0, 0, -0.002};
    document["phases"] = json::parse(R"([{"name": "fall", "until": {"at_rest": true}, "at_most": 1}])");
    document["domain"] = json::parse(R"({"low": [0, 0, null], "high": ["room", "room", null], "periodic": [1, 1, 0]})");
    machine::Run run(spec_of(document), 3);
    run.advance(1e9);
    Observations seen;
    run.observe(seen);
    EXPECT_EQ(seen.scalars.at("fall_ended"), 1);
    EXPECT_EQ(seen.scalars.at("particles"), 60) << "without the glued ones";
    EXPECT_GT(seen.scalars.at("height"), -0.0008) << "many lie on glued ones";
    const auto picture = run.snapshot();
    int still = 0;
    for (const auto& x : picture.positions) still += std::abs(x[2] + 0.001) < 1e-9 ? 1 : 0;
    EXPECT_GE(still, 200) << "centres of the glued layer stay half a diameter below z = 0";
}

// Free fall from rest, 9.81 m/s2: 4 mm after 28.6 ms, 8 mm after 40.4 ms.
TEST(MachineChoices, WhateverHoldsFirstEndsAPhase) {
    json document = box();
    document["fill"] = json::parse(R"([{"species": "bead", "spheres": [{"at": [0, 0, 0.02]}]}])");
    document["measure"] = json::parse(R"({"height": {"mean_height": {}, "as": "last"},
                                          "fallen": {"mean_height": {}, "as": "change", "during": "fall"}})");
    const json four = {{"measure", "height"}, {"below", 0.016}}, eight = {{"measure", "height"}, {"below", 0.012}};
    document["phases"] = json::parse(R"([{"name": "fall", "at_most": 1, "frames": 1}])");
    document["phases"][0]["until"] = {eight, four};
    auto seen = answer_of(spec_of(document)).scalars;
    EXPECT_EQ(seen.at("fall_ended"), 2);
    EXPECT_NEAR(seen.at("fall_time"), 0.0286, 0.004);
    EXPECT_NEAR(seen.at("fallen"), -9.81 / 2 * seen.at("fall_time") * seen.at("fall_time"), 2e-5)
        << "a frame at its end";
    document["phases"][0]["until"] = {four, four};
    EXPECT_EQ(answer_of(spec_of(document)).scalars.at("fall_ended"), 1);
    document["phases"][0]["at_most"] = 0.01;
    EXPECT_EQ(answer_of(spec_of(document)).scalars.at("fall_ended"), 0);
}

// A sphere that lands at 0.44 m/s overlaps the floor most within the first phase; between spheres there is nothing.
TEST(MachineChoices, TheDeepestOverlapIsThatOfAllStepsOfItsPhase) {
    json document = box();
    document["fill"] = json::parse(R"([{"species": "bead", "spheres": [
        {"at": [0, 0, 0.02], "velocity": [0, 0, -0.3]}, {"at": [0, 0, 0.0171], "velocity": [0, 0, 0.3]}]}])");
    document["gravity"] = {0, 0, 0};
    document["phases"] = json::parse(R"([{"name": "meet", "for": 0.01, "frames": 1}, {"name": "part", "for": 0.001}])");
    document["measure"] = json::parse(R"({"met": {"overlap": {"over": "steps"}, "as": "max", "during": "meet"},
                                          "seen": {"overlap": {}, "as": "max", "during": "meet"},
                                          "apart": {"overlap": {"over": "steps"}, "as": "max", "during": "part"}})");
    const auto seen = answer_of(spec_of(document)).scalars;
    EXPECT_GT(seen.at("met"), 0.001);
    EXPECT_EQ(seen.at("met"), seen.at("max_overlap"));
    EXPECT_EQ(seen.at("seen"), 0) << "they have parted at both frames";
    EXPECT_EQ(seen.at("apart"), 0);
}

TEST(MachineChoices, TheLastProfileIsThatOfTheLastFrame) {
    json document = box();
    document["fill"] =
        json::parse(R"([{"species": "bead", "spheres": [{"at": [0, 0, 0.02], "velocity": [0, 0, -1]}]}])");
    document["gravity"] = {0, 0, 0};
    document["phases"] = json::parse(R"([{"name": "fly", "for": 0.01, "frames": 2}])");
    const char* along = R"({"profile": {"along": [0, 0, 1], "from": 0, "to": 0.03, "bins": 3}})";
    document["measure"] = {{"all", json::parse(along)}, {"last", json::parse(along)}};
    document["measure"]["last"]["as"] = "last_profile";
    const auto seen = answer_of(spec_of(document)).series;
    const auto filled_bins = [&](const char* name) {
        return std::ranges::count_if(seen.at(name), [](const Sample& bin) { return bin.value > 0; });
    };
    EXPECT_EQ(filled_bins("last"), 1);
    EXPECT_GE(filled_bins("all"), 2);
}

// Half of the spheres start beside the floor and fall out before the second phase.
TEST(MachineChoices, AVesselThatDoesNotHoldItsFillingIsNamed) {
    json document = box();
    document["walls"]["floor"] =
        json::parse(R"({"rectangle": {"corner": [0, 0, 0], "along": [0.02, 0, 0], "across": [0, 0.04, 0]}})");
    document["domain"] = json::parse(R"({"low": [0, 0, -0.01], "high": [0.04, 0.04, 0.09]})");
    document["phases"] = json::parse(R"([{"name": "settle", "for": 0.2}, {"name": "rest", "for": 0.01}])");
    machine::Run run(spec_of(document), 3);
    run.advance(1e9);
    EXPECT_NE(run.remark().find(" of 60 particles left the domain during the first phase"), std::string::npos);
    document["walls"] = box()["walls"];
    document["domain"] = json::parse(R"({"low": [0, 0, -0.01], "high": [0.04, 0.04, 0.09], "periodic": [1, 1, 0]})");
    machine::Run sound(spec_of(document), 3);
    sound.advance(1e9);
    EXPECT_EQ(sound.remark(), "");
}

}  // namespace grainsweep::tests::machine_choices_test
