// A sound campaign file is read as it was meant.
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/reader.hpp"

#include <gtest/gtest.h>

namespace grainsweep::tests::campaign_reads_test {

using namespace campaign;

TEST(CampaignFile, IsReadAsItWasMeant) {
    const std::string text = R"({
      "notes": ["one", "two"],
      "campaign": "full_1", "scene": "rehearsal",
      "factors": [{"name": "x2", "between": [0.001, 0.1], "scale": "log"}, {"name": "x1", "between": [0, 1]},
                  {"name": "response", "levels": ["sum", "ishigami"]}],
      "fixed": {"notes": "kept apart", "noise": 0.1, "behave_attempts": 2, "behaviour": "crash"},
      "where": "x1 > x2",
      "design": {"kind": "halton", "sequences": 8, "points": 1e3},
      "replicates": 2, "seed": 9007199254740993,
      "convergence": {"observable": "y", "rule": "all_change", "gates": ["mean", "skewness"], "tolerance": 0.05,
                      "block": 100, "stop": false},
      "limits": {"wall_seconds": 60, "attempts": 5},
      "execution": {"workers": 3, "launcher": ["srun", "-n1"]}
    })";
    const Campaign campaign = parse_campaign(text, ".");
    EXPECT_EQ(campaign.name, "full_1");
    EXPECT_EQ(campaign.scene().name, "rehearsal");
    EXPECT_EQ(campaign.text, text);
    EXPECT_EQ(campaign.where, "x1 > x2");
    EXPECT_EQ(campaign.replicates, 2);
    EXPECT_EQ(campaign.seed, 9007199254740993U);  // beyond 2^53: read as the whole number it is
    const std::vector<Factor> factors = {{.name = "x2", .range = Between{0.001, 0.1, Scale::log}, .unit = "1"},
                                         {.name = "x1", .range = Between{0, 1, Scale::linear}, .unit = "1"},
                                         {"response", Levels{{std::string("sum"), std::string("ishigami")}}}};
    EXPECT_EQ(campaign.space.factors, factors);
    EXPECT_EQ(campaign.space.fixed,
              (Inputs{{"noise", 0.1}, {"behave_attempts", std::int64_t{2}}, {"behaviour", std::string("crash")}}));
    EXPECT_EQ(campaign.design, "halton");
    EXPECT_EQ(campaign.request.levels, (std::vector<std::size_t>{0, 0, 2}));
    EXPECT_EQ(campaign.request.seed, campaign.seed);
    EXPECT_EQ(campaign.request.count("points"), 1000);
    EXPECT_EQ(campaign.request.count("first"), 1);
    EXPECT_EQ(campaign.request.word("scramble"), "random");
    EXPECT_EQ(*campaign.convergence, (Convergence{"y", "all_change", {"mean", "skewness"}, 0.05, 100, false}));
    EXPECT_EQ(campaign.limits.wall_seconds, 60);
    EXPECT_EQ(campaign.limits.attempts, 5);
    EXPECT_EQ(campaign.execution.workers, 3);
    EXPECT_EQ(campaign.execution.launcher, (std::vector<std::string>{"srun", "-n1"}));
}

TEST(CampaignFile, ALatticeOfLevelsNeedsNoNumberOfThem) {
    const Campaign campaign = parse_campaign(R"({"campaign": "c", "scene": "rehearsal",
        "factors": [{"name": "x1", "levels": [0, 1]}, {"name": "x2", "levels": [0, 0.5, 1]}],
        "design": {"kind": "lattice"}})",
                                             ".");
    EXPECT_EQ(unfold(campaign, {}).size(), 6U);
}

TEST(Forecast, CountsEveryQuestionOnce) {
    const Campaign campaign = parse_campaign(R"({"campaign": "c", "scene": "rehearsal",
        "factors": [{"name": "wait_seconds", "levels": [1, 2]}],
        "design": {"kind": "list", "rows": [[1], [2], [1], [1]]}})",
                                             ".");
    const auto cost = forecast(campaign.scene(), unfold(campaign, {}));
    EXPECT_EQ(cost.places, 4);
    EXPECT_EQ(cost.questions, 2);
    EXPECT_NEAR(cost.total_seconds, 3, 1e-4);
    EXPECT_NEAR(cost.longest_seconds, 2, 1e-4);
}

