// Results that were computed elsewhere, imported through the real program.
#include "tests/support/failing_call.hpp"
#include "tests/support/program_campaigns.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::imports_test {

using nlohmann::json;
using testing::HasSubstr;

const std::string doubles =
    "awk -v x=\"$1\" 'BEGIN { printf \"{\\\"y\\\": %.17g}\\n\", 2 * x }' > out.json\necho run >> \"$RUNS\"\n";

struct Imports : testing::Test {
    Folder folder;
    json campaign = script_campaign(8, {{"environment", {{"RUNS", (folder / "runs").string()}}},
                                        {"parameters", {{"x", {{"unit", "m"}}}}},
                                        {"observables", {{"y", {{"unit", "Pa"}, {"bounds", {0, 100}}}}}}});

    void SetUp() override {
        folder.write("script.sh", doubles);
        folder.write("c.json", campaign.dump());
    }
    void rewrite(const json& changes) {
        campaign.merge_patch(changes);
        folder.write("c.json", campaign.dump());
    }
    [[nodiscard]] Ended program(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    [[nodiscard]] Ended imported(const std::string& table, std::vector<std::string> options = {}) const {
        folder.write("old.csv", table);
        options.insert(options.begin(), {"import", "old.csv", "c.json", "p.db"});
        return program(options);
    }
    [[nodiscard]] std::ptrdiff_t runs() const {
        std::ifstream file(folder / "runs");
        return std::count(std::istreambuf_iterator<char>(file), {}, '\n');
    }
    [[nodiscard]] json answer(const std::vector<std::string>& arguments) const {
        auto all = arguments;
        all.insert(all.end(), {"--format", "json"});
        const auto ended = program(all);
        EXPECT_EQ(ended.code, 0) << ended.err;
        return json::parse(ended.out);
    }
};

TEST_F(Imports, StandBesideTheDesignForModelsAlone) {
    const auto ended = imported("x [mm],y [Pa]\n100,0.2\n300,0.6\n550,1.1\n710,1.42\n950,1.9\n");
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("5 cases imported into 'p': 0 of its design, 5 beside it in 'p_imported'"));
    ASSERT_EQ(program({"run", "c.json", "--db", "p.db", "-j", "2"}).code, 0);
    EXPECT_EQ(runs(), 8);

    EXPECT_EQ(answer({"converge", "p.db"})[0]["campaign"], "p") << "moments are those of the design";
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p")[0]["n"], 8);
    EXPECT_EQ(rows_of(folder, "SELECT count(y) AS n FROM p_imported")[0]["n"], 5);
    EXPECT_EQ(rows_of(folder, "SELECT x FROM p_imported ORDER BY x LIMIT 1")[0]["x"], 0.1);
    EXPECT_EQ(answer({"predict", "p.db", "--at", "x=0.5"})["model"]["cases"], 13);

    const auto origin = rows_of(folder, "SELECT name, line FROM attempt_import ORDER BY line");
    ASSERT_EQ(origin.size(), 5U);
    EXPECT_EQ(origin[0]["name"], "old.csv");
    EXPECT_EQ(origin[0]["line"], 2);
    EXPECT_THAT(program({"status", "p.db"}).out, HasSubstr("imported    5 cases, computed elsewhere"));
    const auto id = rows_of(folder, "SELECT case_id FROM p_imported LIMIT 1")[0]["case_id"].get<std::string>();
    EXPECT_THAT(program({"explain", "p.db", id}).out,
                HasSubstr("computed elsewhere and imported from 'old.csv', line 2"));
    const auto verified = program({"verify", "p.db"});
    EXPECT_EQ(verified.code, 0) << verified.out;
    EXPECT_THAT(verified.out, HasSubstr("5 of them computed elsewhere"));
    EXPECT_EQ(program({"report", "p.db"}).code, 0);
}

TEST_F(Imports, SettleThePointsOfTheDesign) {
    ASSERT_EQ(imported("x,y,outcome\n0.5,1,completed\n0.25,0.5,completed\n0.75,,unstable\n0.9,,crashed\n").code, 0);
    const auto ended = program({"run", "c.json", "--db", "p.db", "-j", "2"});
    EXPECT_EQ(ended.code, 1) << "one case is unstable";
    EXPECT_THAT(ended.out, HasSubstr("3 of the cases were computed elsewhere and imported"));
    EXPECT_EQ(runs(), 5) << "three points of the first eight have answers";
    const auto rows = rows_of(folder, "SELECT outcome, count(*) AS n FROM p GROUP BY 1 ORDER BY 1");
    EXPECT_EQ(rows[0]["n"], 7);
    EXPECT_EQ(rows[1]["outcome"], "unstable");
    EXPECT_EQ(answer({"converge", "p.db"})[0]["campaign"], "p");
}

