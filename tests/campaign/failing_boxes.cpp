// Failing cases, probabilities and noise factors through the real program; slow_answers has more boxes and runs.
#include "tests/support/failing_boxes.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::failing_boxes_test {

using nlohmann::json;

TEST(FailingBoxes, AWindowKeepsItsPromiseBesideAFailingCorner) {
    for (const int box : {0, 3}) {
        const auto kept = kept_promise(box, 60, 100);
        EXPECT_GT(kept.failed, 5) << box;
        EXPECT_EQ(kept.runs, 100);
        EXPECT_GE(kept.promised, 0.95) << box;
        EXPECT_GE(kept.held, 90) << box;
    }
}

/// y = x + 0.5 powder for powder 0 or 1 of two words, jammed with a probability that grows with x.
struct Noisy : Folder {
    Noisy() {
        write("script.py", R"(import json, random, sys
for line in sys.stdin:
    q = json.loads(line)
    i = q['inputs']
    r = random.Random(q['seed'])
    coarse = 0 if i['powder'] == 'fine' else 1
    y = i['x'] + 0.5 * coarse * (1 - i['x']) + 0.2 * i['moisture'] + r.gauss(0, 0.01)
    print(json.dumps({'observables': {'y': y, 'jammed': 1 if r.random() < i['x'] ** 2 else 0}}))
    sys.stdout.flush()
)");
        const json campaign = {{"campaign", "c"},
                               {"scene", "program"},
                               {"program",
                                {{"command", {"python3", "script.py"}},
                                 {"files", {"script.py"}},
                                 {"protocol", "lines"},
                                 {"observables", {{"y", {{"unit", "1"}}}, {"jammed", {{"unit", "1"}}}}}}},
                               {"factors",
                                {{{"name", "x"}, {"between", {0, 1}}},
                                 {{"name", "powder"}, {"levels", {"fine", "coarse"}}, {"role", "noise"}},
                                 {{"name", "moisture"}, {"between", {0, 1}}, {"role", "noise"}}}},
                               {"design", {{"kind", "halton"}, {"points", 160}}}};
        write("c.json", campaign.dump());
        EXPECT_EQ(ask({"run", "c.json", "-j", "1", "--quiet"}).code, 0);
    }
    [[nodiscard]] Ended ask(const std::vector<std::string>& arguments) const { return run_program(arguments, path()); }
    [[nodiscard]] json answer(std::vector<std::string> arguments) const {
        arguments.insert(arguments.end(), {"--format", "json"});
        const auto ended = ask(arguments);
        EXPECT_EQ(ended.code, 0) << ended.err;
        return json::parse(ended.out, nullptr, false);
    }
    /// The least x whose window holds.
    [[nodiscard]] double least_x(const std::string& where, const std::vector<std::string>& more = {}) const {
        std::vector<std::string> all = {"window", "c.db", "--where", where, "--minimize", "x"};
        all.insert(all.end(), more.begin(), more.end());
        const auto found = answer(all);
        return found["best"].is_null() ? 2 : found["best"]["inputs"]["x"].get<double>();
    }
};

TEST(NoiseFactors, AreAveragedOverHeldOrMetAtEveryLevel) {
    const Noisy noisy;
    // y >= 0.5 with fine powder: x >= 0.5 - 0.2 moisture; with coarse powder everywhere.
    EXPECT_NEAR(noisy.least_x("y >= 0.5", {"--risk", "0.3"}), 0.38, 0.03) << "2 of 5 of fine, all of coarse";
    EXPECT_NEAR(noisy.least_x("y >= 0.5 for all powder", {"--risk", "0.3"}), 0.44, 0.03) << "7 of 10 of fine";
    EXPECT_NEAR(noisy.least_x("y >= 0.5", {"--risk", "0.3", "--hold", "powder=coarse"}), 0, 0.03);
    EXPECT_NEAR(noisy.least_x("y >= 0.5", {"--hold", "powder=fine", "--hold", "moisture=0.5"}), 0.4, 0.02);
    const auto found = noisy.answer({"window", "c.db", "--where", "y >= 0.5", "--maximize", "y", "--next", "2"});
    EXPECT_TRUE(found["best"]["inputs"]["powder"].is_null()) << "it cannot be set";
    EXPECT_TRUE(found["next"][0]["inputs"]["powder"].is_string()) << "a case needs one";
    EXPECT_GT(found["best"]["scatter"].get<double>(), 0.05) << "that of the moisture is in it";
    const auto page = noisy.ask({"window", "c.db", "--where", "y >= 0.5", "-o", "w.html"});
    EXPECT_EQ(page.code, 0) << page.err;
    EXPECT_NE(page.out.find("powder, moisture cannot be set"), std::string::npos) << page.out;
}

