// A calibration through the real program: waves, posterior, predictive check, interruption, refusals.
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

namespace grainsweep::tests::calibrate_test {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

/// What the spreading response is at x1 = 0.3, x2 = 0.6, "measured" under two conditions.
json config() {
    return json::parse(R"({"campaign": "fit", "scene": "rehearsal",
  "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
  "fixed": {"response": "spreading_a", "x4": 0.5, "noise": 0.02},
  "calibration": {"targets": [{"observable": "y", "value": 0.2370, "error": 0.003, "inputs": {"x3": 0.5}},
                              {"observable": "y", "value": 0.4949, "error": 0.003, "inputs": {"x3": 0.95}}],
                  "discrepancy": {"y": 0.001}, "waves": 3, "points_per_wave": 24}})");
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

TEST(CalibrateCampaign, FindsTheTruthAndNamesTheRidge) {
    const Folder folder;
    folder.write("c.json", config().dump());
    const auto ended = calibrate(folder, "a.db", {"-j", "2"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    for (const char* part : {"posterior", "y at x3 = 0.95", "fresh runs", "x1 and x2 are determined together",
                             "along a ridge of equal fit"})
        EXPECT_THAT(ended.out, HasSubstr(part));
    const auto said = run_program({"converge", "a.db", "--format", "json"}, folder.path());
    ASSERT_EQ(said.code, 0) << said.err;
    const auto found = json::parse(said.out)[0];
    EXPECT_TRUE(found["ended"].get<bool>());
    for (const auto& [factor, truth] : {std::pair(0, 0.3), std::pair(1, 0.6)}) {
        EXPECT_LE(found["posterior"][factor]["q05"].get<double>(), truth);
        EXPECT_GE(found["posterior"][factor]["q95"].get<double>(), truth);
    }
    EXPECT_LT(found["posterior"][1]["sd"].get<double>(), 0.05) << "x2 is determined, x1 hardly";
    for (const auto& target : found["targets"]) {
        EXPECT_EQ(target["runs"], 8);
        EXPECT_LT(std::abs(target["z"].get<double>()), 3);
    }
}

TEST(CalibrateCampaign, TwoImpactsOfAGrainEndCalibrated) {
    const Folder folder;
    std::filesystem::copy_file(source("configs/calibrate_grain.json"), folder.path() / "c.json");
    const auto ended = calibrate(folder, "a.db", {"-j", "2"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, ::testing::EndsWith("\ncalibrated; all cases are settled\n"));
    const auto said = run_program({"converge", "a.db", "--format", "json"}, folder.path());
    const auto found = json::parse(said.out)[0];
    for (const auto& [factor, truth] : {std::pair(0, 0.87), std::pair(1, 0.25)}) {
        EXPECT_LE(found["posterior"][factor]["q05"].get<double>(), truth);
        EXPECT_GE(found["posterior"][factor]["q95"].get<double>(), truth);
    }
}

// The measured response is one of two, which differ at x3 = 0.4 only; x2 is a whole number of fifths.
TEST(CalibrateCampaign, FindsAWordAndAMultiple) {
    const Folder folder;
    auto asked = config();
    asked["calibration"]["targets"][0] = json::parse(R"({"observable": "y", "value": 0.1323, "error": 0.003,
                                                         "inputs": {"x3": 0.4}})");
    asked["fixed"] = {{"x1", 0.3}, {"x4", 0.5}, {"noise", 0.02}};
    asked["factors"] = json::parse(R"([{"name": "response", "levels": ["spreading_b", "spreading_a"]},
                                       {"name": "x2", "between": [0, 1], "step": 0.2}])");
    folder.write("c.json", asked.dump());
    const auto ended = calibrate(folder, "a.db", {"-j", "2"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("posterior probability of each level"));
    const auto said = run_program({"converge", "a.db", "--format", "json"}, folder.path());
    ASSERT_EQ(said.code, 0) << said.err;
    const auto found = json::parse(said.out)[0];
    const auto& response = found["posterior"][0];
    EXPECT_TRUE(response["mean"].is_null());
    EXPECT_EQ(response["verdict"], "determined");
    EXPECT_EQ(response["levels"][1]["level"], "spreading_a");
    EXPECT_GT(response["levels"][1]["probability"].get<double>(), 0.95);
    ASSERT_EQ(found["posterior"][1]["levels"].size(), 6U);
    EXPECT_EQ(found["posterior"][1]["levels"][3]["level"], "0.6");
    EXPECT_GT(found["posterior"][1]["levels"][3]["probability"].get<double>(), 0.95);
    std::stringstream draws;
    draws << std::ifstream(folder.path() / "fit_posterior.csv").rdbuf();
    EXPECT_THAT(draws.str(), HasSubstr("\nspreading_a,0.6\n"));
    for (const auto* panel : {"posterior", "posterior:response", "posterior:response,x2"}) {
        const auto drawn = run_program({"figure", "a.db", panel, "-o", "a.svg"}, folder.path());
        EXPECT_EQ(drawn.code, 0) << drawn.err;
    }
    const auto report = run_program({"report", "a.db"}, folder.path());
    EXPECT_EQ(report.code, 0) << report.err;
}

TEST(CalibrateCampaign, GivesTheSameInterruptedOrNotWithOneWorkerOrTwo) {
    const Folder folder;
    folder.write("c.json", config().dump());
    ASSERT_EQ(calibrate(folder, "one.db", {"-j", "1", "--quiet"}).code, 0);
    ASSERT_EQ(calibrate(folder, "two.db", {"-j", "2", "--quiet"}).code, 0);
    int runs = 0;
    while (calibrate(folder, "parts.db", {"-j", "2", "--quiet", "--max-cases", "17"}).code != 0) ASSERT_LT(++runs, 20);
    EXPECT_GE(runs, 2);
    EXPECT_EQ(dump(folder, "one.db"), dump(folder, "two.db"));
    EXPECT_EQ(dump(folder, "one.db"), dump(folder, "parts.db"));
    // run does the same as calibrate.
    ASSERT_EQ(run_program({"run", "c.json", "--db", "run.db", "--quiet"}, folder.path()).code, 0);
    EXPECT_EQ(dump(folder, "one.db"), dump(folder, "run.db"));
}

TEST(CalibrateCampaign, SaysWhatTheTargetsCannotGive) {
    const Folder folder;
    auto contradicting = config();
    contradicting["calibration"]["waves"] = 1;
    contradicting["calibration"]["targets"][0]["value"] = 0.1;
    folder.write("c.json", contradicting.dump());
    EXPECT_THAT(calibrate(folder, "a.db").out, HasSubstr("the targets contradict each other"));
    auto far = config();
    far["calibration"]["waves"] = 1;
    far["calibration"]["targets"][0]["value"] = 3;
    folder.write("c.json", far.dump());
    const auto unreachable = calibrate(folder, "b.db").out;
    EXPECT_THAT(unreachable, HasSubstr("no case came near the measured 3"));
    EXPECT_THAT(unreachable, HasSubstr("no setting is within 3 standard deviations of all"));
    EXPECT_THAT(unreachable, Not(HasSubstr("contradict"))) << "the other target can be met";
}

TEST(CalibrateCampaign, FollowsAMeasuredCurve) {
    const Folder folder;
    // y_series is y times the time, y = x1 + 15 halves.
    folder.write("curve.csv", "time (ms),y (%),sd (%)\n250,195,2\n777.72,606.6216,2\n");
    auto asked = json::parse(R"({"campaign": "along", "scene": "rehearsal",
      "factors": [{"name": "x1", "between": [0, 1]}], "fixed": {"behaviour": "huge"},
      "calibration": {"targets": [{"observable": "y_series", "file": "curve.csv"}], "discrepancy": {"y_series": 0.01},
                      "waves": 1, "points_per_wave": 12, "checks": 2}})");
    folder.write("c.json", asked.dump());
    const auto ended = calibrate(folder, "a.db", {"-j", "1"});
    ASSERT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("y_series@0.77772"));
    const auto said = run_program({"converge", "a.db", "--format", "json"}, folder.path());
    const auto found = json::parse(said.out)[0];
    EXPECT_NEAR(found["posterior"][0]["mean"].get<double>(), 0.3, 0.01);

    const auto refused = [&](const std::string& file) {
        folder.write("curve.csv", file);
        return refusal(folder, asked);
    };
    EXPECT_THAT(refused("time (mm),y,sd\n1,1,1\n2,2,1\n"), HasSubstr("'mm' does not fit 's'"));
    EXPECT_THAT(refused("time (s),y (mm),sd\n1,1,1\n2,2,1\n"), HasSubstr("the head \"y (mm)\" states a unit"));
    EXPECT_THAT(refused("time\n1\n"), HasSubstr("its header has 1 columns"));
    EXPECT_THAT(refused("time,y\n0.1,1\n0.2,2\n"), HasSubstr("its lines have no error"));
    EXPECT_THAT(refused("time,y,sd\n0.2,1,1\n0.1,2,1\n"), HasSubstr("record 3: places along the curve must grow"));
    EXPECT_THAT(refused("time,y,sd\n0.2,1,1\n0.3,high,1\n"), HasSubstr("record 3 has \"high\" where a number"));
    EXPECT_THAT(refused("time,y,sd\n0.2,1,1\n"), HasSubstr("it has 1 lines"));
    EXPECT_THAT(refused("time,y,sd\n0.2,1,1\n0.3,1,-1\n"), HasSubstr("record 3: an error is at least 0"));
    for (const char* numbers :
         {"0.25,1.95,0.02\n0.5,4,0.02\n0.75,6,0.02\n", "\n\n0.25,1.95,0.02\n0.5,4,0.02\n0.7,6,1\n",
          "\xEF\xBB\xBF+1.0D-01,1.95,0.02\r\n0.5,4,0.02\r\n0.7,6,1\r\n"})
        EXPECT_THAT(refused(numbers), HasSubstr("a header that names the columns is expected"));
    EXPECT_THAT(refused("\"\",\"time\",\"y\"\n\"1\",0.25,1.95\n\"2\",0.5,4\n"),
                HasSubstr("column 1 of its header has no name"));
    for (const char* name : {"index", "Unnamed: 0", "Row", "#"})
        EXPECT_THAT(refused(std::string(name) + ",y,sd\n1,1.95,0.02\n2,4,0.02\n"),
                    HasSubstr("has row numbers, where places along the curve are expected"));
    EXPECT_THAT(refused("index,time,y\n3,0.25,1.95\n7,0.5,4\n"), HasSubstr("has row numbers, where places"));
    for (const char* first : {"0,0.25,1.95\n1,0.5,4\n", "1,0.25,-1\n2,0.5,4\n3,0.75,6\n"})
        EXPECT_THAT(refused(std::string("X,time,y\n") + first), HasSubstr("counts the rows, its second, \"time\""));
    EXPECT_THAT(refused("time;y;sd\n0,25;1,95;0,02\n0,5;4;0,02\n"), HasSubstr("its header has semicolons between"));
    EXPECT_THAT(refused("time\ty\tsd\n0.25\t1.95\t0.02\n"), HasSubstr("its header has tabs between the columns"));
    EXPECT_THAT(refused("time,y,sd\ns,1,1\n0.2,1,1\n"), HasSubstr("record 2 has \"s\" where a number"));
    EXPECT_THAT(refused("time,y,sd\n0,2,1,1\n"), HasSubstr("record 2 has 4 cells and the header 3"));
    EXPECT_THAT(refused("time,y,y\n0.2,1,1\n"), HasSubstr("its header names 'y' twice"));
    EXPECT_THAT(refused("\xFF\xFEt,y\n"), HasSubstr("not UTF-16"));
    EXPECT_THAT(refused(""), HasSubstr("the file is empty"));
    // Whole numbers are places under the name of a place, and with errors that are named so.
    for (const char* honest : {"time (s),y,Std. error\n1,2,0.1\n2,4,0.1\n", "index,y,sd\n0.5,2,0.1\n1.5,4,0.1\n",
                               "time,y,spread\n1,4,0.1\n2,2,0.1\n", "time,y,spread\n2,2,0.1\n3,4,0.1\n"}) {
        folder.write("curve.csv", honest);
        folder.write("c.json", asked.dump());
        EXPECT_EQ(run_program({"plan", "c.json"}, folder.path()).code, 0) << honest;
    }
    asked["calibration"]["targets"][0]["error"] = 0.1;
    EXPECT_THAT(refused("index,y\n1,2\n2,4\n"), HasSubstr("has row numbers, where places"));
    EXPECT_THAT(refused("X,time,y\n1,0.2,2\n2,0.4,4\n"), HasSubstr("counts the rows"));
    EXPECT_THAT(refused("time,y,sd\n0.25,1.95,0.02\n0.5,4,0.02\n"), HasSubstr("there is an \"error\" as well"));
    asked["calibration"]["targets"][0].erase("error");
    asked["calibration"]["targets"][0]["file"] = "none.csv";
    EXPECT_THAT(refusal(folder, asked), HasSubstr("there is no such file"));
    asked["calibration"]["targets"][0] = {{"observable", "y_series"}, {"value", 1}, {"error", 1}};
    EXPECT_THAT(refusal(folder, asked), HasSubstr("is a curve"));
}

/// p(x) = a x^2 + b at eleven places in the order of `places`, a list in Python; measured at `measured`.
json profile_campaign(const Folder& folder, const std::string& places, const std::string& measured) {
    folder.write("f.py",
                 "import json, sys\nfor line in sys.stdin:\n    q = json.loads(line)['inputs']\n"
                 "    p = [[t / 10, q['a'] * (t / 10) ** 2 + q['b']] for t in " +
                     places + "]\n    print(json.dumps({'observables': {'p': p}}), flush=True)\n");
    folder.write("m.csv", measured);
    return json::parse(R"({"campaign": "c", "scene": "program",
      "program": {"command": ["python3", "f.py"], "files": ["f.py"], "protocol": "lines",
                  "observables": {"p": {"shape": "profile"}}},
      "factors": [{"name": "a", "between": [0, 1]}, {"name": "b", "between": [0, 1]}],
      "calibration": {"targets": [{"observable": "p", "file": "m.csv", "error": 0.02}], "discrepancy": {"p": 0.01},
                      "waves": 1, "points_per_wave": 24, "checks": 2}})");
}

