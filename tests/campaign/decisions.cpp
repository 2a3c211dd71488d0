// predict and window on campaigns of known responses: figures within their stated errors, refusals, next cases.
#include "tests/support/process.hpp"
#include "tests/support/spreading_response.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

namespace grainsweep::tests::decisions_test {

using nlohmann::json;

std::string campaign_of(const std::string& response, int factors, int points) {
    json campaign = {{"campaign", "c"}, {"scene", "rehearsal"}, {"seed", 3}};
    campaign["factors"] = json::array();
    for (int j = 1; j <= factors; ++j)
        campaign["factors"].push_back({{"name", "x" + std::to_string(j)}, {"between", {0, 1}}});
    campaign["fixed"] = {{"response", response}, {"noise", 0.02}};
    campaign["design"] = {{"kind", "halton"}, {"sequences", 8}, {"points", points}};
    return campaign.dump();
}

/// A folder with the campaign's database, c.db.
struct Ran : Folder {
    Ran(const std::string& response, int factors, int points) {
        write("c.json", campaign_of(response, factors, points));
        const auto ended = ask({"run", "c.json", "-j", "1", "--quiet"});
        EXPECT_EQ(ended.code, 0) << ended.err;
    }
    [[nodiscard]] Ended ask(const std::vector<std::string>& arguments) const { return run_program(arguments, path()); }
    [[nodiscard]] json answer(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"--format", "json"});
        const auto ended = ask(arguments);
        EXPECT_EQ(ended.code, 0) << ended.err;
        return json::parse(ended.out, nullptr, false);
    }
    [[nodiscard]] std::string refusal(const std::vector<std::string>& arguments) const {
        const auto ended = ask(arguments);
        EXPECT_EQ(ended.code, 2) << ended.out;
        EXPECT_EQ(ended.out, "");
        return ended.err;
    }
};

double ishigami(std::span<const double> u) {
    const auto at = [&](std::size_t j) { return std::numbers::pi * (2 * u[j] - 1); };
    return std::sin(at(0)) + 7 * std::pow(std::sin(at(1)), 2) + 0.1 * std::pow(at(2), 4) * std::sin(at(0));
}

double spreading(std::span<const double> u) {
    return grainsweep::tests::spreading_response(u);
}

/// Share of points of an additive recurrence whose true response lies within 1.96 stated standard errors of the mean.
template <class Truth>
double coverage(const Ran& ran, std::size_t dimensions, const Truth& truth) {
    constexpr std::array steps = {0.8191725134, 0.6710436067, 0.5497004779, 0.4502995221};
    constexpr int points = 200;
    std::string csv;
    for (std::size_t j = 0; j < dimensions; ++j) csv += (j == 0 ? "x" : ",x") + std::to_string(j + 1);
    std::vector<std::vector<double>> asked;
    for (int i = 0; i < points; ++i) {
        auto& u = asked.emplace_back();
        for (std::size_t j = 0; j < dimensions; ++j) {
            u.push_back(std::fmod(0.5 + (i + 1) * steps[j], 1.0));
            csv += (j == 0 ? "\n" : ",") + json(u.back()).dump();
        }
    }
    ran.write("points.csv", csv + "\n");
    const auto said = ran.answer({"predict", "c.db", "--points", "points.csv"});
    EXPECT_EQ(said["points"].size(), asked.size());
    int covered = 0;
    for (std::size_t i = 0; i < asked.size(); ++i) {
        const auto& point = said["points"][i];
        const double error = std::abs(point["mean"].get<double>() - truth(asked[i]));
        covered += error <= 1.96 * point["mean_error"].get<double>() ? 1 : 0;
    }
    return static_cast<double>(covered) / points;
}

TEST(Predict, LiesWithinItsErrorsOnASmoothResponse) {
    const Ran ran("ishigami", 3, 240);
    EXPECT_GE(coverage(ran, 3, ishigami), 0.85);
}

