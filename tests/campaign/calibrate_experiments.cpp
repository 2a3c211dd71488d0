// A calibration over several experiments through the real program: waves, one posterior, verdict, interruption,
// refusals.
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::calibrate_experiments_test {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// x1 = 0.3 and x2 = 0.6, "measured" by a sum, which leaves a ridge, and by the spreading response, which crosses it.
json config() {
    return json::parse(R"({"campaign": "two",
  "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}], "fixed": {"x4": 0.5},
  "calibration": {
    "experiments": {"heap": {"scene": "rehearsal", "fixed": {"noise": 0.001}},
                    "rate": {"scene": "rehearsal", "fixed": {"response": "spreading_a", "x3": 0.95, "noise": 0.02}}},
    "targets": [{"of": "heap", "observable": "y", "value": 7.9, "error": 0.02},
                {"of": "rate", "observable": "y", "value": 0.5093, "error": 0.003}],
    "discrepancy": {"heap": {"y": 0.001}, "rate": {"y": 0.001}}, "waves": 3, "points_per_wave": 24}})");
}

std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::string dump(const Folder& folder, const std::string& db) {
    const auto ended = run_program({"dump", db}, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.out;
}

Ended calibrate(const Folder& folder, const std::string& db, const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"calibrate", "c.json", "--db", db};
    words.insert(words.end(), more.begin(), more.end());
    return run_program(words, folder.path());
}

std::string refusal(const Folder& folder, const json& changed) {
    folder.write("c.json", changed.dump());
    const auto ended = calibrate(folder, "none.db");
    EXPECT_EQ(ended.code, 2) << ended.out;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "none.db"));
    return ended.err;
}

std::string last_line(const std::string& text) {
    const auto end = text.find_last_not_of('\n');
    return text.substr(text.find_last_of('\n', end) + 1, end - text.find_last_of('\n', end));
}

TEST(CalibrateExperiments, ShareOnePosteriorThatHoldsTheTruth) {
    const Folder folder;
    folder.write("c.json", config().dump());
    const auto planned = run_program({"plan", "c.json"}, folder.path());
    EXPECT_EQ(planned.code, 0) << planned.err;
    EXPECT_THAT(planned.out, HasSubstr("all waves of all experiments:"));
    EXPECT_EQ(json::parse(run_program({"plan", "c.json", "--format", "json"}, folder.path()).out).size(), 2U);

    const auto ended = run_program({"calibrate", "c.json", "-j", "2"}, folder.path());
    ASSERT_EQ(ended.code, 0) << ended.err << ended.out;
    EXPECT_THAT(ended.out, HasSubstr("heap y"));
    EXPECT_THAT(ended.out, HasSubstr("rate y"));
    EXPECT_THAT(last_line(ended.out), ::testing::StartsWith("calibrated; "));

    const auto said = run_program({"converge", "two.db", "--format", "json"}, folder.path());
    ASSERT_EQ(said.code, 0) << said.err;
    const auto found = json::parse(said.out);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_EQ(found[0]["verdict"], "calibrated");
    EXPECT_EQ(found[1]["shown_with"], "two_heap");
    for (const auto& [factor, truth] : {std::pair(0, 0.3), std::pair(1, 0.6)}) {
        const auto sd = found[0]["posterior"][factor]["sd"].get<double>();
        EXPECT_NEAR(found[0]["posterior"][factor]["mean"].get<double>(), truth, 3 * sd);
        EXPECT_LT(sd, 0.06) << "both are determined";
    }
    // A view of each experiment, with the same settings.
    const auto same = run_program({"query", "two.db", "--format", "json",
                                   "SELECT count(*) AS n FROM two_heap JOIN two_rate USING (point, x1, x2)"},
                                  folder.path());
    EXPECT_EQ(json::parse(same.out)[0]["n"], found[0]["waves"].back()["cases"].get<int>() / 2 + 8);
    const auto draws = contents(folder.path() / "two_posterior.csv");
    EXPECT_THAT(draws, ::testing::StartsWith("x1,x2\n"));
    EXPECT_GT(std::ranges::count(draws, '\n'), 1000);

    EXPECT_EQ(run_program({"report", "two.db", "-o", "a.html"}, folder.path()).code, 0);
    EXPECT_EQ(run_program({"verify", "two.db"}, folder.path()).code, 0);
    EXPECT_EQ(run_program({"window", "two.db", "--campaign", "two_rate", "--maximize", "y", "--next", "2",
                           "--next-file", "n.json"},
                          folder.path())
                  .code,
              0);
    const auto next = run_program({"run", "n.json", "--db", "two.db", "--quiet"}, folder.path());
    EXPECT_EQ(next.code, 0) << next.err;
}

TEST(CalibrateExperiments, GiveTheSameInterruptedOrNotWithOneWorkerOrTwo) {
    const Folder folder;
    folder.write("c.json", config().dump());
    ASSERT_EQ(calibrate(folder, "one.db", {"-j", "1", "--quiet"}).code, 0);
    const auto draws = contents(folder.path() / "two_posterior.csv");
    ASSERT_EQ(calibrate(folder, "two.db", {"-j", "2", "--quiet"}).code, 0);
    int runs = 0;
    while (calibrate(folder, "parts.db", {"-j", "2", "--quiet", "--max-cases", "17"}).code != 0) ASSERT_LT(++runs, 30);
    EXPECT_GE(runs, 2);
    EXPECT_EQ(dump(folder, "one.db"), dump(folder, "two.db"));
    EXPECT_EQ(dump(folder, "one.db"), dump(folder, "parts.db"));
    EXPECT_EQ(contents(folder.path() / "two_posterior.csv"), draws);
}