TEST(CalibrateCampaign, TheOrderInWhichAProgramWritesACurveDoesNotMatter) {
    json before;
    for (const char* places : {"range(11)", "range(10, -1, -1)", "(1, 0, 10, 9, 8, 7, 6, 5, 4, 3, 2)"}) {
        const Folder folder;
        folder.write("c.json", profile_campaign(folder, places, "x,y\n0.05,0.301\n0.55,0.421\n0.95,0.661\n").dump());
        ASSERT_EQ(calibrate(folder, "a.db", {"-j", "1", "--quiet"}).code, 0);
        // A program without a scalar: converge has the posterior all the same.
        const auto said = run_program({"converge", "a.db", "--format", "json"}, folder.path());
        ASSERT_EQ(said.code, 0) << said.err;
        const auto posterior = json::parse(said.out)[0]["posterior"];
        EXPECT_NEAR(posterior[0]["mean"].get<double>(), 0.4, 0.03);
        EXPECT_NEAR(posterior[1]["mean"].get<double>(), 0.3, 0.02);
        if (before.is_null()) before = posterior;
        EXPECT_EQ(posterior, before) << places;
        EXPECT_EQ(run_program({"status", "a.db"}, folder.path()).code, 0);
        EXPECT_EQ(run_program({"report", "a.db", "-o", "a.html"}, folder.path()).code, 0);
        for (const char* command : {"sensitivity", "predict"}) {
            const auto refused = run_program({command, "a.db"}, folder.path());
            EXPECT_EQ(refused.code, 2) << command;
            EXPECT_THAT(refused.err, HasSubstr("measures no scalar")) << command;
        }
    }
}

