// Answers of an earlier version of a program, adopted through the real program.
#include "tests/support/program_campaigns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
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

    // Resumed, nothing is left; asked again, the new program computes.
    EXPECT_EQ(program({"run", "c.json", "--db", "p.db", "--adopt", "p"}).code, 0);
    EXPECT_EQ(runs(), 8);
    EXPECT_EQ(program({"run", "c.json", "--db", "p.db", "--again", "completed"}).code, 0);
    EXPECT_EQ(runs(), 16);
    EXPECT_EQ(program({"verify", "p.db"}).code, 0);
    EXPECT_THAT(program({"dump", "p.db"}).out, Not(HasSubstr("adopted")));
}

TEST_F(Adoption, IsRefusedWhereMoreChanged) {
    ASSERT_EQ(run_script(folder, script("first"), named("p", 4)).code, 0);
    const std::vector<std::string> adopt = {"--db", "p.db", "--adopt", "p"};
    expect_refused(
        run_script(folder, script("second"), named("q", 4, {{"command", {"sh", "script.sh", "{x}", "more"}}}), adopt),
        "more than the contents of files changed: the command");
    expect_refused(run_script(folder, script("second"), named("q", 4, {{"environment", {{"A", "b"}}}}), adopt),
                   "more than the contents of files changed: the environment");
    expect_refused(
        run_script(folder, script("second"),
                   named("q", 4, {{"observables", {{"z", {{"from", {{"json", "out.json"}, {"path", "/y"}}}}}}}}),
                   adopt),
        "more than the contents of files changed: the parameters or observables");
    expect_refused(run_script(folder, script("first"), named("q", 4), adopt), "its program is this one");
    expect_refused(run_script(folder, script("second"), named("q", 4), {"--db", "p.db", "--adopt", "pp"}),
                   "Did you mean 'p'?");
    expect_refused(run_script(folder, script("second"), named("p", 4), adopt),
                   "another version of program sh, whose command or files have changed");
    expect_refused(run_script(folder, script("second"), named("q", 4), {"--db", "n.db", "--adopt", "p"}),
                   "there is no database 'n.db'");
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM campaign")[0]["n"], 1);
    EXPECT_EQ(runs(), 4);
}

TEST_F(Adoption, IsForProgramsOnly) {
    const char* config = R"({"campaign": "r", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "halton", "points": 4}})";
    folder.write("r.json", config);
    ASSERT_EQ(program({"run", "r.json", "--quiet"}).code, 0);
    expect_refused(program({"run", "r.json", "--adopt", "r"}), "only answers of a program are adopted");
}

}  // namespace grainsweep::tests::adoption_test
