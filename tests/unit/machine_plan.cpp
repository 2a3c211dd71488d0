// Warnings and cost of a machine before it runs: each warning comes from a machine that deserves it.
#include "solver/machine/plan.hpp"
#include "tests/support/machines.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <set>

namespace grainsweep::tests::machine_plan_test {

using nlohmann::json;

/// Kinds of warnings of the small machine with a change.
std::set<std::string> kinds(const char* patch, const Inputs& inputs = {}) {
    std::set<std::string> found;
    json machine = small_machine().patch(json::parse(patch));
    machine["species"]["heavy"].erase("sizes");  // of ten particles
    for (const auto& warning : machine::warnings_of(spec_of(machine, inputs))) {
        found.insert(warning.kind);
        EXPECT_EQ(warning.sentence.find("nan"), std::string::npos) << warning.sentence;
        EXPECT_EQ(warning.sentence.find("inf"), std::string::npos) << warning.sentence;
    }
    return found;
}

using Kinds = std::set<std::string>;

TEST(MachineScenes, StayForWhoeverHoldsThemWhenTheMachineIsReadAgain) {
    const auto held = campaign::enter_machine(machine_of(small_machine()));
    json other = small_machine();
    other["summary"] = "the same answers, other words";
    const auto newest = campaign::enter_machine(machine_of(other));
    ASSERT_EQ(newest->name, held->name);
    EXPECT_EQ(find_scene(held->name), newest);
    EXPECT_EQ(newest->summary, "the same answers, other words");
    EXPECT_NE(held->summary, newest->summary);
    EXPECT_EQ(held->defaults(), newest->defaults());
}

TEST(MachinePlan, CountsProbesThatReadEveryStepInTheirPhases) {
    const auto cost = [](const json& measures) {
        json machine = small_machine();
        for (const auto& [name, measure] : measures.items()) machine["measure"][name] = measure;
        return machine::cost_of(spec_of(machine, {}));
    };
    const json probe = {{"impact_energy", json::object()}, {"as", "last"}};
    json during = probe;
    during["during"] = "turn";
    const auto plain = cost(json::object()), one = cost({{"lost", probe}}), part = cost({{"lost", during}}),
               two = cost({{"lost", probe}, {"again", probe}});
    EXPECT_EQ(one.particle_steps, plain.particle_steps);
    EXPECT_GT(one.seconds, 2 * plain.seconds);
    EXPECT_GT(part.seconds, plain.seconds);
    EXPECT_LT(part.seconds, one.seconds);
    EXPECT_GT(two.seconds, one.seconds);
    EXPECT_LT(two.seconds, 1.1 * one.seconds) << "the contacts are read once";
}

TEST(MachinePlan, ASoundMachineHasNoWarning) {
    EXPECT_EQ(kinds("[]"), Kinds{});
}

TEST(MachinePlan, WarnsOfParametersThatNothingUses) {
    const auto with = [](const char* spare) {
        return kinds(
            (R"([{"op": "add", "path": "/parameters/spare", "value": {"default": 1, "only_if": {"bars": "set"}}},
                          {"op": "add", "path": "/notes", "value": "spare"}, )" +
             std::string(spare) + "]")
                .c_str());
    };
    EXPECT_EQ(with(R"({"op": "add", "path": "/let/one", "value": "2"})"), Kinds{"parameters that nothing uses"});
    EXPECT_EQ(with(R"({"op": "add", "path": "/let/one", "value": "2*spare"})"), Kinds{});
}

TEST(MachinePlan, WarnsOfPowderThatStillFalls) {
    const char* short_fall = R"([{"op": "replace", "path": "/phases/0", "value": {"name": "fall", "for": 0.01}}])";
    EXPECT_EQ(kinds(short_fall), Kinds{"powder still falling"});
    const char* packed = R"([{"op": "replace", "path": "/phases/0", "value": {"name": "fall", "for": 0.01}},
                             {"op": "add", "path": "/fill/0/as", "value": "packed"}])";
    EXPECT_EQ(kinds(packed), Kinds{});
    const char* long_fall = R"([{"op": "replace", "path": "/phases/0", "value": {"name": "fall", "for": 0.1}}])";
    EXPECT_EQ(kinds(long_fall), Kinds{});
}

TEST(MachinePlan, WarnsOfAMotionThatStartsAfterAllPhases) {
    const auto from = [](const char* time) {
        return kinds(
            (R"([{"op": "replace", "path": "/walls/paddle/motion/0/from", "value": )" + std::string(time) + "}]")
                .c_str());
    };
    EXPECT_EQ(from(R"("5 s")"), Kinds{"a motion that never starts"});
    EXPECT_EQ(from(R"("0.1 s")"), Kinds{});  // of 0.12 s
    EXPECT_EQ(kinds(R"([{"op": "replace", "path": "/walls/paddle/motion/0", "value":
                         {"follow": {"times": [0, 0.1, 5], "positions": [[0, 0, 0], [0, 0, 0.001], [0, 0, 0]]}}}])"),
              Kinds{});
}

TEST(MachinePlan, WarnsOfDegreesThatLackTheirUnit) {
    const auto gravity = [](const char* tilt) {
        return kinds(
            (R"([{"op": "add", "path": "/gravity", "value": {"size": 9.81, "tilt": )" + std::string(tilt) + "}}]")
                .c_str());
    };
    EXPECT_EQ(gravity("30"), Kinds{"an angle beyond a turn"});
    EXPECT_EQ(gravity("6.28"), Kinds{});
    EXPECT_EQ(gravity(R"("370 deg")"), Kinds{});
    EXPECT_TRUE(kinds(R"([{"op": "add", "path": "/walls/paddle/turned", "value": {"axis": [0, 0, 1], "angle": 90}}])")
                    .contains("an angle beyond a turn"));
}