TEST(Predict, LiesWithinItsErrorsBesideACliff) {
    const Ran ran("spreading_a", 4, 240);
    EXPECT_GE(coverage(ran, 4, spreading), 0.85);
}

TEST(Predict, SaysWhatItRestsOnInEveryFormat) {
    const Ran ran("spreading_a", 4, 160);
    const std::vector<std::string> at = {"predict", "c.db", "--at",   "x1=0.5", "--at",
                                         "x2=0.25", "--at", "x3=0.9", "--at",   "x4=0"};
    const auto said = ran.answer(at);
    EXPECT_EQ(said["points"][0]["inputs"]["x3"], 0.9);
    EXPECT_NEAR(said["points"][0]["mean"].get<double>(), spreading(std::array{0.5, 0.25, 0.9, 0.0}), 0.03);
    EXPECT_GT(said["points"][0]["scatter"].get<double>(), 0);
    EXPECT_EQ(said["model"]["cases"], 160);
    EXPECT_LT(said["model"]["leave_one_out_error"].get<double>(), 0.4);
    const auto text = ran.ask(at).out;
    for (const char* part : {"leave-one-out error", "50 % interval", "95 % interval", "scatter", "160 cases"})
        EXPECT_NE(text.find(part), std::string::npos) << text;
    auto csv = at;
    csv.insert(csv.end(), {"--format", "csv"});
    EXPECT_TRUE(ran.ask(csv).out.starts_with("x1,x2,x3,x4,mean,mean_error,scatter,inside\n0.5,0.25,0.9,0"));
    EXPECT_EQ(ran.ask(at).out, text) << "the same again";
    auto percent = at;
    *std::ranges::find(percent, "x2=0.25") = "x2=25 %";
    EXPECT_EQ(ran.ask(percent).out, text) << "a quantity is a number";
}