TEST(CalibrateCampaign, APlaceBeyondTheCurvesIsNamedWithWhatTheyCover) {
    const Folder folder;
    folder.write("c.json", profile_campaign(folder, "range(11)", "x,y\n0.5,0.4\n2,0.7\n").dump());
    const auto ended = calibrate(folder, "a.db", {"-j", "1"});
    EXPECT_EQ(ended.code, 1) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("p@2: no case has an answer to it; its curves cover 0 to 1"));
    EXPECT_EQ(calibrate(folder, "a.db", {"-j", "1", "--quiet"}).code, 1) << "asked again";
    EXPECT_EQ(run_program({"report", "a.db", "-o", "a.html"}, folder.path()).code, 0);
    const auto said = run_program({"converge", "a.db"}, folder.path());
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_THAT(said.out, HasSubstr("its curves cover 0 to 1"));
    EXPECT_EQ(run_program({"converge", "a.db", "--check"}, folder.path()).code, 1);
}

/// y = a, or as `script` says; b acts on nothing.
json failing_fit(const Folder& folder, const std::string& script) {
    folder.write("f.py", "import json, sys\nfor line in sys.stdin:\n    i = json.loads(line)['inputs']\n" + script);
    return json::parse(R"({"campaign": "fit", "scene": "program",
      "program": {"command": ["python3", "f.py"], "files": ["f.py"], "protocol": "lines", "observables": {"y": {}}},
      "factors": [{"name": "a", "between": [0, 1]}, {"name": "b", "between": [0, 1]}],
      "calibration": {"targets": [{"observable": "y", "value": 0.5, "error": 0.02}], "discrepancy": {"y": 0.01},
                      "waves": 2, "points_per_wave": 30, "checks": 8}})");
}

