// Numbers with units and expressions through the real program: the same cases, answers and tables as with plain
// numbers.
#include "tests/support/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::quantities_test {

using nlohmann::json;
using testing::HasSubstr;

struct Quantities : CommandsInAFolder {
    std::string dump_of(const std::string& name, const json& campaign) const {
        folder.write(name + ".json", campaign.dump());
        out({"run", name + ".json", "--db", name + ".db", "--quiet"});
        return out({"dump", name + ".db"});
    }
    std::string inputs(const std::string& database, const std::string& sql) const {
        return out({"query", database, sql, "--format", "csv"});
    }
};

json rehearsal(const json& between, const json& levels, const json& fixed) {
    return {{"campaign", "c"},
            {"scene", "rehearsal"},
            {"factors", {{{"name", "x1"}, {"between", between}}, {{"name", "wait_seconds"}, {"levels", levels}}}},
            {"fixed", fixed},
            {"design", {{"kind", "halton"}, {"points", 12}}}};
}

TEST_F(Quantities, RunAsPlainNumbersDo) {
    const auto plain = dump_of("plain", rehearsal({0.1, 0.6}, {0, 0.003}, {{"x2", 0.25}}));
    const auto united = dump_of("united", rehearsal({"10 %", "60 %"}, {0, "3 ms"}, {{"x2", "25 %"}}));
    EXPECT_EQ(united, plain);
    // One database, one campaign: nothing is computed again.
    folder.write("again.json", rehearsal({"10 %", "60 %"}, {"0 s", "3 ms"}, {{"x2", "0.25"}}).dump());
    out({"run", "again.json", "--db", "plain.db", "--quiet"});
    EXPECT_EQ(out({"dump", "plain.db"}), plain);
    EXPECT_EQ(inputs("plain.db", "SELECT count(*), max(attempts) FROM c"), "count(*),max(attempts)\n12,1\n");
}

TEST_F(Quantities, AreSetOnTheCommandLine) {
    folder.write("c.json", rehearsal({0, 1}, {0, 0.003}, {{"x2", 0.25}}).dump());
    const auto solved = [&](const std::string& x1, const std::string& wait) {
        const auto said = json::parse(
            out({"solve", "c.json", "--set", "x1=" + x1, "--set", "wait_seconds=" + wait, "--format", "json"}));
        return json{said["inputs"], said["scalars"]};
    };
    EXPECT_EQ(solved("40 %", "1 ms"), solved("0.4", "0.001"));
    const auto refused = ask({"solve", "c.json", "--set", "wait_seconds=1 mm"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("--set wait_seconds: got \"1 mm\"; 'wait_seconds' must be a number"));
    EXPECT_THAT(refused.err, HasSubstr("'mm' does not fit 's'"));
}

TEST_F(Quantities, OfPlannedScenesAreInSi) {
    const json campaign = json::parse(R"({"campaign": "c", "scene": "rotating_drum",
        "factors": [{"name": "rpm", "between": ["0.25 Hz", "30 rpm"]}, {"name": "diameter", "levels": ["4 mm", 0.005]}],
        "fixed": {"drum_diameter": "20*diameter", "cohesion": "35 kJ/m3", "density": "2.5 g/cm3"},
        "design": {"kind": "lattice", "levels": [2, 2]}})");
    folder.write("c.json", campaign.dump());
    const auto plan = json::parse(out({"plan", "c.json", "--format", "json"}));
    EXPECT_EQ(plan["fixed"]["cohesion"], 35000);
    EXPECT_EQ(plan["fixed"]["density"], 2500);
    EXPECT_EQ(plan["fixed"]["drum_diameter"], "20*diameter");
    EXPECT_THAT(out({"plan", "c.json"}), HasSubstr("fixed      drum_diameter = 20*diameter\n"));
    EXPECT_THAT(out({"plan", "c.json"}), HasSubstr("fixed      cohesion = 35000 J/m3\n"));
}

