// Campaigns that are changed, unfinished or not converged: what the program says of them must not mislead.
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace grainsweep::tests::unfinished_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

std::string with_design(const std::string& design, const std::string& more = "") {
    return R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}], "design": )" +
           design + more + "}";
}

class Campaigns : public testing::Test {
protected:
    Folder folder;

    Ended program(std::vector<std::string> arguments) const { return run_program(arguments, folder.path()); }
    json asked(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"--format", "json"});
        const auto ended = program(arguments);
        return json::parse(ended.out, nullptr, false);
    }
    std::string count(const std::string& table) const {
        return program({"query", "c.db", "SELECT count(*) FROM " + table, "--format", "csv"}).out;
    }
};

TEST_F(Campaigns, AnotherSizeOfADesignThatDoesNotExtendIsRefused) {
    const std::vector<std::pair<std::string, std::string>> sizes = {
        {R"({"kind": "latin_hypercube", "points": )", "points"}, {R"({"kind": "lattice", "levels": )", "levels"}};
    for (const auto& [design, option] : sizes) {
        std::filesystem::remove(folder / "c.db");
        folder.write("c.json", with_design(design + "6}"));
        ASSERT_EQ(program({"run", "c.json", "--quiet"}).code, 0);
        const auto places = count("c"), cases = count("sim_case");
        for (const char* size : {"9", "4"}) {
            folder.write("c.json", with_design(design + size + "}"));
            for (const char* command : {"run", "plan"}) {
                const auto ended = program({command, "c.json"});
                EXPECT_EQ(ended.code, 2) << command << size;
                EXPECT_THAT(ended.err, HasSubstr("c.json: $.design." + option + ": got " + size));
                EXPECT_THAT(ended.err, HasSubstr("give it a campaign name of its own"));
                EXPECT_LT(ended.err.size(), 400U);
            }
            EXPECT_EQ(count("c"), places);
            EXPECT_EQ(count("sim_case"), cases);
        }
        folder.write("c.json", with_design(design + "6}", R"(, "replicates": 2)"));
        EXPECT_EQ(program({"run", "c.json", "--quiet"}).code, 0) << "replicates extend any design";
    }
}

TEST_F(Campaigns, AskingForLessIsSaidAndCountedAndLosesNothing) {
    folder.write("c.json", with_design(R"({"kind": "halton", "points": 60})", R"(, "replicates": 2)"));
    ASSERT_EQ(program({"run", "c.json", "--quiet"}).code, 0);
    folder.write("c.json", with_design(R"({"kind": "halton", "points": 20})"));
    const std::string sentence = "asked now: 20 points x 1; stored: 60 points x 2";
    EXPECT_THAT(program({"plan", "c.json"}).out, HasSubstr(sentence));
    const auto run = program({"run", "c.json"});
    EXPECT_EQ(run.code, 0);
    EXPECT_THAT(run.err, HasSubstr(sentence));
    EXPECT_THAT(run.out, HasSubstr("c: 120 cases of rehearsal: 120 completed"));
    EXPECT_THAT(program({"status", "c.db"}).out, HasSubstr(sentence));
    EXPECT_THAT(program({"converge", "c.db"}).out, HasSubstr(sentence));
    const auto status = asked({"status", "c.db"})[0];
    EXPECT_EQ(status["cases"], 120);
    EXPECT_EQ(status["candidates"], 60);
    EXPECT_EQ(status["replicates"], 2);
    EXPECT_EQ(status["asked_points"], 20);
    EXPECT_EQ(status["asked_replicates"], 1);
    EXPECT_EQ(count("c"), "count(*)\n120\n");
}

// The verdict of a run that computes a part is the verdict on the campaign, not on the part.
TEST_F(Campaigns, ARunThatAsksForLessJudgesWhatIsStored) {
    const std::string rule =
        R"(, "convergence": {"observable": "y", "rule": "all_change", "tolerance": 1e-9, "block": 20})";
    folder.write("c.json", with_design(R"({"kind": "halton", "points": 200})", rule));
    ASSERT_EQ(program({"run", "c.json", "--quiet"}).code, 0);
    folder.write("c.json", with_design(R"({"kind": "halton", "points": 40})", rule));
    const auto run = asked({"run", "c.json"});
    const std::string verdict = asked({"converge", "c.db"})[0]["verdict"];
    EXPECT_THAT(run["ending"].get<std::string>(), HasSubstr(verdict));
    EXPECT_EQ(asked({"converge", "c.db"})[0]["checks"].size(), 10U);
}