TEST(CalibrateCampaign, FailuresAreNoReasonToCallAFactorDetermined) {
    const Folder folder;
    folder.write("c.json", failing_fit(folder, R"(
    if i["a"] > 0.5: print('{"outcome": "unstable", "message": "too stiff"}', flush=True)
    else: print(json.dumps({"observables": {"y": i["a"]}}), flush=True)
)")
                               .dump());
    const auto ended = calibrate(folder, "a.db", {"-j", "1"});
    EXPECT_EQ(ended.code, 1) << "cases failed";
    EXPECT_THAT(ended.out, HasSubstr("\nnot determined: b"));
    EXPECT_THAT(ended.out, HasSubstr("this depends on a (p = 0.00"));
    EXPECT_THAT(ended.out, ::testing::Not(HasSubstr("calibrated;")));
    const auto found = json::parse(run_program({"converge", "a.db", "--format", "json"}, folder.path()).out)[0];
    EXPECT_EQ(found["posterior"][0]["verdict"], "determined");
    EXPECT_EQ(found["posterior"][1]["verdict"], "not determined");
}

/// A machine whose speed is undefined with the probability 1 - gate: the velocity of its grain is uniform from -1 to 1.
json fit_to_share(const Folder& folder) {
    folder.write("chance.json", R"({"name": "chance", "summary": "a grain of any velocity", "main": "speed",
      "parameters": {"gate": {"default": 0.5, "bounds": [0, 1], "meaning": "probability of a value"},
                     "size": {"unit": "m", "default": 0.001, "bounds": [0.001, 0.002], "meaning": "of the grain"}},
      "domain": {"low": [0, 0, 0], "high": [1, 1, 1]}, "gravity": [0, 0, 0],
      "materials": {"glass": {"density": 2500, "youngs_modulus": "5 MPa", "poisson_ratio": 0.3}},
      "contacts": {"restitution": 0.5, "friction": 0.5},
      "species": {"grain": {"material": "glass", "diameter": "size"}},
      "fill": [{"species": "grain", "count": 1, "shaken": 1, "in": {"box": {"low": [0.4, 0.4, 0.4], "high": [0.6, 0.6, 0.6]}}}],
      "phases": [{"name": "fly", "for": "1 ms", "frames": 1}],
      "measure": {"v": {"velocity": {"of": "grain", "along": [1, 0, 0]}, "during": "fly", "as": "last"},
                  "speed": {"velocity": {"of": "grain", "along": [1, 0, 0]}, "during": "fly", "as": "last",
                            "unless": "v > 2*gate - 1"}}})");
    return json::parse(R"({"campaign": "fit", "scene": "machine", "machine": "chance.json",
      "factors": [{"name": "gate", "between": [0, 1]}],
      "calibration": {"targets": [{"observable": "speed", "without_value": {"count": 3, "of": 10, "discrepancy": 0}}],
                      "waves": 2, "points_per_wave": 80}})");
}