struct Expressions : Quantities {
    /// x2 follows x1, x3 follows both; the list gives the same numbers by hand.
    json file = rehearsal({0.1, 0.6}, {0, 0.001}, {{"x2", "x1/2"}, {"x3", "if(x2 > 0.15, 1 - x1, x2)"}});
};

TEST_F(Expressions, RunExplainResumeReplayAndReport) {
    folder.write("c.json", file.dump());
    const auto stopped = ask({"run", "c.json", "--max-cases", "5", "--quiet"});
    EXPECT_EQ(stopped.code, 1) << stopped.err;
    out({"run", "c.json", "--quiet"});
    const auto dump = out({"dump", "c.db"});
    EXPECT_EQ(dump_of("other", file), dump);
    const std::string numbers =
        "SELECT count(*) AS n FROM c JOIN inputs AS i ON i.case_id = c.case_id AND i.name = 'x2' WHERE i.value = "
        "c.x1/2";
    EXPECT_EQ(inputs("c.db", numbers), "n\n12\n");
    const auto one = inputs("c.db", "SELECT case_id FROM c WHERE point = 3").substr(8, 32);
    EXPECT_THAT(out({"explain", "c.db", one}), HasSubstr("completed"));
    out({"replay", "c.db", one});
    out({"verify", "c.db"});
    out({"report", "c.db", "-o", "c.html"});
    EXPECT_EQ(out({"dump", "c.db"}), dump);
}

TEST_F(Expressions, AskTheCasesThatAListOfNumbersAsks) {
    folder.write("c.json", file.dump());
    out({"run", "c.json", "--quiet"});
    const auto ids = [&](const std::string& database) {
        return inputs(database, "SELECT case_id FROM c ORDER BY case_id");
    };
    json rows = json::array();
    const auto table = json::parse(out({"query", "c.db", "SELECT x1, wait_seconds FROM c", "--format", "json"}));
    for (const auto& row : table) {
        const double x1 = row["x1"], x2 = x1 / 2;
        rows.push_back({x1, row["wait_seconds"], x2, x2 > 0.15 ? 1 - x1 : x2});
    }
    json listed = file;
    listed.erase("fixed");
    listed["factors"].push_back({{"name", "x2"}, {"between", {0, 1}}});
    listed["factors"].push_back({{"name", "x3"}, {"between", {0, 1}}});
    listed["design"] = {{"kind", "list"}, {"rows", rows}};
    folder.write("listed.json", listed.dump());
    out({"run", "listed.json", "--db", "listed.db", "--quiet"});
    EXPECT_EQ(ids("listed.db"), ids("c.db"));
}

TEST_F(Expressions, FollowWhatSolveSets) {
    folder.write("c.json", file.dump());
    const auto inputs = [&](const std::string& set) {
        return json::parse(out({"solve", "c.json", "--set", set, "--format", "json"}))["inputs"];
    };
    EXPECT_EQ(inputs("x1=0.2")["x2"], 0.1);
    EXPECT_EQ(inputs("x1=20 %")["x3"], 0.1);
    EXPECT_EQ(inputs("x2=0.5")["x2"], 0.5);
    EXPECT_EQ(inputs("x2=0.5")["x3"], 1 - 0.35);
}

TEST_F(Expressions, ThatChangeAreAnotherCampaign) {
    folder.write("c.json", file.dump());
    out({"run", "c.json", "--quiet"});
    json same = file;
    same["fixed"]["x2"] = " x1 / 2";
    folder.write("same.json", same.dump());
    out({"run", "same.json", "--db", "c.db", "--quiet"});
    json other = file;
    other["fixed"]["x2"] = "x1/3";
    folder.write("other.json", other.dump());
    const auto refused = ask({"run", "other.json", "--db", "c.db", "--quiet"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("x2 = x1/2"));
    EXPECT_THAT(refused.err, HasSubstr("x2 = x1/3"));
}

TEST_F(Expressions, OutOfBoundsStopBeforeAnythingRuns) {
    json wrong = file;
    wrong["fixed"]["x2"] = "3*x1";
    folder.write("c.json", wrong.dump());
    for (const char* command : {"plan", "run"}) {
        const auto refused = ask({command, "c.json"});
        EXPECT_EQ(refused.code, 2);
        EXPECT_THAT(refused.err,
                    HasSubstr("c.json: $.fixed.x2: got \"3*x1\"; 'x2' must be a number from 0 to 1, and it "
                              "is "));
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "c.db"));
    wrong["where"] = "x1 < 0.3";
    folder.write("c.json", wrong.dump());
    out({"run", "c.json", "--quiet"});
}

