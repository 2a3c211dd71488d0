// Warnings before a program runs: what may reach it otherwise than its author thinks.
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/reader.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::campaign_program_warnings_test {

using namespace campaign;
using nlohmann::json;

/// A folder with a script, and campaigns over gap in it.
struct Beside : Folder {
    Beside() { write("run.py", "print(1)\n"); }
    [[nodiscard]] json file(const json& parameters, const json& fixed,
                            const json& factor = {{"name", "gap"}, {"between", {1, 3}}}) const {
        json campaign = json::parse(R"json({"campaign": "c", "scene": "program",
          "program": {"command": ["sh", "run.py", "{gap}"], "files": ["run.py"],
                      "observables": {"y": {"from": {"output": "y = (.*)"}}}},
          "design": {"kind": "halton", "points": 3}})json");
        campaign["program"]["parameters"] = parameters;
        campaign["factors"] = {factor};
        campaign["fixed"] = fixed;
        return campaign;
    }
    [[nodiscard]] Campaign read(const json& campaign) const { return parse_campaign(campaign.dump(), path()); }
};

TEST(ProgramWarnings, AFormatThatLosesTheNumberIsNamed) {
    const Beside of;
    const auto warnings = [&](const std::string& argument) {
        auto file = of.file({{"gap", {{"unit", "m"}}}}, json::object(), {{"name", "gap"}, {"between", {4e-5, 8e-5}}});
        file["program"]["command"][2] = argument;
        const auto campaign = of.read(file);
        return campaign.scene().warnings({{"gap", Value{6e-5}}}, {});
    };
    const auto lost = warnings("{gap:%.3f}");
    ASSERT_EQ(lost.size(), 1U);
    EXPECT_EQ(lost[0].kind, "format of gap in command[2]");
    EXPECT_EQ(lost[0].sentence, "%.3f makes 0.000 of 6e-05: the program gets another number");
    EXPECT_EQ(warnings("{gap:%.4f}").size(), 1U) << "0.0001";
    for (const char* sound : {"{gap:%.2e}", "{gap:%12.6f}", "{gap:%g}", "{gap:%-+12.4e}", "{gap}"})
        EXPECT_TRUE(warnings(sound).empty()) << sound;
}

TEST(ProgramWarnings, AParameterThatStandsNowhereIsNamed) {
    const Beside of;
    const auto warned = [&](const json& patch, const json& fixed = json::object(), const std::string& script = "\n") {
        of.write("run.py", script);
        auto file = of.file({{"gap", {{"unit", "mm"}}}, {"size", {{"unit", "mm"}}}}, fixed);
        file["factors"].push_back({{"name", "size"}, {"between", {1.5, 2.5}}});
        file.merge_patch(patch);
        for (const auto& warning : warnings_of(of.read(file), {}))
            if (warning.find("stands in no placeholder") != std::string::npos) return warning;
        return std::string();
    };
    const json none = json::object();
    EXPECT_EQ(warned(none),
              "size stands in no placeholder of command, environment or templates: the program finds its value in "
              "inputs.json alone");
    EXPECT_EQ(warned(none, none, "open('inputs.json')\n"), "");
    EXPECT_EQ(warned({{"program", {{"command", {"sh", "run.py", "{gap}", "{size}"}}}}}), "");
    EXPECT_EQ(warned({{"program", {{"command", {"sh", "run.py"}}}}}), "") << "no parameter stands anywhere";
    EXPECT_EQ(warned({{"program", {{"environment", {{"SIZE", "{size}"}}}}}}), "");
    EXPECT_NE(warned({{"program", {{"command", {"sh", "run.py", "{gap}", "{{ size }}"}}}}})
                  .find("; command[3] has {{ size }}, and a value comes for {size}"),
              std::string::npos);
    of.write("in.deck", "size {size}\n");
    EXPECT_NE(warned({{"program", {{"templates", {"in.deck"}}}}})
                  .find("; in.deck has {size}, and a value comes for {{ size }}"),
              std::string::npos);
    of.write("in.deck", "gap {{ gap }} twice {{ twice }}\n");
    json linked = {{"program", {{"templates", {"in.deck"}}, {"parameters", {{"twice", {{"unit", "mm"}}}}}}}};
    EXPECT_EQ(warned(linked, {{"twice", "2*size"}}), "") << "size decides twice";
}

TEST(ProgramWarnings, NameFilesThatDoNotCountAndReplicatesWithoutSeeds) {
    const Beside of;
    const auto warned = [&](const json& patch, const std::string& part) {
        auto file = of.file({{"gap", {{"unit", "mm"}}}}, json::object());
        file.merge_patch(patch);
        return std::ranges::any_of(warnings_of(of.read(file), {}),
                                   [&](const auto& warning) { return warning.find(part) != std::string::npos; });
    };
    const auto script = (of.path() / "run.py").string();
    const auto command = [](const json& words) { return json{{"program", {{"command", words}}}}; };
    EXPECT_TRUE(warned(command({"sh", script, "{gap}"}), "command[1] names a file whose contents are no part"));
    EXPECT_FALSE(warned(command({"sh", "run.py", "{gap}"}), "names a file"));
    EXPECT_FALSE(warned(command({"/bin/sh", "run.py", "{gap}", "/no/such/file", "/usr/bin/env"}), "names a file"));
    EXPECT_TRUE(warned({{"replicates", 4}}, "the 4 replicates of a point differ in their seed"));
    EXPECT_FALSE(warned(json::object(), "replicates of a point"));
    json seeded = command({"sh", "run.py", "{gap}", "{seed31}"});
    seeded["replicates"] = 4;
    EXPECT_FALSE(warned(seeded, "replicates of a point"));
}

}  // namespace grainsweep::tests::campaign_program_warnings_test