// k of n without a value: with the true probability the posterior of the gate is Beta(n - k + 1, k + 1).
TEST(CalibrateCampaign, ToAShareOfRunsWithoutAValueIsAboutThePosteriorOfBayes) {
    const Folder folder;
    folder.write("c.json", fit_to_share(folder).dump());
    const auto ended = calibrate(folder, "a.db", {"-j", "2"});
    ASSERT_EQ(ended.code, 0) << ended.out << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("share without speed"));
    EXPECT_THAT(ended.err, HasSubstr("the discrepancy of share without speed is 0"));
    const auto found = json::parse(run_program({"converge", "a.db", "--format", "json"}, folder.path()).out)[0];
    EXPECT_EQ(found["waves"][0]["failed"], 0);
    const double sd = std::sqrt(8. * 4 / (12. * 12 * 13));
    EXPECT_NEAR(found["posterior"][0]["mean"].get<double>(), 8. / 12, sd);
    EXPECT_GT(found["posterior"][0]["sd"].get<double>(), 0.8 * sd);
    EXPECT_LT(found["posterior"][0]["sd"].get<double>(), 1.8 * sd) << "80 runs leave an error of their own";
    EXPECT_EQ(found["targets"][0]["value"], 0.3);
    EXPECT_EQ(found["targets"][0]["runs"], 8);
    EXPECT_EQ(run_program({"report", "a.db"}, folder.path()).code, 0);
    EXPECT_EQ(calibrate(folder, "a.db", {"-j", "1"}).code, 0) << "again: nothing is left to run";
}