TEST(Predict, RefusesInOneSentence) {
    const Ran ran("spreading_a", 4, 60);
    const std::vector<std::string> inside = {"predict", "c.db", "--at", "x1=0.5", "--at", "x2=0.2", "--at", "x4=0"};
    const auto with = [&](const std::vector<std::string>& more) {
        auto all = inside;
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    EXPECT_NE(ran.refusal(inside).find("x3 is missing"), std::string::npos);
    EXPECT_NE(ran.refusal(with({"--at", "x3=1.5"})).find("x3 = 1.5 is outside of 0 to 1"), std::string::npos);
    EXPECT_EQ(ran.ask(with({"--at", "x3=1.5", "--extrapolate"})).code, 0);
    EXPECT_NE(ran.refusal(with({"--at", "x33=1"})).find("Did you mean 'x3'"), std::string::npos);
    EXPECT_NE(ran.refusal(with({"--at", "x3=high"})).find("x3 takes a number"), std::string::npos);
    EXPECT_NE(ran.refusal(with({"--at", "x1=1"})).find("given twice"), std::string::npos);
    EXPECT_NE(ran.refusal({"predict", "c.db"}).find("--points"), std::string::npos);
    EXPECT_NE(ran.refusal({"predict", "c.db", "--points", "no.csv"}).find("no such file"), std::string::npos);
    ran.write("short.csv", "x1,x2\n0,1\n");
    EXPECT_NE(ran.refusal({"predict", "c.db", "--points", "short.csv"}).find("x3, x4 are missing"), std::string::npos);
    EXPECT_NE(ran.refusal(with({"--at", "x3=1", "--observable", "z"})).find("'z'"), std::string::npos);
}

TEST(Window, FindsTheShareTheBestSettingAndWhatToRunNext) {
    const Ran ran("spreading_a", 4, 240);
    const std::vector<std::string> ask = {"window",      "c.db",     "--where", "y <= 0.4 and x3 <= 0.8",
                                          "--maximize",  "y",        "--next",  "4",
                                          "--next-file", "next.json"};
    const auto found = ran.answer(ask);
    // The true share, on a grid of cell centres.
    constexpr int cells = 24;
    int inside = 0;
    std::array<double, 4> u{};
    for (int k = 0; k < cells * cells * cells * cells; ++k) {
        int rest = k;
        for (double& x : u) {
            x = (rest % cells + 0.5) / cells;
            rest /= cells;
        }
        inside += spreading(u) <= 0.4 && u[2] <= 0.8 ? 1 : 0;
    }
    const double share = inside / std::pow(cells, 4);
    EXPECT_LE(found["share_of_box"].get<double>(), share + 0.01) << "less than what is true: sure at 95 % only";
    EXPECT_NEAR(found["share_of_box"].get<double>(), share, 0.12);
    const auto& best = found["best"];
    for (std::size_t j = 0; j < 4; ++j) u[j] = best["inputs"]["x" + std::to_string(j + 1)];
    EXPECT_GE(best["probability"].get<double>(), 0.95);
    EXPECT_LE(spreading(u), 0.4) << "the condition is met by the true response";
    EXPECT_GT(spreading(u), 0.36) << "nearly as good as can be";
    EXPECT_LE(u[2], 0.8);
    EXPECT_NEAR(best["mean"].get<double>(), spreading(u), 3 * best["mean_error"].get<double>());

    EXPECT_EQ(found["next"].size(), 4U);
    const auto ended = ran.ask({"run", "next.json", "--db", "c.db", "-j", "1", "--quiet"});
    EXPECT_EQ(ended.code, 0) << ended.err;
    const auto after = ran.answer({"window", "c.db", "--campaign", "c", "--where", "y <= 0.4"});
    EXPECT_EQ(after["models"][0]["cases"], 244) << "they come into the same model";
}

TEST(Window, RunsBatchesUntilTheBestSettingIsKnownAndGoesOnWhereItStopped) {
    const Ran ran("spreading_a", 4, 100);
    const auto run = [&](const std::string& most, const std::string& width) {
        const auto ended =
            ran.ask({"window", "c.db", "--campaign", "c", "--where", "y <= 0.4", "--maximize", "y", "--run", "--next",
                     "6", "--max-cases", most, "--width", width, "-j", "1", "--format", "json"});
        return std::pair{ended.code, json::parse(ended.out, nullptr, false)};
    };
    const auto count = [&](const std::string& of) {
        const auto ended = ran.ask({"query", "c.db", "SELECT count(*) AS n FROM " + of, "--format", "json"});
        return json::parse(ended.out, nullptr, false)[0]["n"];
    };
    const auto [code, first] = run("4", "1e-9");
    EXPECT_EQ(code, 1) << "the width is not reached";
    EXPECT_EQ(first["run"]["cases"], 4);
    EXPECT_EQ(first["run"]["reached"], false);
    EXPECT_EQ(first["models"][0]["cases"], 104);
    EXPECT_EQ(count("c_next"), 4) << "only so many were promised";
    const auto [again, second] = run("12", "1e-9");
    EXPECT_EQ(again, 1);
    EXPECT_EQ(second["run"]["cases"], 12);
    EXPECT_EQ(second["models"][0]["cases"], 116);
    EXPECT_EQ(count("campaign"), 4) << "c and three batches";
    const double width = 1.05 * 2.5 * second["best"]["mean_error"].get<double>();
    const auto [reached, third] = run("12", json(width).dump());
    EXPECT_EQ(reached, 0);
    EXPECT_EQ(third["run"]["cases"], 0);
    EXPECT_EQ(third["run"]["reached"], true);
    EXPECT_FALSE(std::filesystem::exists(ran / "c_next.json")) << "the batch's file is gone";
}

TEST(Window, OfTwoObjectivesRunsUntilItsFrontIsKnown) {
    const Folder folder;
    folder.write("f.py", R"(import json, sys
for line in sys.stdin:
    x, y = (json.loads(line)["inputs"][name] for name in ("x", "y"))
    print(json.dumps({"observables": {"a": x**2 + y**2, "b": (x - 1)**2 + (y - 1)**2}}), flush=True)
)");
    folder.write("c.json", R"({"campaign": "c", "scene": "program",
      "program": {"command": ["python3", "f.py"], "files": ["f.py"], "protocol": "lines",
                  "observables": {"a": {"unit": "m"}, "b": {"unit": "1"}}},
      "factors": [{"name": "x", "between": [-1, 2]}, {"name": "y", "between": [-1, 2]}],
      "design": {"kind": "halton", "points": 16}})");
    ASSERT_EQ(run_program({"run", "c.json", "-j", "1", "--quiet"}, folder.path()).code, 0);
    const auto run = [&](const std::string& tolerance, const std::string& most) {
        const auto ended = run_program(
            {"window",      "c.db",        "--campaign",  "c",   "--minimize", "a",           "--minimize", "b",
             "--reference", "a=2000 mm",   "--reference", "b=2", "--run",      "--tolerance", tolerance,    "--next",
             "4",           "--max-cases", most,          "-j",  "1",          "--format",    "json"},
            folder.path());
        return std::pair{ended.code, json::parse(ended.out, nullptr, false)};
    };
    // The true front: x = y in [0, 1], b = (sqrt(2) - sqrt(a))^2; it dominates 2 * 2 - 2/3.
    constexpr double truth = 4 - 2.0 / 3;
    const auto [code, first] = run("1e-6", "4");
    EXPECT_EQ(code, 1) << "not reached";
    EXPECT_EQ(first["run"]["cases"], 4);
    EXPECT_EQ(first["objectives"][0]["reference"], 2);
    const auto [again, second] = run("0.02", "60");
    EXPECT_EQ(again, 0) << second.dump();
    EXPECT_EQ(second["run"]["reached"], true);
    EXPECT_LE(second["run"]["cases"], 40);
    EXPECT_EQ(second["batches"].size(), 2 + second["run"]["batches"].get<std::size_t>());
    const auto& volume = second["hypervolume"];
    EXPECT_LE(volume["further"].get<double>(), 0.02 * volume["value"].get<double>());
    EXPECT_GE(volume["value"].get<double>(), 0.98 * truth);
    EXPECT_LE(volume["value"].get<double>() - volume["error"].get<double>(), truth);
    for (std::size_t k = 1; k < second["batches"].size(); ++k)
        EXPECT_GE(second["batches"][k]["hypervolume"], second["batches"][k - 1]["hypervolume"]);
}