TEST(CalibrateExperiments, NameWhatIsNotReproducedAndEndWithOne) {
    const Folder folder;
    auto against = config();
    against["calibration"]["experiments"]["rate"]["fixed"] = {{"noise", 0.001}};  // the same sum, another value
    against["calibration"]["targets"][1]["value"] = 8.015;                        // 2.8 sd from halfway: not ruled out
    against["calibration"]["targets"][1]["error"] = 0.02;
    against["calibration"]["waves"] = 2;
    folder.write("c.json", against.dump());
    const auto ended = calibrate(folder, "a.db");
    EXPECT_EQ(ended.code, 1) << ended.err;
    EXPECT_THAT(last_line(ended.out), ::testing::ContainsRegex("^not reproduced: (heap|rate) y by [0-9.]+ sd; "));
    EXPECT_THAT(ended.out, HasSubstr("checks")) << "they were learned, and another wave followed";

    auto wide = config();
    wide["calibration"]["experiments"].erase("rate");
    wide["calibration"]["targets"].erase(1);
    wide["calibration"]["discrepancy"].erase("rate");
    folder.write("c.json", wide.dump());
    const auto ridge = calibrate(folder, "b.db");
    EXPECT_EQ(ridge.code, 0) << ridge.err;
    EXPECT_THAT(last_line(ridge.out), ::testing::StartsWith("not determined: x1 along a ridge with x2, x2 along"));
}

TEST(CalibrateExperiments, AFactorMayBeMissingInOneButNotInAll) {
    const Folder folder;
    folder.write("f.py",
                 "import json, sys\nfor line in sys.stdin:\n    q = json.loads(line)['inputs']\n"
                 "    print(json.dumps({'observables': {'t': q['x1'] + q['friction']}}), flush=True)\n");
    auto asked = config();
    asked["factors"][1]["name"] = "friction";
    asked["calibration"]["experiments"]["rate"] = json::parse(
        R"({"program": {"command": ["python3", "f.py"], "files": ["f.py"], "protocol": "lines", "observables": {"t": {}}}})");
    asked["calibration"]["targets"][0]["value"] = 7.8;  // x1 = 0.3 and x2 = 0.5
    asked["calibration"]["targets"][1] = {{"of", "rate"}, {"observable", "t"}, {"value", 0.9}, {"error", 0.02}};
    asked["calibration"]["discrepancy"]["rate"] = {{"t", 0.001}};
    folder.write("c.json", asked.dump());
    const auto ended = calibrate(folder, "a.db", {"-j", "1"});
    EXPECT_EQ(ended.code, 0) << ended.err << ended.out;
    const auto said = run_program({"converge", "a.db", "--format", "json"}, folder.path());
    const auto posterior = json::parse(said.out)[0]["posterior"];
    EXPECT_NEAR(posterior[0]["mean"].get<double>(), 0.3, 0.05);
    EXPECT_NEAR(posterior[1]["mean"].get<double>(), 0.6, 0.05);
    EXPECT_EQ(run_program({"query", "a.db", "SELECT friction FROM two_heap"}, folder.path()).code, 2);
}

TEST(CalibrateExperiments, RefuseInOneSentence) {
    const Folder folder;
    auto asked = config();
    asked["scene"] = "rehearsal";
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.scene: with several experiments it has no place here"));
    asked = config();
    asked["calibration"]["targets"][0].erase("of");
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.calibration.targets[0]: key 'of' is missing"));
    asked = config();
    asked["calibration"]["targets"][1]["of"] = "rates";
    EXPECT_THAT(refusal(folder, asked), HasSubstr("Did you mean 'rate'?"));
    asked = config();
    asked["calibration"]["targets"][1]["observable"] = "z";
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.calibration.targets[1].observable"));
    asked = config();
    asked["calibration"]["targets"].erase(1);
    EXPECT_THAT(refusal(folder, asked), HasSubstr("no target is measured in this experiment"));
    asked = config();
    asked["calibration"]["discrepancy"].erase("rate");
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.calibration.discrepancy: 'rate' is missing"));
    asked = config();
    asked["calibration"]["discrepancy"]["rate"] = {{"x", 1}};
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.calibration.discrepancy.rate"));
    asked = config();
    asked["calibration"]["experiments"]["rate"]["fixed"]["x33"] = 1;
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.calibration.experiments.rate.fixed.x33"));
    const auto planned = run_program({"plan", "c.json", "--format", "json"}, folder.path());
    EXPECT_EQ(json::parse(planned.out)["error"]["code"], 2) << "no list is begun: " << planned.out;
    asked = config();
    asked["calibration"]["experiments"]["rate"].erase("scene");
    EXPECT_THAT(refusal(folder, asked), HasSubstr("an experiment has a \"scene\""));
    asked = config();
    asked["factors"].push_back({{"name", "x17"}, {"between", {0, 1}}});
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.factors[2].name: got x17; no experiment has this parameter"));
    asked = config();
    asked["calibration"]["points_per_wave"] = 13;
    asked["factors"].push_back({{"name", "x5"}, {"between", {0, 1}}});
    EXPECT_THAT(refusal(folder, asked), HasSubstr("at least 16 points"));
    asked = config();
    asked["calibration"]["experiments"]["heap"]["scene"] = "hopper";
    EXPECT_THAT(refusal(folder, asked), HasSubstr("has none of the factors"));
    folder.write("c.json", config().dump());
    const auto solved = run_program({"solve", "c.json"}, folder.path());
    EXPECT_EQ(solved.code, 2);
    EXPECT_THAT(solved.err, HasSubstr("plan, run and calibrate take several experiments"));
}

}  // namespace grainsweep::tests::calibrate_experiments_test