// Imported lines with an empty cell are runs without a value; a table without the column says nothing of them.
TEST(CalibrateCampaign, OldResultsWithoutAValueCountAsSuch) {
    const Folder folder;
    folder.write("c.json", fit_to_share(folder).dump());
    std::string table = "gate,v,speed\n";
    for (int k = 0; k < 40; ++k) table += "0." + std::to_string(101 + 2 * k) + ",0.9,\n";
    folder.write("old.csv", table);
    const std::vector<std::string> words = {"import", "old.csv", "c.json", "a.db", "--partial"};
    const auto imported = run_program(words, folder.path());
    ASSERT_EQ(imported.code, 0) << imported.err;
    ASSERT_EQ(calibrate(folder, "a.db", {"-j", "2", "--quiet"}).code, 0);
    EXPECT_THAT(run_program({"converge", "a.db"}, folder.path()).out,
                HasSubstr("40 settings that were computed elsewhere are in the models"));
    folder.write("old.csv", "gate,v\n0.3,0.9\n");
    const auto refused = run_program({"import", "old.csv", "c.json", "b.db", "--partial"}, folder.path());
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("no column for 'speed', whose missing values the calibration counts"));
}

TEST(CalibrateCampaign, RefusesAWrongShareInOneSentence) {
    const Folder folder;
    const auto asked = fit_to_share(folder);
    const auto with = [&](const json& without, const json& more = json::object()) {
        auto changed = asked;
        changed["calibration"]["targets"][0]["without_value"] = without;
        changed["calibration"].merge_patch(more);
        return refusal(folder, changed);
    };
    const std::string place = "$.calibration.targets[0].without_value";
    EXPECT_THAT(with({{"count", 11}, {"of", 10}, {"discrepancy", 0}}),
                HasSubstr(place + ".count: got 11; must be at most the number of measured runs, 10"));
    EXPECT_THAT(with({{"count", 1.5}, {"of", 10}, {"discrepancy", 0}}), HasSubstr(place + ".count"));
    EXPECT_THAT(with({{"count", 0}, {"of", 0}, {"discrepancy", 0}}), HasSubstr(place + ".of"));
    EXPECT_THAT(with({{"count", 3}, {"of", 10}, {"discrepancy", 0.5}}), HasSubstr(place + ".discrepancy"));
    EXPECT_THAT(with({{"count", 3}, {"of", 10}}), HasSubstr("'discrepancy' is missing"));
    EXPECT_THAT(with(3), HasSubstr(place));
    EXPECT_THAT(with({{"count", 3}, {"of", 10}, {"discrepancy", 0}}, {{"discrepancy", {{"speed", 1}}}}),
                HasSubstr("no target measures a value of this observable"));
    auto both = asked;
    both["calibration"]["targets"][0]["value"] = 0.5;
    EXPECT_THAT(refusal(folder, both), HasSubstr("$.calibration.targets[0].value: got 0.5; has no place beside"));
    auto twice = asked;
    twice["calibration"]["targets"].push_back(twice["calibration"]["targets"][0]);
    EXPECT_THAT(refusal(folder, twice), HasSubstr("is a target twice under the same condition"));
}