TEST(Window, ABatchThatWasInterruptedIsFinishedFirst) {
    const Ran ran("spreading_a", 4, 100);
    (void)ran.answer({"window", "c.db", "--maximize", "y", "--next", "5", "--next-file", "next.json"});
    EXPECT_EQ(ran.ask({"run", "next.json", "--db", "c.db", "-j", "1", "--max-cases", "2", "--quiet"}).code, 1);
    const auto ended = ran.ask({"window", "c.db", "--campaign", "c", "--maximize", "y", "--run", "--max-cases", "3",
                                "--width", "1e-9", "-j", "1", "--format", "json"});
    EXPECT_EQ(ended.code, 1) << ended.err;
    const auto found = json::parse(ended.out, nullptr, false);
    EXPECT_EQ(found["run"]["batches"], 1) << "the one that was begun";
    EXPECT_EQ(found["models"][0]["cases"], 105);
}

TEST(Window, LeavesOtherCampaignsAlone) {
    const Ran ran("spreading_a", 2, 40);
    auto other = json::parse(campaign_of("spreading_a", 2, 40));
    other.merge_patch({{"campaign", "c_next_week"}, {"seed", 4}});
    ran.write("other.json", other.dump());
    EXPECT_EQ(ran.ask({"run", "other.json", "--db", "c.db", "-j", "1", "--max-cases", "2", "--quiet"}).code, 1);
    const auto ended = ran.ask({"window", "c.db", "--campaign", "c", "--maximize", "y", "--run", "--max-cases", "3",
                                "--width", "1e-9", "-j", "1"});
    EXPECT_EQ(ended.code, 1) << ended.err;
    const auto counts = ran.answer({"query", "c.db",
                                    "SELECT count(y) AS other, (SELECT count(y) FROM c_next) AS next "
                                    "FROM c_next_week"});
    EXPECT_EQ(counts[0]["other"], 2) << "no batch of the window";
    EXPECT_EQ(counts[0]["next"], 3);
}