TEST_F(Imports, AgainChangeNothing) {
    const auto table = "x,y\n0.5,1\n0.1,0.2\n";
    ASSERT_EQ(imported(table).code, 0);
    const auto before = program({"dump", "p.db"}).out;
    const auto again = imported(table);
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr("0 cases imported into 'p'; 2 were there before"));
    EXPECT_EQ(program({"dump", "p.db"}).out, before);
    ASSERT_EQ(imported("x,y\n0.5,1\n0.2,0.4\n0.1,0.2\n").code, 0) << "a longer file adds its new lines";
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p_imported")[0]["n"], 2);
    EXPECT_EQ(program({"verify", "p.db"}).code, 0);
}

TEST_F(Imports, RefuseAnswersThatTheDatabaseContradicts) {
    ASSERT_EQ(program({"run", "c.json", "--db", "p.db", "-j", "2"}).code, 0);
    const auto computed = imported("x,y\n0.5,1.25\n");
    EXPECT_EQ(computed.code, 2);
    EXPECT_THAT(computed.err, HasSubstr("old.csv: line 2, column 'y': got 1.25; case "));
    EXPECT_THAT(computed.err, HasSubstr("computed by a run, has 1"));
    EXPECT_EQ(imported("x,y\n0.5,1\n").code, 0);

    ASSERT_EQ(imported("x,y\n0.1,0.2\n").code, 0);
    const auto other = imported("x,y\n0.2,0.4\n0.1,0.21\n");
    EXPECT_EQ(other.code, 2);
    EXPECT_THAT(other.err, HasSubstr("imported from 'old.csv', line 2, has 0.2"));
    EXPECT_EQ(rows_of(folder, "SELECT count(*) AS n FROM p_imported")[0]["n"], 1) << "nothing of the file is stored";
}

TEST_F(Imports, TakeRepeatsByTheirNumber) {
    rewrite({{"replicates", 2}});
    ASSERT_EQ(imported("x,y,replicate\n0.5,1,0\n0.5,1.1,1\n0.1,0.2,0\n0.1,0.3,3\n").code, 0);
    EXPECT_EQ(rows_of(folder, "SELECT replicate, y FROM p WHERE x = 0.5 ORDER BY 1")[1]["y"], 1.1);
    EXPECT_EQ(rows_of(folder, "SELECT replicate FROM p_imported ORDER BY 1")[1]["replicate"], 3);
    EXPECT_EQ(program({"verify", "p.db"}).code, 0);
}

TEST_F(Imports, ComeFromOtherDatabasesAndSpreadsheets) {
    ASSERT_EQ(program({"run", "c.json", "--db", "other.db", "-j", "2"}).code, 0);
    const auto view = program({"query", "other.db", "SELECT * FROM p", "--format", "csv"}).out;
    ASSERT_EQ(imported(view).code, 0);
    EXPECT_EQ(rows_of(folder, "SELECT count(y) AS n FROM p")[0]["n"], 8);
    ASSERT_EQ(imported("x;y (kPa);who\n0,1;0,0002;me\n", {"--decimal", "comma", "--ignore", "who"}).code, 0);
    EXPECT_EQ(rows_of(folder, "SELECT y FROM p_imported")[0]["y"], 0.2);
}

TEST_F(Imports, ServeScenesOfTheSolver) {
    json rehearsal = {{"campaign", "r"},
                      {"scene", "rehearsal"},
                      {"factors", {{{"name", "x1"}, {"between", {0, 1}}}, {{"name", "x2"}, {"between", {0, 1}}}}},
                      {"fixed", {{"response", "g_function"}}},
                      {"design", {{"kind", "halton"}, {"points", 32}, {"first", 1000}}}};
    folder.write("heap.json", rehearsal.dump());
    ASSERT_EQ(program({"run", "heap.json", "--db", "other.db", "-j", "2", "--quiet"}).code, 0);
    folder.write("old.csv", program({"query", "other.db", "SELECT x1, x2, y FROM r", "--format", "csv"}).out);
    rehearsal["design"]["first"] = 1;
    folder.write("heap.json", rehearsal.dump());
    ASSERT_EQ(program({"import", "old.csv", "heap.json", "r.db"}).code, 0);
    ASSERT_EQ(program({"run", "heap.json", "--db", "r.db", "-j", "2", "--quiet"}).code, 0);
    EXPECT_EQ(answer({"predict", "r.db", "--at", "x1=0.5", "--at", "x2=0.5"})["model"]["cases"], 64);
    EXPECT_TRUE(answer({"window", "r.db", "--where", "y > 0.5"}).contains("share_of_box"));
    EXPECT_EQ(program({"verify", "r.db"}).code, 0);
}