/// The condition of the campaign decides where a prediction is one: it sees the number of the setting.
TEST_F(Expressions, AreEvaluatedWhereAPredictionIsMade) {
    json campaign = rehearsal({0, 1}, {0}, {{"x2", "x1/2"}, {"noise", 0.01}});
    campaign["factors"][1] = {{"name", "x3"}, {"between", {0, 1}}};
    campaign["where"] = "x2 < 0.4";
    campaign["design"]["points"] = 60;
    folder.write("c.json", campaign.dump());
    out({"run", "c.json", "--quiet"});
    const auto predict = [&](const std::string& x1) {
        return ask({"predict", "c.db", "--at", "x1=" + x1, "--at", "x3=0.5"});
    };
    for (const char* inside : {"0.1", "0.75", "50 %"}) EXPECT_EQ(predict(inside).code, 0) << predict(inside).err;
    EXPECT_EQ(predict("0.85").code, 2);
    EXPECT_THAT(predict("0.85").err, HasSubstr("x2 < 0.4"));
}

/// Of a program, a text without unit or number is a word.
TEST_F(Quantities, OfAProgramsWordsStayWords) {
    folder.write("answer.sh", "printf '{\"y\": 1}' > out.json\n");
    const json campaign = json::parse(R"({"campaign": "c", "scene": "program",
        "program": {"command": ["sh", "answer.sh", "{mode}", "{gap}"], "files": ["answer.sh"],
                    "parameters": {"gap": {"unit": "mm"}, "mode": {"bounds": ["60 um"]}},
                    "observables": {"y": {"from": {"json": "out.json", "path": "/y"}}}},
        "factors": [{"name": "gap", "between": ["60 um", "0.2 mm"]}], "fixed": {"mode": "60 um"},
        "design": {"kind": "lattice", "levels": [2]}})");
    folder.write("c.json", campaign.dump());
    out({"run", "c.json", "--quiet"});
    EXPECT_EQ(inputs("c.db", "SELECT gap FROM c ORDER BY gap"), "gap\n0.06\n0.2\n");
    EXPECT_EQ(inputs("c.db", "SELECT DISTINCT value FROM inputs WHERE name = 'mode'"), "value\n60 um\n");
}

/// A pipe whose volume a script computes from what reaches it.
struct ProgramQuantities : Quantities {
    json pipe = json::parse(R"json({"campaign": "pipe", "scene": "program",
        "program": {"command": ["sh", "solve.sh", "{radius:%.6e}", "{length}", "{n:%03d}", "{seed_prime}"],
          "files": ["solve.sh"], "keep": "all",
          "parameters": {"radius": {"unit": "m"}, "length": {"unit": "m"}, "gap": {"unit": "m"}, "n": {"whole": true}},
          "observables": {"volume": {"unit": "m3", "from": {"output": "volume (.*)"}}}},
        "factors": [{"name": "gap", "between": ["1 mm", "3 mm"]}],
        "fixed": {"radius": "2 mm", "length": "2*gap", "n": 7},
        "design": {"kind": "lattice", "levels": [2]}})json");
    void SetUp() override {
        folder.write("solve.sh",
                     "awk -v r=\"$1\" -v l=\"$2\" 'BEGIN{printf \"volume %.9g\\n\", 3.14159265*r*r*l}'\n"
                     "echo \"$@\" > ../said_$2.txt\n");
        folder.write("pipe.json", pipe.dump());
    }
};