TEST(Window, SharesAreOfWhatTheConditionOfTheCampaignLeaves) {
    const Folder folder;
    auto half = json::parse(campaign_of("sum", 2, 80));
    half["where"] = "x1 < 0.5";
    folder.write("c.json", half.dump());
    ASSERT_EQ(run_program({"run", "c.json", "-j", "1", "--quiet"}, folder.path()).code, 0);
    const auto found = run_program({"window", "c.db", "--where", "x2 >= 0.5", "--wide"}, folder.path());
    EXPECT_NE(found.out.find("in 50.0 +- "), std::string::npos) << found.out;
    EXPECT_NE(found.out.find("% of the part that `where` leaves of the box"), std::string::npos) << found.out;
}

TEST(Window, SaysWhereNothingMeetsTheCondition) {
    const Ran ran("spreading_a", 4, 120);
    const auto found = ran.answer({"window", "c.db", "--where", "y > 5", "--maximize", "y"});
    EXPECT_TRUE(found["best"].is_null());
    EXPECT_EQ(found["share_of_box"], 0);
    EXPECT_FALSE(found["surest"].is_null());
    EXPECT_NE(found["notes"][0].get<std::string>().find("holds nowhere"), std::string::npos);
}

TEST(Predict, RefusesACampaignWithoutAnAnswer) {
    Ran ran("spreading_a", 2, 16);
    auto failing = json::parse(campaign_of("spreading_a", 2, 16));
    failing["fixed"]["behaviour"] = "unstable";
    ran.write("f.json", failing.dump());
    EXPECT_EQ(ran.ask({"run", "f.json", "--db", "f.db", "--quiet"}).code, 1);
    EXPECT_NE(ran.refusal({"predict", "f.db", "--at", "x1=0.5", "--at", "x2=0.5"}).find("too few cases"),
              std::string::npos);
    EXPECT_NE(ran.refusal({"window", "f.db", "--maximize", "y"}).find("'y': no response model: too few cases"),
              std::string::npos);
}

TEST(Predict, AnswersTheFirstObservableOfTheFileBeforeItsFactors) {
    const Folder folder;
    folder.write("f.py", R"(import json, sys
for line in sys.stdin:
    x = json.loads(line)["inputs"]["x"]
    print(json.dumps({"observables": {"yield": 2 + x, "ash": 1 - x}}), flush=True)
)");
    folder.write("c.json", R"({"campaign": "c", "scene": "program",
      "program": {"command": ["python3", "f.py"], "files": ["f.py"], "protocol": "lines",
                  "observables": {"yield": {"unit": "1"}, "ash": {"unit": "1"}}},
      "factors": [{"name": "x", "between": [0, 1]}], "design": {"kind": "halton", "points": 16}})");
    ASSERT_EQ(run_program({"run", "c.json", "-j", "1", "--quiet"}, folder.path()).code, 0);
    const auto said = run_program({"predict", "c.db", "--at", "x=0.25"}, folder.path());
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(said.out.substr(0, 9), "c: yield\n") << said.out;
    EXPECT_LT(said.out.find("mean"), said.out.find(" x\n"));
}

