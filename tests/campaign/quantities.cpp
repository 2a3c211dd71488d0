// Numbers with units and expressions through the real program: the same cases, answers and tables as with plain
// numbers.
#include "tests/support/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

/// Of a program, a text is a word wherever it was one: its cases keep their ids.
TEST_F(Quantities, OfAProgramsWordsStayWords) {
    folder.write("answer.sh", "printf '{\"y\": 1}' > out.json\n");
    const json campaign = json::parse(R"({"campaign": "c", "scene": "program",
        "program": {"command": ["sh", "answer.sh", "{mode}", "{gap}"], "files": ["answer.sh"],
                    "parameters": {"gap": {"unit": "mm"}}, "observables": {"y": {"from": {"json": "out.json", "path": "/y"}}}},
        "factors": [{"name": "gap", "between": ["60 um", "0.2 mm"]}], "fixed": {"mode": "60 um"},
        "design": {"kind": "lattice", "levels": [2]}})");
    folder.write("c.json", campaign.dump());
    out({"run", "c.json", "--quiet"});
    EXPECT_EQ(inputs("c.db", "SELECT gap FROM c ORDER BY gap"), "gap\n0.06\n0.2\n");
    EXPECT_EQ(inputs("c.db", "SELECT DISTINCT value FROM inputs WHERE name = 'mode'"), "value\n60 um\n");
}

}  // namespace grainsweep::tests::quantities_test