TEST(NoiseFactors, HaveAShareOfTheVarianceThatAControlReduces) {
    const Noisy noisy;
    const auto said = noisy.answer({"sensitivity", "c.db", "--observable", "y"});
    const auto& noise = said[0]["model"]["noise"];
    EXPECT_EQ(noise["factors"], json({"powder", "moisture"}));
    EXPECT_GT(noise["value"].get<double>(), 0.2);
    EXPECT_EQ(noise["controls"][0]["name"], "x");
    EXPECT_LT(noise["controls"][0]["value"].get<double>(), 0.5 * noise["value"].get<double>());
    EXPECT_NE(noisy.ask({"sensitivity", "c.db", "--observable", "y"}).out.find("noise (powder, moisture) makes"),
              std::string::npos);
}

TEST(NoiseFactors, AreRefusedInOneSentence) {
    const Noisy noisy;
    const auto refusal = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"window", "c.db"});
        const auto ended = noisy.ask(more);
        EXPECT_EQ(ended.code, 2) << ended.out;
        return ended.err;
    };
    EXPECT_NE(refusal({"--where", "y > 0 for all powdr"}).find("Did you mean 'powder'"), std::string::npos);
    EXPECT_NE(refusal({"--where", "y > 0 for all moisture"}).find("needs a factor with \"levels\""), std::string::npos);
    EXPECT_NE(refusal({"--where", "y > 0 for all"}).find("stands at the end"), std::string::npos);
    EXPECT_NE(refusal({"--where", "y > 0", "--hold", "x=1.5"}).find("--hold x"), std::string::npos);
    EXPECT_NE(refusal({"--where", "y > 0", "--hold", "x=1"}).find("no factor is left"), std::string::npos);
    EXPECT_NE(refusal({"--where", "y > 0", "--maximize", "moisture"}).find("is not searched"), std::string::npos);
}

TEST(Probabilities, HaveAModelOfTheirOwn) {
    const Noisy noisy;
    const auto at = [](const std::string& x) {
        return std::vector<std::string>{"predict", "c.db", "--observable", "jammed", "--at",
                                        "x=" + x,  "--at", "powder=fine",  "--at",   "moisture=0.5"};
    };
    const auto low = noisy.answer(at("0.3"))["points"][0], high = noisy.answer(at("0.9"))["points"][0];
    EXPECT_LT(low["mean"].get<double>(), 0.3);
    EXPECT_GT(high["mean"].get<double>(), 0.6);
    for (const auto& [point, truth] : {std::pair{low, 0.09}, {high, 0.81}}) {
        EXPECT_LT(point["mean_low"].get<double>(), truth);
        EXPECT_GT(point["mean_high"].get<double>(), truth);
        EXPECT_GE(point["mean_low"].get<double>(), 0);
        EXPECT_LE(point["mean_high"].get<double>(), 1);
    }
    EXPECT_EQ(noisy.answer(at("0.5"))["model"]["kind"], "probability");
    EXPECT_NE(noisy.ask(at("0.5")).out.find("the probability of a 1"), std::string::npos);
    const auto found = noisy.answer({"window", "c.db", "--where", "jammed <= 0.3", "--maximize", "x"});
    ASSERT_FALSE(found["best"].is_null());
    EXPECT_NEAR(found["best"]["inputs"]["x"].get<double>(), 0.4, 0.2) << "x^2 <= 0.3 up to 0.55";
    EXPECT_LT(found["best"]["inputs"]["x"].get<double>(), 0.55);
}

// The scene refuses an edge rounder than half the blade before anything runs: no model guesses at that border.
TEST(FailingBoxes, ABorderThatTheSceneStatesIsExact) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "c", "scene": "powder_spreading",
        "factors": [{"name": "blade_edge_radius", "between": [0.0002, 0.0018]}],
        "fixed": {"diameter": 0.003, "gap": 0.006, "width": 5, "settle_time": 0.02, "time_step_fraction": 0.4,
                  "blade_thickness": 0.002},
        "design": {"kind": "halton", "points": 24}})");
    const auto ran = run_program({"run", "c.json", "-j", "1", "--quiet"}, folder.path());
    EXPECT_EQ(ran.code, 1) << ran.err;
    const auto found = run_program({"window", "c.db", "--where", "blade_edge_radius >= 0.0003", "--maximize",
                                    "blade_edge_radius", "--format", "json"},
                                   folder.path());
    ASSERT_EQ(found.code, 0) << found.err;
    const auto window = json::parse(found.out);
    EXPECT_NEAR(window["best"]["inputs"]["blade_edge_radius"].get<double>(), 0.001, 2e-6);
    EXPECT_EQ(window["best"]["answers"], 1);
    EXPECT_NEAR(window["share_failed"].get<double>(), 0.5, 1e-3);
}

}  // namespace grainsweep::tests::failing_boxes_test