TEST(CalibrateCampaign, WithoutFreshRunsNothingIsCalibrated) {
    const Folder folder;
    auto asked = failing_fit(folder, R"(
    print(json.dumps({"observables": {"y": i["a"]}}), flush=True)
)");
    asked["factors"].erase(1);
    asked["calibration"]["checks"] = 2;
    folder.write("c.json", asked.dump());
    EXPECT_THAT(calibrate(folder, "a.db", {"-j", "1"}).out,
                HasSubstr("\nnot checked: 2 of 2 fresh runs have an answer, and 4 are needed"));
    asked["calibration"]["checks"] = 4;
    folder.write("c.json", asked.dump());
    EXPECT_THAT(calibrate(folder, "b.db", {"-j", "1"}).out, HasSubstr("\ncalibrated; all cases"));
}

TEST(CalibrateCampaign, ExcludedPointsAreNoFailuresAndNoDraws) {
    const Folder folder;
    auto asked = failing_fit(folder, R"(
    print(json.dumps({"observables": {"y": (i["a"] + i["b"]) / 2}}), flush=True)
)");
    asked["where"] = "a < b";
    folder.write("c.json", asked.dump());
    const auto ended = calibrate(folder, "a.db", {"-j", "1"});
    EXPECT_EQ(ended.code, 0) << ended.out;
    EXPECT_THAT(ended.out, HasSubstr("settings are excluded by the campaign's `where`: no case was run there"));
    EXPECT_THAT(ended.out, ::testing::Not(HasSubstr("no answer")));
    std::ifstream draws(folder.path() / "fit_posterior.csv");
    std::string line;
    std::getline(draws, line);
    ASSERT_EQ(line.substr(0, 3), "a,b");
    std::size_t count = 0;
    for (double a = 0, b = 0; std::getline(draws, line); ++count) {
        char comma = 0;
        std::istringstream(line) >> a >> comma >> b;
        ASSERT_LT(a, b);
    }
    EXPECT_GT(count, 1000U);
    EXPECT_EQ(calibrate(folder, "a.db", {"-j", "1"}).code, 0) << "again: nothing is left to run";
}

