// Answers of an earlier version of a program, adopted through the real program.
#include "tests/support/program_campaigns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::adoption_test {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

/// y = 2 x, and a line in "runs" for each case.
std::string script(const std::string& remark) {
    return "# " + remark +
           "\necho run >> \"$RUNS\"\necho \"{\\\"y\\\": $(echo \"$1\" | awk '{print 2 * $1}')}\" > out.json\n";
}

struct Adoption : testing::Test {
    Folder folder;

    [[nodiscard]] json named(const std::string& name, int points, const json& more = {}) const {
        auto campaign = script_campaign(points, {{"environment", {{"RUNS", (folder / "runs").string()}}}});
        campaign["campaign"] = name;
        if (more.is_object()) campaign["program"].merge_patch(more);
        return campaign;
    }
    [[nodiscard]] std::ptrdiff_t runs() const {
        const auto counted = Process({"/usr/bin/wc", "-l", "runs"}, folder.path()).wait();
        return std::stol(counted.out);
    }
    [[nodiscard]] Ended program(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    void expect_refused(const Ended& ended, const std::string& sentence) const {
        EXPECT_EQ(ended.code, 2);
        EXPECT_THAT(ended.err, HasSubstr(sentence));
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
    }
};

TEST_F(Adoption, TakesAnswersOverAndSaysWhereTheyComeFrom) {
    ASSERT_EQ(run_script(folder, script("first"), named("p", 6)).code, 0);
    ASSERT_EQ(runs(), 6);
    const auto ended = run_script(folder, script("second"), named("q", 8), {"-j", "2", "--db", "p.db", "--adopt", "p"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("script.sh: "));
    EXPECT_THAT(ended.err, HasSubstr("6 answers of 'p' are adopted"));
    EXPECT_EQ(runs(), 8) << "two new points";

    const auto equal =
        rows_of(folder, "SELECT count(*) AS n FROM p JOIN q USING (point) WHERE p.y = q.y AND p.case_id <> q.case_id");
    EXPECT_EQ(equal[0]["n"], 6);
    const auto messages = rows_of(folder,
                                  "SELECT message, p.case_id FROM q JOIN sim_case USING (case_id) JOIN attempt USING "
                                  "(case_key) JOIN p USING (point) ORDER BY point");
    ASSERT_EQ(messages.size(), 6U);
    for (const auto& row : messages) {
        EXPECT_THAT(row["message"].get<std::string>(),
                    HasSubstr("adopted from case " + row["case_id"].get<std::string>()));
        EXPECT_THAT(row["message"].get<std::string>(), HasSubstr(" of program:"));
    }
    EXPECT_EQ(program({"verify", "p.db"}).code, 0);
    EXPECT_THAT(program({"dump", "p.db"}).out, HasSubstr("\n  message adopted from case "));
    const auto id = rows_of(folder, "SELECT case_id FROM q WHERE point = 0")[0]["case_id"].get<std::string>();
    EXPECT_THAT(program({"explain", "p.db", id, "--wide"}).out, HasSubstr("adopted from case"));

    EXPECT_THAT(program({"explain", "p.db", id}).out, HasSubstr("answer adopted from case "));

    // Resumed, nothing is left; asked again, the new program computes.
    EXPECT_EQ(program({"run", "c.json", "--db", "p.db", "--adopt", "p"}).code, 0);
    EXPECT_EQ(runs(), 8);
    EXPECT_EQ(program({"run", "c.json", "--db", "p.db", "--again", "completed"}).code, 0);
    EXPECT_EQ(runs(), 16);
    EXPECT_EQ(program({"verify", "p.db"}).code, 0);
    EXPECT_THAT(program({"dump", "p.db"}).out, Not(HasSubstr("adopted")));
}

TEST_F(Adoption, ReplaysWithTheSeedOfTheAnswer) {
    const std::string random = "echo \"{\\\"y\\\": $2}\" > out.json\n";
    const json seeded = {{"command", {"sh", "script.sh", "{x}", "{seed31}"}}};
    ASSERT_EQ(run_script(folder, random, named("p", 2, seeded)).code, 0);
    for (const std::string next : {"q", "r"}) {
        const std::string last = next == "q" ? "p" : "q";
        const auto ended = run_script(folder, random + "# " + next + "\n", named(next, 2, seeded),
                                      {"--db", "p.db", "--adopt", last, "--quiet"});
        ASSERT_EQ(ended.code, 0) << ended.err;
        const auto id = rows_of(folder, "SELECT case_id FROM " + next)[0]["case_id"].get<std::string>();
        const auto replayed = program({"replay", "p.db", id});
        EXPECT_EQ(replayed.code, 0) << replayed.out << replayed.err;
        EXPECT_THAT(replayed.err, HasSubstr(", because the answer is adopted from case "));
    }
}

TEST_F(Adoption, IsRefusedWhereAnAnswerMayBeAnother) {
    ASSERT_EQ(run_script(folder, script("first"), named("p", 4)).code, 0);
    const std::vector<std::string> adopt = {"--db", "p.db", "--adopt", "p"};
    expect_refused(
        run_script(folder, script("second"), named("q", 4, {{"command", {"sh", "script.sh", "{x}", "more"}}}), adopt),
        "its answers are those of another program: $.program.command[3] changed ($.program.command[3]: new)");
    expect_refused(run_script(folder, script("second"), named("q", 4, {{"environment", {{"A", "b"}}}}), adopt),
                   "$.program.environment.A changed (A: new)");
    expect_refused(run_script(folder, script("second"),
                              named("q", 4, {{"observables", {{"y", {{"from", {{"path", "/z"}}}}}}}}), adopt),
                   "$.program.observables.y changed");
    expect_refused(run_script(folder, script("first"), named("q", 4), adopt), "its program is this one");
    expect_refused(run_script(folder, script("second"), named("q", 4), {"--db", "p.db", "--adopt", "pp"}),
                   "Did you mean 'p'?");
    expect_refused(run_script(folder, script("second"), named("q", 4), {"--db", "n.db", "--adopt", "p"}),
                   "there is no database 'n.db'");
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM campaign")[0]["n"], 1);
    EXPECT_EQ(runs(), 4);
}

/// The refusal names the change and the ways on, in run and in plan.
TEST_F(Adoption, AChangedProgramIsNamed) {
    ASSERT_EQ(run_script(folder, script("first"), named("p", 4)).code, 0);
    expect_refused(run_script(folder, script("second"), named("p", 4)),
                   "c.json: $.program.files: script.sh changed since 'p.db' (");
    const auto planned = program({"plan", "c.json"});
    expect_refused(
        planned,
        "): give the campaign a new name, which computes every case, or a new name and --adopt p, which takes "
        "over its results, if the change alters none");
    EXPECT_THAT(planned.err, Not(HasSubstr("program:"))) << "no hash of a scene";
    expect_refused(
        run_script(folder, script("first"), named("p", 4, {{"command", {"sh", "script.sh", "{x}", "-v"}}})),
        "$.program.command[3]: it is new since 'p.db': give the campaign a new name, which computes every case, "
        "or set this back to continue campaign 'p'");
    EXPECT_EQ(runs(), 4);
}

TEST_F(Adoption, AFurtherObservableIsReadFromKeptFolders) {
    const json output = {{"from", {{"output", "e = (.*)"}}}};
    const std::string both = script("first") + "echo e = $1\n";
    ASSERT_EQ(run_script(folder, both, named("p", 4, {{"keep", "all"}})).code, 0);
    ASSERT_EQ(runs(), 4);
    const auto ended = run_script(folder, both, named("q", 6, {{"keep", "all"}, {"observables", {{"e", output}}}}),
                                  {"--db", "p.db", "--adopt", "p"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("note: e: new"));
    EXPECT_THAT(ended.err,
                HasSubstr("4 answers of 'p' are adopted, 4 of them with further observables from the folders"));
    EXPECT_EQ(runs(), 6) << "two new points";
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM q WHERE e = x AND y = 2 * x")[0]["n"], 6);
    EXPECT_THAT(rows_of(folder,
                        "SELECT message FROM q JOIN sim_case USING (case_id) JOIN attempt USING (case_key) WHERE "
                        "point = 0")[0]["message"]
                    .get<std::string>(),
                HasSubstr("further observables read from its folder"));
    EXPECT_EQ(program({"verify", "p.db"}).code, 0);
}

TEST_F(Adoption, AFurtherObservableIsComputedWhereNoFolderHasIt) {
    const json output = {{"from", {{"output", "e = (.*)"}}}};
    const std::string both = script("first") + "echo e = $1\n";
    ASSERT_EQ(run_script(folder, both, named("p", 4, {{"keep", "all"}})).code, 0);
    // One folder is gone, one has other values than the database.
    const auto folder_of = [&](int point) {
        const auto id = rows_of(folder, "SELECT case_id FROM p WHERE point = " + std::to_string(point))[0]["case_id"];
        return folder / "p.cases" / (id.get<std::string>() + ".1");
    };
    std::filesystem::remove_all(folder_of(0));
    std::ofstream(folder_of(1) / "out.json") << "{\"y\": 77}";
    const auto ended =
        run_script(folder, both, named("q", 4, {{"observables", {{"e", output}}}}), {"--db", "p.db", "--adopt", "p"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("2 answers of 'p' are adopted"));
    EXPECT_THAT(ended.err, HasSubstr("2 cases without such a folder are computed again"));
    EXPECT_EQ(runs(), 6);
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM q WHERE e = x AND y = 2 * x")[0]["n"], 4);
}

TEST_F(Adoption, AnotherFolderOfTheProgramAndFilesThatDoNotCountAreNoChange) {
    folder.write("readme.txt", "one\n");
    const json with_notes = {{"files", {"script.sh", "readme.txt"}}};
    ASSERT_EQ(run_script(folder, script("first"), named("p", 4, with_notes)).code, 0);
    const auto ended = run_script(folder, script("first"),
                                  named("q", 4,
                                        {{"files", {"script.sh", "readme.txt"}},
                                         {"does_not_count", {"readme.txt"}},
                                         {"command", {"/bin/sh", "script.sh", "{x}"}}}),
                                  {"--db", "p.db", "--adopt", "p"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("note: $.program.command[0]: sh -> /bin/sh"));
    EXPECT_THAT(ended.err, HasSubstr("note: readme.txt: counts -> does not count"));
    EXPECT_EQ(runs(), 4);
    // From now on its contents are free.
    folder.write("readme.txt", "two\n");
    EXPECT_EQ(program({"run", "c.json", "--db", "p.db"}).code, 0);
    EXPECT_EQ(runs(), 4);
    const auto id = rows_of(folder, "SELECT case_id FROM q LIMIT 1")[0]["case_id"].get<std::string>();
    EXPECT_EQ(program({"replay", "p.db", id}).code, 0);
    EXPECT_EQ(program({"verify", "p.db"}).code, 0);
}

/// A program with files and templates whose names are not in one order.
TEST_F(Adoption, TemplatesAreFilesToo) {
    folder.write("a.deck", "x {{ x }}\n");
    const json deck = {{"templates", {"a.deck"}}};
    ASSERT_EQ(run_script(folder, script("first"), named("p", 3, deck)).code, 0);
    folder.write("a.deck", "x {{x}}\n");
    const auto ended = run_script(folder, script("first"), named("q", 3, deck), {"--db", "p.db", "--adopt", "p"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("3 answers of 'p' are adopted"));
    EXPECT_EQ(runs(), 3);
}

TEST_F(Adoption, IsForProgramsOnly) {
    const char* config = R"({"campaign": "r", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "halton", "points": 4}})";
    folder.write("r.json", config);
    ASSERT_EQ(program({"run", "r.json", "--quiet"}).code, 0);
    expect_refused(program({"run", "r.json", "--adopt", "r"}), "only answers of a program are adopted");
}

TEST_F(Adoption, TakesAPartByACondition) {
    ASSERT_EQ(run_script(folder, script("first"), named("p", 6)).code, 0);
    const std::vector<std::string> options = {"-j", "2", "--db", "p.db", "--adopt", "p", "--adopt-where", "x < 0.5"};
    const auto ended = run_script(folder, script("second"), named("q", 6), options);
    EXPECT_EQ(ended.code, 0) << ended.err;
    const auto above = rows_of(folder, "SELECT count(*) AS n FROM p WHERE x >= 0.5")[0]["n"].get<int>();
    EXPECT_THAT(ended.err, HasSubstr(std::to_string(6 - above) + " answers of 'p' are adopted; " +
                                     std::to_string(above) + " cases that --adopt-where excludes are computed again"));
    EXPECT_EQ(runs(), 6 + above);
    expect_refused(program({"run", "c.json", "--db", "p.db", "--adopt-where", "x < 0.5"}), "belongs to --adopt");
    expect_refused(program({"run", "c.json", "--db", "p.db", "--adopt", "p", "--adopt-where", "z < 0.5"}),
                   "--adopt-where");
}

TEST_F(Adoption, AnotherTimeLimitStatesWhatTimedOut) {
    auto campaign = named("p", 4);
    campaign["limits"] = {{"wall_seconds", 1}, {"attempts", 1}};
    const auto slow = script("slow") + "awk -v x=\"$1\" 'BEGIN { exit !(x > 0.6) }' && sleep 60\ntrue\n";
    ASSERT_EQ(run_script(folder, slow, campaign).code, 1);
    const auto late = rows_of(folder, "SELECT count(*) AS n FROM p WHERE outcome = 'timed_out'")[0]["n"].get<int>();
    ASSERT_GT(late, 0);
    campaign["limits"]["wall_seconds"] = 30;
    const auto ended = run_script(folder, slow, campaign);
    EXPECT_THAT(ended.err, HasSubstr("limits.wall_seconds was 1 and is 30; " + std::to_string(late) +
                                     " cases timed out under the old limit"));
    EXPECT_THAT(run_script(folder, slow, campaign).err, Not(HasSubstr("under the old limit"))) << "once";
}

}  // namespace grainsweep::tests::adoption_test