TEST(Window, LeavesOutOnlyOutcomesOfFailedCases) {
    const Ran ran("spreading_a", 2, 40);
    const auto said =
        ran.ask({"window", "c.db", "--maximize", "y", "--leave-out", "unstable", "--leave-out", "crashed"});
    EXPECT_EQ(said.code, 0) << said.err;
    EXPECT_EQ(ran.ask({"predict", "c.db", "--at", "x1=0.5", "--at", "x2=0.5", "--leave-out", "timed_out"}).code, 0);
    for (const char* word : {"completed", "failed", "abandoned"})
        EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "y", "--leave-out", word})
                      .find("must be an outcome of failed cases: unstable, rejected, crashed, timed_out"),
                  std::string::npos);
}

TEST(Window, RefusesInOneSentence) {
    const Ran ran("spreading_a", 4, 60);
    EXPECT_NE(ran.refusal({"window", "c.db"}).find("--where"), std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--where", "y * 2 > 1"}).find("is expected at '* 2 > 1'"),
              std::string::npos);
    const auto refused_pair = [&](std::vector<std::string> more, const char* sentence) {
        more.insert(more.begin(), {"window", "c.db", "--maximize", "y"});
        EXPECT_NE(ran.refusal(more).find(sentence), std::string::npos) << ran.refusal(more);
    };
    refused_pair({"--minimize", "y"}, "is named twice");
    refused_pair({"--minimize", "x1", "--minimize", "x2"}, "at most two objectives");
    refused_pair({"--minimize", "x1", "--run"}, "needs --tolerance");
    refused_pair({"--minimize", "x1", "--run", "--width", "1"}, "--width: is for one objective; here --tolerance");
    refused_pair({"--minimize", "x1", "--run", "--tolerance", "-1"}, "must be a positive number");
    refused_pair({"--run", "--tolerance", "0.1"}, "--tolerance: is for two objectives; here --width");
    refused_pair({"--reference", "y=1"}, "is for two objectives");
    refused_pair({"--minimize", "x1", "--reference", "x2=1"}, "is neither of the two objectives");
    refused_pair({"--minimize", "x1", "--reference", "y"}, "must be NAME=VALUE");
    refused_pair({"--minimize", "x1", "--reference", "y=low"}, "'low'");
    refused_pair({"--minimize", "x1", "--reference", "y=1", "--reference", "y=2"}, "given twice");
    refused_pair({"--minimize", "x1", "--reference", "y=1e999"}, "'1e999'");
    EXPECT_NE(ran.refusal({"window", "c.db", "--where", "y > 1", "--run"}).find("needs --maximize"), std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "y", "--run"}).find("needs --width"), std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "y", "--width", "1"}).find("needs --run"),
              std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "y", "--next-file", "n.json"}).find("--next N"),
              std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "y", "--run", "--width", "1e-9", "--max-cases", "2",
                           "--next", "2", "--next-file", "n.json"})
                  .find("--run runs the next cases itself"),
              std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "y", "--run", "--width", "inf"}).find("a positive number"),
              std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "x22"})
                  .find("neither observable nor factor of the campaign. Did you mean 'x2'?"),
              std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "x1"}).find("is a factor: it needs a condition"),
              std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--where", "y > 0.1", "--maximize", "x1", "--run", "--width", "0.1"})
                  .find("got x1; is a factor, whose value is chosen"),
              std::string::npos);
    std::string many = "y > 0.1";
    for (int k = 0; k < 9000; ++k) many += " and y > 0.1";
    const auto refused = ran.refusal({"window", "c.db", "--where", many});
    EXPECT_NE(refused.find("no more than 100 comparisons"), std::string::npos);
    EXPECT_LT(refused.size(), 1000u);
    EXPECT_EQ(ran.refusal({"window", "c.db", "--where", "\x1b[2J > 1"}).find('\x1b'), std::string::npos);
    EXPECT_NE(ran.refusal({"window", "c.db", "--maximize", "y", "--next", "2", "--next-file", "c.json"}).find("c.json"),
              std::string::npos);
}

}  // namespace grainsweep::tests::decisions_test