Convergence convergence_of(int points, const std::string& design, const std::string& rule) {
    const std::string text = R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {)" + design +
                             R"(, "points": )" + std::to_string(points) + R"(}, "convergence": {"observable": "y")" +
                             rule + "}}";
    return *parse_campaign(text, ".").convergence;
}

// A rule that can never be checked looks like one that is never met.
TEST(CampaignFile, WithoutABlockTheDesignIsCheckedEightTimes) {
    const std::string sequences = R"("kind": "halton", "sequences": 8)", plain = R"("kind": "random")";
    EXPECT_EQ(convergence_of(2400, sequences, "").block, 296) << "37 rounds of 8 sequences";
    EXPECT_EQ(convergence_of(10000, sequences, "").block, 400);
    EXPECT_EQ(convergence_of(64, sequences, "").block, 32) << "4 points for each sequence at least";
    EXPECT_EQ(convergence_of(100, plain, R"(, "rule": "all_change")").block, 12);
    EXPECT_EQ(convergence_of(10, plain, R"(, "rule": "all_change")").block, 4);
    EXPECT_EQ(convergence_of(64, R"("kind": "sobol", "sequences": 4)", "").block, 16) << "sobol sequences repeat, too";
}

TEST(CampaignFile, SaysWhenNoCheckCanEverPass) {
    const auto never = [](int points, int block) {
        return never_converges(parse_campaign(
            R"({"campaign": "c", "scene": "rehearsal",
            "factors": [{"name": "x1", "between": [0, 1]}], "design": {"kind": "halton", "points": )" +
                std::to_string(points) + R"(}, "convergence": {"observable": "y", "rule": "all_change", "block": )" +
                std::to_string(block) + "}}",
            "."));
    };
    EXPECT_EQ(never(100, 400), "convergence can never be checked: a block is 400 points, and the design has 100");
    EXPECT_NE(never(100, 60).find("needs two checks"), std::string::npos) << never(100, 60);
    EXPECT_EQ(never(100, 50), "");
}

TEST(Forecast, SaysThatARowOfAListIsThereAgain) {
    const auto warnings = [](const std::string& rows) {
        const Campaign campaign =
            parse_campaign(R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
                               "design": {"kind": "list", "rows": )" +
                               rows + "}}",
                           ".");
        return warnings_of(campaign, forecast(campaign.scene(), unfold(campaign, {})));
    };
    EXPECT_TRUE(warnings("[[0.1], [0.2]]").empty());
    const auto said = warnings("[[0.1], [0.1], [0.1], [0.2]]");
    ASSERT_EQ(said.size(), 1U);
    EXPECT_EQ(said[0].rfind("the 4 cases of the design are 2 different ones, and each counts once", 0), 0U) << said[0];
}

// Warnings of a scene, counted once a kind over the cases that are really asked.
TEST(Forecast, CountsWarningsByKind) {
    const Campaign campaign = parse_campaign(R"({"campaign": "c", "scene": "powder_spreading",
        "factors": [{"name": "gap", "levels": [0.0001, 0.0002, 0.004, 0.05]}], "design": {"kind": "lattice"}})",
                                             ".");
    const auto cost = forecast(campaign.scene(), unfold(campaign, {}));
    ASSERT_EQ(cost.cautions.size(), 2U);
    EXPECT_EQ(cost.cautions[0].kind, "gap below half a diameter");
    EXPECT_EQ(cost.cautions[0].questions, 2);
    EXPECT_EQ(cost.cautions[0].first_point, 0);
    EXPECT_EQ(cost.cautions[1].kind, "gap above the layer");
    EXPECT_EQ(cost.cautions[1].first_point, 3);
    const auto warnings = warnings_of(campaign, cost);
    ASSERT_EQ(warnings.size(), 2U);
    EXPECT_EQ(warnings[0].rfind("gap below half a diameter: 2 of 4 cases, first at point 0: a gap of 0.0001 m", 0), 0U)
        << warnings[0];
}

}  // namespace grainsweep::tests::campaign_reads_test