TEST_F(Imports, InformACalibration) {
    json calibration = {{"campaign", "k"},
                        {"scene", "program"},
                        {"program", campaign["program"]},
                        {"factors", campaign["factors"]},
                        {"calibration",
                         {{"targets", {{{"observable", "y"}, {"value", 0.8}, {"error", 0.02}}}},
                          {"discrepancy", {{"y", 0.01}}},
                          {"waves", 2},
                          {"points_per_wave", 12}}}};
    folder.write("k.json", calibration.dump());
    folder.write("old.csv", "x,y\n0.4,0.8\n0.1,0.2\n0.9,1.8\n");
    ASSERT_EQ(program({"import", "old.csv", "k.json", "k.db"}).code, 0);
    const auto ended = program({"calibrate", "k.json", "--db", "k.db", "-j", "2"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(program({"converge", "k.db"}).out,
                HasSubstr("3 settings that were computed elsewhere are in the models"));
    folder.write("old.csv", "x,y\n0.3,0.6\n");
    const auto late = program({"import", "old.csv", "k.json", "k.db"});
    EXPECT_EQ(late.code, 2);
    EXPECT_THAT(late.err, HasSubstr("has begun"));
}

/// A calibration with two experiments.
json two_experiments() {
    return json::parse(R"({"campaign": "k",
      "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
      "fixed": {"response": "spreading_a", "x4": 0.5},
      "calibration": {"experiments": {"slow": {"scene": "rehearsal", "fixed": {"x3": 0.5}},
                                      "fast": {"scene": "rehearsal", "fixed": {"x3": 0.95}}},
                      "targets": [{"of": "slow", "observable": "y", "value": 0.2370, "error": 0.003},
                                  {"of": "fast", "observable": "y", "value": 0.4949, "error": 0.003}],
                      "discrepancy": {"slow": {"y": 0.001}, "fast": {"y": 0.001}},
                      "waves": 1, "points_per_wave": 24, "checks": 4}})");
}

TEST_F(Imports, InformTheExperimentsOfACalibration) {
    folder.write("k.json", two_experiments().dump());
    folder.write("slow.csv", "x1,x2,y\n0.31,0.61,0.238\n0.22,0.48,0.199\n");
    folder.write("fast.csv", "x1,x2,y\n0.31,0.61,0.496\n");
    for (const auto* unnamed : {"", "heap"}) {
        std::vector<std::string> words = {"import", "slow.csv", "k.json", "k.db"};
        if (*unnamed != 0) words.insert(words.end(), {"--experiment", unnamed});
        const auto refused = program(words);
        EXPECT_EQ(refused.code, 2);
        EXPECT_THAT(refused.err, HasSubstr("must be one of fast, slow: lines belong to one of its experiments"));
    }
    const auto slow = program({"import", "slow.csv", "k.json", "--experiment", "slow"});
    ASSERT_EQ(slow.code, 0) << slow.err;
    EXPECT_THAT(slow.out, HasSubstr("2 cases imported into 'k_slow'"));
    ASSERT_EQ(program({"import", "fast.csv", "k.json", "k.db", "--experiment", "fast"}).code, 0);
    const auto ended = program({"calibrate", "k.json", "--db", "k.db", "-j", "2"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(program({"converge", "k.db"}).out,
                HasSubstr("3 settings that were computed elsewhere are in the models"));
    EXPECT_EQ(program({"calibrate", "k.json", "--db", "k.db", "-j", "1"}).code, 0) << "again: nothing is left to run";
    EXPECT_EQ(program({"verify", "k.db"}).code, 0);
    folder.write("late.csv", "x1,x2,y\n0.5,0.5,0.3\n");
    const auto late = program({"import", "late.csv", "k.json", "k.db", "--experiment", "fast"});
    EXPECT_EQ(late.code, 2);
    EXPECT_THAT(late.err, HasSubstr("has begun"));
    const auto needless = program({"import", "slow.csv", "c.json", "p.db", "--experiment", "slow"});
    EXPECT_EQ(needless.code, 2);
    EXPECT_THAT(needless.err, HasSubstr("no calibration with experiments; leave the option out"));
}

/// A wrong file and the sentence that refuses it.
struct WrongFile {
    std::string table, sentence;
    std::vector<std::string> options = {};
};

TEST_F(Imports, RefuseWrongFilesInOneSentence) {
    rewrite(
        {{"where", "x < 0.97"}, {"fixed", {{"gap", 3}}}, {"program", {{"parameters", {{"gap", {{"unit", "mm"}}}}}}}});
    const std::vector<WrongFile> wrong = {
        {"", "old.csv: the file is empty"},
        {"x,y\n", "old.csv: it has no line below its header"},
        {"0.1,0.2\n0.2,0.4\n", "its first line has the number"},
        {"x,z\n0.1,1\n", "column 'z' is no parameter and no scalar of the campaign; --ignore z leaves it out"},
        {"y\n1\n", "its header has no column for factor 'x'"},
        {"x\n0.1\n", "it has no column of an observable; they are y"},
        {"x,y,y\n0.1,1,1\n", "its header names 'y' twice"},
        {"x,y\n0.1\n", "record 2 has 1 cells and the header 2"},
        {"x,y\n0.1,abc\n", "line 2, column 'y': got \"abc\"; must be a number in Pa"},
        {"x,y\n,1\n", "line 2, column 'x': got \"\"; factor 'x' needs a value"},
        {"x,y\n1.5,1\n", "line 2, column 'x': got \"1.5\"; factor 'x' goes from 0 to 1"},
        {"x,y\n0.1,-1\n", "line 2, column 'y': got \"-1\"; 'y' must be a number from 0 to 100"},
        {"x [kg],y\n0.1,1\n", "old.csv: column 'x': [kg]"},
        {"x;y\n0,1;0,2\n", "line 2, column 'x': got \"0,1\"; must have a decimal point; --decimal comma"},
        {"x;y\n0.1;0,2\n", "has a point, and --decimal comma is given", {"--decimal", "comma"}},
        {"x,y\n0.1,0.2\n0.1,0.3\n", "line 3, column 'y': got 0.3; line 2 has the same inputs and 0.2"},
        {"x,y,outcome\n0.1,0.2,complete\n", "line 2, column 'outcome': got \"complete\"; must be one of"},
        {"x,y,outcome\n0.1,0.2,unstable\n", "line 2, column 'y': got \"0.2\"; the case is unstable"},
        {"x,y,replicate\n0.1,0.2,-1\n", "line 2, column 'replicate': got \"-1\"; must be a whole number from 0"},
        {"x,y,gap\n0.1,0.2,4\n", "line 2, column 'gap': got \"4\"; the campaign has gap = 3"},
        {"x,y\n0.98,1\n", "line 2: the campaign's `where`, x < 0.97, excludes this setting"},
        {"x,y\n0.1,\n", "line 2: a completed case has at least one value"},
        {"x,y\n0.1,inf\n", "line 2, column 'y': got \"inf\"; must be"},
        {"x,y\n0.1,1\n", "--ignore: got who; 'old.csv' has no such column", {"--ignore", "who"}},
    };
    for (const auto& one : wrong) {
        const auto ended = imported(one.table, one.options);
        EXPECT_EQ(ended.code, 2) << one.table;
        EXPECT_THAT(ended.err, HasSubstr(one.sentence)) << one.table;
        EXPECT_EQ(std::count(ended.err.begin(), ended.err.end(), '\n'), 1) << ended.err;
    }
    EXPECT_FALSE(std::filesystem::exists(folder / "p.db")) << "a refused file leaves no database";
}

TEST_F(Imports, ContinueAfterAKillAtEachSync) {
    const std::vector<std::string> import = {"import", "old.csv", "c.json", "p.db"};
    ASSERT_EQ(imported("x,y\n0.11,0.22\n0.53,1.06\n").code, 0);
    const auto whole = program({"dump", "p.db"}).out;
    folder.write("p.db", "");  // killed before it wrote
    EXPECT_EQ(program(import).code, 0);
    int syncs = 0;
    for (bool killed = true; killed; ++syncs) {
        for (const char* file : {"p.db", "p.db-wal", "p.db-shm"}) std::filesystem::remove(folder / file);
        const FailingCall call{"main", "sync", "p.db-wal", "after", syncs + 1};
        (void)Process(command_with(call, folder / "token", import), folder.path()).wait();
        killed = has_happened(folder / "token");
        const auto again = program(import);
        EXPECT_EQ(again.code, 0) << call.name() << ": " << again.err;
        EXPECT_EQ(program({"dump", "p.db"}).out, whole) << call.name();
    }
    EXPECT_GT(syncs, 3);
}

}  // namespace grainsweep::tests::imports_test
