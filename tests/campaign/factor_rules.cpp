// Steps, conditions, groups and shares through the real program: plan, run, extend, predict, window, report.
#include "tests/support/commands.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace grainsweep::tests::factor_rules_test {

using nlohmann::json;
using testing::HasSubstr;

struct FactorRules : CommandsInAFolder {
    std::string run(const json& campaign) const {
        folder.write("c.json", campaign.dump());
        return out({"run", "c.json", "--quiet"});
    }
    std::string query(const std::string& sql) const { return out({"query", "c.db", sql, "--format", "csv"}); }
};

json conditional(int points) {
    return json{{"campaign", "c"},
                {"scene", "rehearsal"},
                {"factors", json::parse(R"([{"name": "response", "levels": ["sum", "ishigami"]},
                     {"name": "x2", "between": [0, "100 %"], "step": "5 %"},
                     {"name": "x1", "between": [0.6, 1], "when": "response = 'ishigami'"}])")},
                {"design", {{"kind", "halton"}, {"points", points}, {"sequences", 4}}}};
}

TEST_F(FactorRules, FoldPointsToOneRunAndExtend) {
    folder.write("c.json", conditional(120).dump());
    const auto plan = json::parse(out({"plan", "c.json", "--format", "json"}));
    EXPECT_EQ(plan["cases"], 120);
    const int different = plan["questions"];
    EXPECT_LE(different, 81);  // 60 of ishigami, at most 21 of the sum
    EXPECT_EQ(plan["factors"][1]["rules"], "multiples of 0.05");
    EXPECT_EQ(plan["factors"][2]["rules"], "when response = 'ishigami'");
    EXPECT_THAT(out({"plan", "c.json"}), HasSubstr(std::to_string(different) + " different"));
    out({"run", "c.json", "--quiet"});
    EXPECT_EQ(query("SELECT count(DISTINCT case_id) FROM c"),
              "count(DISTINCT case_id)\n" + std::to_string(different) + "\n");
    EXPECT_EQ(query("SELECT count(*) FROM c WHERE response = 'sum' AND x1 <> 0.5"), "count(*)\n0\n");
    EXPECT_EQ(query("SELECT count(*) FROM c WHERE abs(20*x2 - round(20*x2)) > 1e-9"), "count(*)\n0\n");
    const auto before = query("SELECT point, case_id FROM c WHERE point < 120 ORDER BY point");
    run(conditional(200));
    EXPECT_EQ(query("SELECT point, case_id FROM c WHERE point < 120 ORDER BY point"), before);
    EXPECT_EQ(query("SELECT max(attempts) FROM c"), "max(attempts)\n1\n");
    EXPECT_EQ(query("SELECT count(*) FROM c"), "count(*)\n200\n");
    auto other = conditional(200);
    other["factors"][2]["when"] = "response = 'sum'";
    folder.write("c.json", other.dump());
    const auto refused = ask({"run", "c.json", "--quiet"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("when x1 response = 'sum'"));
}

TEST_F(FactorRules, ArePredictedAndReported) {
    run(conditional(160));
    const auto predicted = [&](const std::vector<std::string>& at) {
        std::vector<std::string> arguments = {"predict", "c.db", "--format", "json"};
        for (const auto& one : at) arguments.insert(arguments.end(), {"--at", one});
        return json::parse(out(arguments))["points"][0];
    };
    const auto without = predicted({"response=sum", "x2=0.4"});
    EXPECT_EQ(without["inputs"]["x1"], 0.5);
    EXPECT_EQ(without, predicted({"response=sum", "x2=0.4", "x1=0.9"}));
    EXPECT_EQ(ask({"predict", "c.db", "--at", "response=ishigami", "--at", "x2=0.4"}).code, 2);
    const auto window = json::parse(
        out({"window", "c.db", "--maximize", "y", "--next", "4", "--next-file", "next.json", "--format", "json"}));
    for (const auto& next : window["next"]) {
        const double x2 = next["inputs"]["x2"];
        EXPECT_NEAR(20 * x2, std::round(20 * x2), 1e-9);
        if (next["inputs"]["response"] == "sum") {
            EXPECT_EQ(next["inputs"]["x1"], 0.5);
        }
    }
    out({"run", "next.json", "--db", "c.db", "--quiet"});
    EXPECT_THAT(out({"predict", "c.db", "--campaign", "c", "--at", "response=sum", "--at", "x2=0.4"}),
                HasSubstr("_next"));
    out({"report", "c.db", "-o", "c.html"});
    EXPECT_TRUE(std::filesystem::exists(folder / "c.html"));
    EXPECT_EQ(json::parse(out({"converge", "c.db", "--campaign", "c", "--format", "json"}))[0]["points"], 160);
}

TEST_F(FactorRules, OfSharesAddToOneInEveryCase) {
    const json campaign = json::parse(R"({"campaign": "c", "scene": "rehearsal", "factors": [
        {"name": "x1", "between": ["10 %", 1]}, {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]}],
        "simplex": ["x1", "x2", "x3"], "fixed": {"response": "ishigami"}, "where": "x2 <= 0.8", "design": {"kind": "sobol", "points": 96}})");
    run(campaign);
    EXPECT_EQ(query("SELECT count(*) FROM c WHERE abs(x1 + x2 + x3 - 1) > 1e-12 OR x1 < 0.1"), "count(*)\n0\n");
    const auto off = ask({"predict", "c.db", "--at", "x1=0.3", "--at", "x2=0.3", "--at", "x3=0.3"});
    EXPECT_EQ(off.code, 2);
    EXPECT_THAT(off.err, HasSubstr("the shares add to 0.9"));
    const auto found =
        json::parse(out({"predict", "c.db", "--at", "x1=0.3", "--at", "x2=0.3", "--at", "x3=0.4", "--format", "json"}));
    EXPECT_EQ(found["points"][0]["inside"], true);
    const auto best = json::parse(out({"window", "c.db", "--maximize", "x2", "--where", "y > 0", "--format", "json"}));
    const auto& inputs = best["best"]["inputs"];
    EXPECT_NEAR(double(inputs["x1"]) + double(inputs["x2"]) + double(inputs["x3"]), 1, 1e-9);
    EXPECT_LE(double(inputs["x2"]), 0.8);
    const auto solved = json::parse(out({"solve", "c.json", "--format", "json"}));
    EXPECT_NEAR(solved["inputs"]["x1"], 0.4, 1e-12);
    EXPECT_NEAR(solved["inputs"]["x3"], 0.3, 1e-12);
    const auto half = ask({"solve", "c.json", "--set", "x1=0.5"});
    EXPECT_EQ(half.code, 2);
    EXPECT_THAT(half.err, HasSubstr("x1, x2, x3 add to one: set all of them or none"));
}

TEST_F(FactorRules, OfGroupsHaveOneIndexEach) {
    run(json::parse(R"({"campaign": "c", "scene": "rehearsal", "fixed": {"response": "g_function"}, "factors": [
        {"name": "x1", "between": [0, 1], "group": "outer"}, {"name": "x2", "between": [0, 1]},
        {"name": "x3", "between": [0, 1], "group": "outer"}], "design": {"kind": "saltelli", "base_points": 256}})"));
    EXPECT_EQ(query("SELECT count(*) FROM c"), "count(*)\n1024\n");
    const auto said = json::parse(out({"sensitivity", "c.db", "--format", "json"}))[0];
    ASSERT_EQ(said["factors"].size(), 2U);
    EXPECT_EQ(said["factors"][0]["name"], "outer");
    EXPECT_EQ(said["factors"][0]["members"], (json{"x1", "x3"}));
    EXPECT_GT(said["factors"][0]["total"]["value"], 0.7);
    out({"report", "c.db", "-o", "c.html"});
}

}  // namespace grainsweep::tests::factor_rules_test