TEST_F(ProgramQuantities, AreNumbersInTheUnitOfTheParameter) {
    out({"run", "pipe.json", "--quiet"});
    EXPECT_EQ(inputs("pipe.db", "SELECT gap, volume FROM pipe ORDER BY gap"),
              "gap,volume\n0.001,2.51327412e-08\n0.003,7.53982236e-08\n");
    EXPECT_EQ(inputs("pipe.db", "SELECT DISTINCT value FROM inputs WHERE name = 'radius'"), "value\n0.002\n");
    EXPECT_EQ(inputs("pipe.db",
                     "SELECT count(*) AS n FROM inputs AS l JOIN inputs AS g USING (case_id) WHERE l.name = "
                     "'length' AND g.name = 'gap' AND l.value = 2 * g.value"),
              "n\n2\n");
    const auto said =
        Process({"/bin/cat", (folder / "pipe.cases" / "said_0.006.txt").string()}, folder.path()).wait().out;
    EXPECT_THAT(said, testing::StartsWith("2.000000e-03 0.006 007 ")) << "what the command was given";
}

TEST_F(ProgramQuantities, AreShownByPlanAndFollowSolve) {
    EXPECT_THAT(out({"plan", "pipe.json"}),
                HasSubstr("fixed      length = 2*gap\nfixed      n = 7\nfixed      radius = 0.002 m\n"));
    const auto solved = json::parse(out({"solve", "pipe.json", "--set", "gap=4 mm", "--format", "json"}));
    EXPECT_EQ(solved["inputs"]["length"], 0.008);
    EXPECT_EQ(solved["inputs"]["radius"], 0.002);
}

TEST_F(ProgramQuantities, PlanStatesWhatIsSentWhereAConditionIsFalse) {
    pipe["factors"].push_back({{"name", "n"}, {"levels", {3, 5}}, {"when", "gap > 0.002"}});
    pipe["fixed"].erase("n");
    pipe["design"]["levels"] = {2, 2};
    folder.write("pipe.json", pipe.dump());
    const auto rules = [&] {
        return json::parse(out({"plan", "pipe.json", "--format", "json"}))["factors"][1]["rules"];
    };
    EXPECT_EQ(rules(), "when gap > 0.002, else 0");
    pipe["program"]["parameters"]["n"]["default"] = 1;
    folder.write("pipe.json", pipe.dump());
    EXPECT_EQ(rules(), "when gap > 0.002, else 1");
    out({"run", "pipe.json", "--quiet"});
    EXPECT_EQ(inputs("pipe.db",
                     "SELECT DISTINCT gap, value FROM pipe JOIN inputs USING (case_id) WHERE inputs.name = 'n' ORDER "
                     "BY gap, value"),
              "gap,value\n0.001,1\n0.003,3\n0.003,5\n");
}

TEST_F(ProgramQuantities, AreRefusedBeforeAnythingIsWritten) {
    const auto refused = [&](const json& patch) {
        json wrong = pipe;
        wrong.merge_patch(patch);
        folder.write("pipe.json", wrong.dump());
        const auto ended = ask({"run", "pipe.json"});
        EXPECT_EQ(ended.code, 2) << patch;
        EXPECT_FALSE(std::filesystem::exists(folder / "pipe.db"));
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
        return ended.err;
    };
    EXPECT_THAT(
        refused({{"program", {{"parameters", {{"radius", nullptr}}}}}}),
        HasSubstr("pipe.json: $.fixed.radius: got \"2 mm\"; is a number with a unit, and 'radius' has no unit"));
    EXPECT_THAT(refused({{"program", {{"parameters", {{"gap", {{"unit", "mm"}}}}}}}}),
                HasSubstr("gap is in mm, length is in m"));
    EXPECT_THAT(refused({{"fixed", {{"n", "1000*gap + 0.5"}}}}), HasSubstr("$.fixed.n"));
    EXPECT_THAT(refused({{"fixed", {{"n", "1000*length/3"}}}}), HasSubstr("'n' must be a whole number, and it is"));
}

}  // namespace grainsweep::tests::quantities_test