TEST(CalibrateCampaign, RefusesInOneSentence) {
    const Folder folder;
    auto asked = config();
    asked["design"] = {{"kind", "halton"}, {"points", 10}};
    EXPECT_THAT(refusal(folder, asked), HasSubstr("either a \"design\" or a \"calibration\""));
    asked = config();
    asked["calibration"]["targets"][0]["observable"] = "yy";
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.calibration.targets[0].observable"));
    asked = config();
    asked["calibration"]["discrepancy"] = json::object();
    EXPECT_THAT(refusal(folder, asked), HasSubstr("'y' is missing: how far the simulation itself may be"));
    asked = config();
    asked["calibration"]["discrepancy"]["z"] = 1;
    EXPECT_THAT(refusal(folder, asked), HasSubstr("no target measures a value of this observable"));
    asked = config();
    asked["calibration"]["targets"][1]["inputs"]["x3"] = 0.5;
    EXPECT_THAT(refusal(folder, asked), HasSubstr("is a target twice under the same condition"));
    asked = config();
    asked["calibration"]["targets"][1].erase("inputs");
    EXPECT_THAT(refusal(folder, asked), HasSubstr("every target states the same \"inputs\""));
    asked = config();
    asked["calibration"]["targets"][0]["inputs"] = {{"x1", 0.5}};
    EXPECT_THAT(refusal(folder, asked), HasSubstr("is calibrated"));
    asked = config();
    asked["calibration"]["points_per_wave"] = 11;
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.calibration.points_per_wave"));
    asked = config();
    asked["factors"][0] = {{"name", "x1"}, {"levels", {0.5}}};
    EXPECT_THAT(refusal(folder, asked), HasSubstr("has one level"));
    for (const auto& [key, number] :
         {std::pair("value", 1e308), std::pair("value", -1e101), std::pair("error", 1e101)}) {
        asked = config();
        asked["calibration"]["targets"][1][key] = number;
        EXPECT_THAT(refusal(folder, asked), HasSubstr(std::string("$.calibration.targets[1].") + key));
    }
    asked = config();
    asked["calibration"]["discrepancy"]["y"] = 1e200;
    EXPECT_THAT(refusal(folder, asked), HasSubstr("$.calibration.discrepancy.y"));
    asked = config();
    for (int k = 0; k < 300; ++k) {
        asked["calibration"]["targets"].push_back(asked["calibration"]["targets"][0]);
        asked["calibration"]["targets"].back()["inputs"]["x3"] = k / 1000.;
    }
    EXPECT_THAT(refusal(folder, asked), HasSubstr("at most 200 measurements"));
    asked = config();
    asked.erase("calibration");
    asked["design"] = {{"kind", "halton"}, {"points", 10}};
    EXPECT_THAT(refusal(folder, asked), HasSubstr("calibrat"));
}

TEST(CalibrateCampaign, WithoutAnAnswerNothingConvergesAndEveryCommandSaysSo) {
    const Folder folder;
    auto asked = config();
    asked["fixed"]["behaviour"] = "unstable";
    asked["calibration"]["waves"] = 1;
    folder.write("c.json", asked.dump());
    EXPECT_EQ(calibrate(folder, "a.db", {"-j", "2", "--quiet", "--keep-going"}).code, 1);
    const auto said = run_program({"converge", "a.db", "--check"}, folder.path());
    EXPECT_EQ(said.code, 1);
    EXPECT_THAT(said.out, HasSubstr("no case has an answer to it"));
    EXPECT_THAT(said.out, ::testing::Not(HasSubstr("inf standard deviations")));
    const auto window = run_program({"window", "a.db", "--maximize", "y"}, folder.path());
    EXPECT_EQ(window.code, 2) << window.err;
    EXPECT_THAT(window.err, HasSubstr("too few cases, 0 with a value"));
    const auto sensitivity = run_program({"sensitivity", "a.db"}, folder.path());
    EXPECT_EQ(sensitivity.code, 0) << sensitivity.err;
}

TEST(CalibrateCampaign, GivesAWindowWhoseNextCasesRun) {
    const Folder folder;
    auto asked = config();
    asked["calibration"]["waves"] = 1;
    folder.write("c.json", asked.dump());
    ASSERT_EQ(calibrate(folder, "a.db", {"-j", "2", "--quiet"}).code, 0);
    ASSERT_EQ(
        run_program({"window", "a.db", "--maximize", "y", "--next", "2", "--next-file", "n.json"}, folder.path()).code,
        0);
    // Its settings are no sample of the ranges: only the model tells shares of the variance.
    const auto shares = run_program({"sensitivity", "a.db", "--format", "json"}, folder.path());
    const auto first = json::parse(shares.out).at(0).at("factors").at(0).at("first").at("value");
    EXPECT_TRUE(first.is_null()) << first;
    const auto next = run_program({"run", "n.json", "--db", "a.db", "--quiet"}, folder.path());
    EXPECT_EQ(next.code, 0) << next.err;
    const auto after = run_program({"window", "a.db", "--maximize", "y", "--format", "json"}, folder.path());
    EXPECT_EQ(after.code, 0) << "the next cases come into the same model: " << after.err;
}

}  // namespace grainsweep::tests::calibrate_test