TEST_F(Campaigns, WhatIsFinishedIsShownBeforeTheFirstCheck) {
    folder.write("c.json",
                 with_design(R"({"kind": "halton", "sequences": 8, "points": 2400})",
                             R"(, "where": "x1 + x2 < 1.5", "convergence": {"observable": "y", "block": 400})"));
    const auto run = program({"run", "c.json", "--max-cases", "200", "-j", "2"});
    EXPECT_EQ(run.code, 1);
    EXPECT_THAT(run.out, Not(HasSubstr("moments over 0 points")));
    EXPECT_THAT(run.out, HasSubstr("; not converged: first check of y at 400 points"));
    const auto converge = asked({"converge", "c.db"})[0];
    EXPECT_EQ(converge["candidates"], 2400);
    EXPECT_EQ(converge["dropped"].get<int>() + converge["asked"].get<int>(), 2400);
    EXPECT_EQ(converge["finished"], 200);
    EXPECT_EQ(converge["values"], 200) << "the settled beginning holds what is finished";
    EXPECT_EQ(converge["converged"], false);
    EXPECT_THAT(program({"converge", "c.db"}).out, HasSubstr("2400 candidates, "));
    const auto status = asked({"status", "c.db"})[0];
    EXPECT_EQ(status["finished"], 200);
    EXPECT_EQ(status["dropped"], converge["dropped"]);
    EXPECT_EQ(status["converged"], false);
    const auto plan = asked({"plan", "c.json"});
    EXPECT_EQ(plan["candidates"], 2400);
    EXPECT_EQ(plan["dropped"], converge["dropped"]);
    EXPECT_EQ(plan["cases"], converge["asked"]);
    EXPECT_EQ(plan["finished"], 200);
}

TEST_F(Campaigns, ScriptsCanTellWhetherACampaignConverged) {
    const auto ask_within = [&](const std::string& tolerance) {
        folder.write("c.json", with_design(R"({"kind": "halton", "sequences": 8, "points": 640})",
                                           R"(, "convergence": {"observable": "y", "tolerance": )" + tolerance + "}"));
        return asked({"run", "c.json"});
    };
    const auto strict = ask_within("1e-9");
    EXPECT_EQ(strict["exit_code"], 0) << "every case is settled";
    EXPECT_EQ(strict["converged"], false);
    EXPECT_THAT(strict["ending"].get<std::string>(), HasSubstr("all cases are settled; not converged: "));
    EXPECT_EQ(asked({"status", "c.db"})[0]["converged"], false);
    EXPECT_THAT(program({"status", "c.db"}).out, HasSubstr("y: not converged: "));
    EXPECT_EQ(program({"converge", "c.db", "--check"}).code, 1);
    EXPECT_EQ(program({"converge", "c.db"}).code, 0);

    const auto easy = ask_within("0.2");
    EXPECT_EQ(easy["converged"], true);
    EXPECT_EQ(asked({"status", "c.db"})[0]["converged"], true);
    EXPECT_EQ(program({"converge", "c.db", "--check"}).code, 0);

    folder.write("c.json", with_design(R"({"kind": "halton", "sequences": 8, "points": 640})"));
    EXPECT_TRUE(asked({"run", "c.json"})["converged"].is_null());
    EXPECT_TRUE(asked({"status", "c.db"})[0]["converged"].is_null());
    EXPECT_EQ(program({"converge", "c.db", "--check"}).code, 1) << "without a rule nothing has converged";
}

TEST_F(Campaigns, PlanAndRunWarnOfWhatMakesLittleSense) {
    folder.write("c.json", R"({"campaign": "c", "scene": "powder_spreading",
        "factors": [{"name": "gap", "levels": [0.0001, 0.004, 0.05]}], "design": {"kind": "list", "rows": [[0.0001], [0.05]]},
        "fixed": {"width": 5, "layer_area": 2e-4, "travel": 0.03, "settle_time": 0.1},
        "convergence": {"observable": "mfr", "rule": "all_change", "block": 400}})");
    const auto plan = program({"plan", "c.json"});
    EXPECT_EQ(plan.code, 0);
    EXPECT_THAT(plan.out, HasSubstr("warning    gap below half a diameter: 1 of 2 cases, first at point 0: "));
    EXPECT_THAT(plan.out, HasSubstr("warning    gap above the layer: 1 of 2 cases, first at point 1: "));
    EXPECT_THAT(plan.out, HasSubstr("warning    convergence can never be checked: a block is 400 points"));
    EXPECT_EQ(asked({"plan", "c.json"})["warnings"].size(), 3U);
    const auto run = program({"run", "c.json", "--quiet", "--max-cases", "1"});
    EXPECT_THAT(run.err, HasSubstr("warning: gap above the layer: 1 of 2 cases"));
}

TEST_F(Campaigns, AWordOfSqlIsNoName) {
    folder.write("c.json",
                 R"({"campaign": "Select", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {"kind": "halton", "points": 10}})");
    for (const char* command : {"plan", "run"}) {
        const auto ended = program({command, "c.json"});
        EXPECT_EQ(ended.code, 2);
        EXPECT_EQ(
            ended.err,
            "grainsweep: c.json: $.campaign: got Select; is a word of SQL, and the campaign's view bears its name. "
            "Did you mean 'Select_1'?\n");
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "Select.db"));
}

}  // namespace grainsweep::tests::unfinished_test