TEST(MachinePlan, WarnsOfAFillingThatDoesNotFit) {
    const char* many = R"([{"op": "replace", "path": "/fill/0/count", "value": 400}])";
    EXPECT_EQ(kinds(many), Kinds{"a filling that does not fit"});
    const char* packed = R"([{"op": "replace", "path": "/fill/0/count", "value": 300},
                             {"op": "add", "path": "/fill/0/as", "value": "packed"}])";
    EXPECT_EQ(kinds(packed), Kinds{});
}

TEST(MachinePlan, WarnsOfFillingsAndSharesWithoutAParticle) {
    EXPECT_EQ(kinds(R"([{"op": "replace", "path": "/fill/0/count", "value": "20*bars - 20"}])"),
              Kinds{"a filling without particles"});
    EXPECT_EQ(kinds(R"([{"op": "replace", "path": "/fill/0/mix/heavy", "value": 0.01}])"),
              Kinds{"a share of less than half a particle"});
    EXPECT_EQ(kinds(R"([{"op": "replace", "path": "/fill/0/mix/heavy", "value": 0}])"), Kinds{});
}

TEST(MachinePlan, WarnsOfACountThatDoesNotFollowTheScale) {
    const Inputs finer = {{"particles_scale", 0.8}};
    const auto of = [&](const char* count) {
        return kinds(fmt::format(R"([{{"op": "replace", "path": "/fill/0/count", "value": {}}}])", count).c_str(),
                     finer);
    };
    const Kinds warned{"a count that does not follow particles_scale"};
    EXPECT_EQ(of("20"), warned);
    EXPECT_EQ(of(R"("20*bars")"), warned);
    EXPECT_EQ(of(R"("20/particles_scale^3")"), Kinds{});
    EXPECT_EQ(of(R"("2.5e-7/light_volume")"), Kinds{});
    EXPECT_EQ(kinds("[]"), Kinds{});
}

TEST(MachinePlan, WarnsOfRegionsThatStayEmpty) {
    const Kinds warned{"a region without particles"};
    const auto of = [&](const char* region) {
        return kinds(
            fmt::format(R"([{{"op": "add", "path": "/measure/none", "value": {{"mass": {{"in": {}}}}}}}])", region)
                .c_str());
    };
    EXPECT_EQ(of(R"({"box": {"low": [1, 1, 1], "high": [2, 2, 2]}})"), warned);
    EXPECT_EQ(of(R"({"all": [{"half_space": {"point": [0, 0, 0.02], "normal": [0, 0, 1]}},
                             {"half_space": {"point": [0, 0, 0.01], "normal": [0, 0, -1]}}]})"),
              warned);
    EXPECT_EQ(of(R"({"box": {"low": [0, 0, 0], "high": [2, 2, 2]}})"), Kinds{});
    EXPECT_EQ(kinds(R"([{"op": "add", "path": "/remove", "value": [
                         {"at": "turn", "in": {"box": {"low": [1, 1, 1], "high": [2, 2, 2]}}}]}])"),
              warned);
}

TEST(MachinePlan, WarnsOfWallsTooFastForTheStep) {
    const char* fast = R"([{"op": "add", "path": "/walls/paddle/motion/-",
                            "value": {"vibrate": {"amplitude": [0, 0, 1e-6], "frequency": 3124}}}])";
    EXPECT_EQ(kinds(fast), Kinds{"vibration faster than the time step"});
    const char* thrown = R"([{"op": "add", "path": "/walls/paddle/motion/-",
                              "value": {"shift": {"velocity": [0, 0, 30]}, "during": "stop"}}])";
    EXPECT_EQ(kinds(thrown, {{"time_step", 5e-6}}).count("walls faster than the time step allows"), 1U);
}

// Of spheres of 2.5 mm: positions are multiples of 1e-3 diameters in a domain 11 km long.
TEST(MachinePlan, WarnsOfADomainTooWideForMixedPrecision) {
    const auto domain_to = [](const char* high) {
        return R"([{"op": "add", "path": "/domain", "value": {"low": [-1, -1, -1], "high": [")" + std::string(high) +
               R"(", 1, 1]}}])";
    };
    const std::string kind = "a domain too wide for mixed precision";
    EXPECT_FALSE(kinds(domain_to("10 km").c_str()).contains(kind));
    EXPECT_TRUE(kinds(domain_to("12 km").c_str()).contains(kind));
    EXPECT_FALSE(kinds(domain_to("12 km").c_str(), {{"precision", "double"}}).contains(kind));
}

TEST(MachinePlan, WarnsOfAPhaseThatWaitsInVain) {
    const char* fed = R"([{"op": "add", "path": "/feed/0/during", "value": ["fall", "turn"]}])";
    EXPECT_EQ(kinds(fed), Kinds{"a phase that cannot end before its time"});
}

TEST(MachinePlan, WarnsOfAFeedThatCannotKeepUp) {
    const char* much = R"([{"op": "replace", "path": "/feed/0/rate", "value": "500 g/s"}])";
    EXPECT_EQ(kinds(much).count("a feed that cannot keep up"), 1U);
}

TEST(MachinePlan, WarnsOfSizesTooRare) {
    const char* wide = R"([{"op": "add", "path": "/species/light/sizes",
                            "value": {"spread": "lognormal", "sigma": 0.9}}])";
    EXPECT_EQ(kinds(wide).count("sizes too rare for the number of particles"), 1U);
}

}  // namespace grainsweep::tests::machine_plan_test
