// Points that steps, conditions and shares unfold to one case: moments, effects, models and windows from them.
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/schedule/judge.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/influence.hpp"
#include "sweep/study/model_influence.hpp"
#include "sweep/study/process_window.hpp"
#include "sweep/study/response_models.hpp"
#include "tests/support/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace grainsweep::tests::report_folded_cases_test {

using stats::Statistic;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

/// x2 counts for one tool of two, the other is one case for half of the points.
std::string tools(const std::string& more = "") {
    return R"({"campaign": "tools", "scene": "rehearsal", "factors": [{"name": "x1", "levels": [0, 1]},
        {"name": "x2", "between": [0.2, 1], "when": "x1 = 1"}],
        "design": {"kind": "halton", "points": 512, "sequences": 8})" +
           more + "}";
}

double by_tool(const Inputs& inputs) {
    return input(inputs, "x1") == 0 ? 5 : input(inputs, "x2");
}

TEST_F(Study, ARunWeighsAsManyPlacesAsHoldItAndErrorsDoNotShrinkByThem) {
    answer_by(store,
              tools(R"(, "convergence": {"observable": "y", "gates": ["mean"], "tolerance": 0.05, "block": 64})"),
              by_tool);
    const auto responses = ask("tools");
    EXPECT_TRUE(responses.repeats_weigh);
    const auto distinct = responses.rows();
    EXPECT_NEAR(static_cast<double>(distinct), 257, 4);
    const auto history = study::history_of(responses, responses.observable("y"));
    // Half of the points are the one run of 5; the others have the mean 0.6.
    const auto& mean = history.all.of(Statistic::mean);
    EXPECT_NEAR(mean.value, (5 + 0.6) / 2, 0.02);
    EXPECT_EQ(history.all.count, 512);
    EXPECT_EQ(history.all.runs, static_cast<std::int64_t>(distinct));
    // One run holds half of the weight: 1.96 sd/2, with sd = 2.2.
    EXPECT_NEAR(mean.error, 1.96 * 2.2 / 2, 0.05);
    ASSERT_TRUE(history.converged);
    EXPECT_FALSE(*history.converged);
    EXPECT_THAT(history.warnings, Contains(HasSubstr("weighs as many places as hold it")));
    const auto alone = study::read_response(store, store.campaigns().front(), "y");
    EXPECT_EQ(study::history_of(alone, alone.observables.front()).verdict, history.verdict);
}

TEST_F(Study, TheJudgeOfARunWeighsRepeatsAsTheReportDoes) {
    const auto campaign = answer_by(
        store, tools(R"(, "convergence": {"observable": "y", "gates": ["mean"], "tolerance": 0.9, "block": 64})"),
        by_tool);
    auto cases = campaign::unfold(campaign, {});
    std::vector<double> known(cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) known[i] = by_tool(cases.question(i).inputs);
    schedule::Judge judge(*campaign.convergence, cases, 8, known, {}, {}, true);
    (void)judge.judge(cases.size());
    ASSERT_TRUE(judge.converged_at());
    const auto responses = ask("tools");
    const auto history = study::history_of(responses, responses.observable("y"));
    ASSERT_TRUE(history.converged);
    EXPECT_TRUE(*history.converged);
    EXPECT_THAT(history.verdict, HasSubstr(std::to_string(*judge.converged_at()) + " points"));
}

TEST_F(Study, StepsOfALinearRangeCountOnceAsLevelsDo) {
    answer_by(
        store,
        R"({"campaign": "steps", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1], "step": 0.25},
        {"name": "x2", "levels": [0, 1]}], "design": {"kind": "halton", "points": 400, "sequences": 8}})",
        [](const Inputs& inputs) { return input(inputs, "x1"); });
    const auto responses = ask("steps");
    EXPECT_FALSE(responses.repeats_weigh);
    EXPECT_EQ(responses.rows(), 10U);
    const auto history = study::figures_of(responses, responses.observable("y"));
    EXPECT_NEAR(history.all.of(Statistic::mean).value, 0.5, 1e-12);
    EXPECT_TRUE(std::isnan(history.all.of(Statistic::mean).error));
    // Indices have one bin for each multiple.
    EXPECT_EQ(study::influence_of(responses, responses.observable("y")).factors[0].bins, 5U);
}

TEST_F(Study, EffectsOfStepsAndConditionsAreInTheUnitOfTheDesign) {
    // Of a grid of 4 places two are rounded to one multiple; where x3 does not count its move changes nothing.
    answer_by(store, R"({"campaign": "m", "scene": "rehearsal", "factors": [{"name": "x1", "levels": [0, 1]},
        {"name": "x2", "between": [0, 1], "step": 0.5}, {"name": "x3", "between": [0.2, 1], "when": "x1 = 1"}],
        "design": {"kind": "morris", "trajectories": 40}})",
              [](const Inputs& inputs) {
                  return input(inputs, "x2") + (input(inputs, "x1") == 1 ? 10 * input(inputs, "x3") : 0);
              });
    const auto responses = ask("m");
    const auto influence = study::influence_of(responses, responses.observable("y"));
    ASSERT_TRUE(influence.factors[1].effects && influence.factors[2].effects);
    EXPECT_EQ(influence.factors[1].effects->count, 40);
    // Places 0, 1/3, 2/3, 1 are rounded to 0, 0.5, 1, 1: a move by 2/3 is one of 1 or of 0.5.
    EXPECT_NEAR(influence.factors[1].effects->mu_star, 1.125, 0.3);
    // 8 a unit where it counts, in about half of the trajectories.
    EXPECT_NEAR(influence.factors[2].effects->mu_star, 4, 2);
}

TEST_F(Study, AModelSeesAConditionalFactorWhereItCounts) {
    answer_by(store, R"({"campaign": "tools", "scene": "rehearsal", "factors": [{"name": "x1", "levels": [0, 1]},
        {"name": "x2", "between": [0.2, 1], "when": "x1 = 1"}, {"name": "x3", "between": [0, 1]}],
        "design": {"kind": "halton", "points": 128, "sequences": 8}})",
              [](const Inputs& inputs) {
                  return input(inputs, "x3") + (input(inputs, "x1") == 0 ? 2 : input(inputs, "x2"));
              });
    const auto cases = study::read_model_cases(store, "tools");
    const auto model = study::learn_or_refuse(cases, cases.observable("y"));
    std::vector<study::Setting> asked = {{1, 0.9, 0.5}, {0, 0.3, 0.5}, {0, 0.95, 0.5}};
    const auto predicted = model.predict(asked);
    EXPECT_NEAR(predicted[0].mean, 1.4, 0.05);
    EXPECT_NEAR(predicted[1].mean, 2.5, 0.05);
    EXPECT_EQ(predicted[1].mean, predicted[2].mean);
    study::fold(cases.factors, asked[2]);
    EXPECT_EQ(asked[2][1], cases.factors[1].standard);
    const auto all = ask("tools");
    const auto influence = study::model_influence_of(all, all.observable("y"));
    ASSERT_TRUE(influence.indices) << influence.refused;
    EXPECT_GT(influence.indices->total[0].value, 0.6);
}

TEST_F(Study, BinnedIndicesOfValuesThatDependOnOtherFactorsSaySo) {
    answer_by(store, R"({"campaign": "tools", "scene": "rehearsal", "factors": [{"name": "x1", "levels": [0, 1]},
        {"name": "x2", "between": [0.2, 1], "when": "x1 = 1"}, {"name": "x3", "between": [0, 1]}],
        "design": {"kind": "halton", "points": 512, "sequences": 8}})",
              by_tool);
    const auto tool = ask("tools");
    const auto influence = study::influence_of(tool, tool.observable("y"));
    // x2 is at its default where x1 = 0, so its value tells the tool. By itself it explains (0.8^2/12)/4 of a variance
    // of about 4.4^2/4, 0.3 %.
    EXPECT_GT(influence.factors[1].first.value, 0.5);
    EXPECT_THAT(influence.notes, Contains(HasSubstr("the binned index of x2 includes the effect of its condition")));
    answer_by(store, R"({"campaign": "mix", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]}, {"name": "x4", "between": [0, 1]}],
        "simplex": ["x1", "x2", "x3"], "design": {"kind": "halton", "points": 512, "sequences": 8}})",
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    const auto mix = ask("mix");
    const auto shares = study::influence_of(mix, mix.observable("y"));
    EXPECT_GT(shares.factors[0].first.value, 0.95);
    EXPECT_GT(shares.factors[1].first.value, 0.1) << "x2 has no effect, but where it is large x1 is small";
    EXPECT_THAT(shares.notes, Contains(HasSubstr("x1, x2, x3 add to one: the binned index of each includes the effect "
                                                 "of the others")));
    answer_by(store, halton("plain", 128), linear);
    const auto plain = ask("plain");
    EXPECT_THAT(study::influence_of(plain, plain.observable("y")).notes,
                Not(Contains(HasSubstr("the binned index of"))));
}

TEST_F(Study, AWindowSuggestsSettingsThatCanBeSet) {
    answer_by(store, R"({"campaign": "w", "scene": "rehearsal", "factors": [
        {"name": "x1", "between": [0, 1], "step": 0.05}, {"name": "x2", "levels": [0, 1]},
        {"name": "x3", "between": [0.2, 1], "when": "x2 = 1"},
        {"name": "x4", "between": [0, 1]}, {"name": "x5", "between": [0.1, 1]}, {"name": "x6", "between": [0, 1]}],
        "simplex": ["x4", "x5", "x6"], "design": {"kind": "halton", "points": 128}})",
              [](const Inputs& inputs) {
                  const auto x = [&](const char* name) { return input(inputs, name); };
                  return -std::pow(x("x1") - 0.37, 2) - (x("x2") == 1 ? 1 + 0.1 * x("x3") : 0.0) -
                         std::pow(x("x4") - 0.5, 2) - std::pow(x("x5") - 0.3, 2);
              });
    const auto cases = study::read_model_cases(store, "w");
    study::WindowRequest request;
    request.objectives = {{"y"}};
    request.next = 6;
    const auto window = study::window_of(store, cases, request);
    ASSERT_TRUE(window.best);
    auto settings = window.searched;
    settings.push_back(window.best->setting);
    for (const auto& next : window.next) settings.push_back(next.setting);
    for (const auto& setting : settings) {
        EXPECT_NEAR(setting[0] * 20, std::round(setting[0] * 20), 1e-9);
        EXPECT_NEAR(setting[3] + setting[4] + setting[5], 1, 1e-9);
        EXPECT_GE(setting[4], 0.1);
        if (setting[1] == 0) {
            EXPECT_EQ(setting[2], cases.factors[2].standard);
        }
    }
    const auto& best = window.best->setting;
    EXPECT_NEAR(best[0], 0.35, 0.051);
    EXPECT_EQ(best[1], 0);
    EXPECT_NEAR(best[3], 0.5, 0.1);
    EXPECT_NEAR(best[4], 0.3, 0.1);
    // Its next cases are a campaign of the same question.
    const auto next = campaign::parse_campaign(study::next_campaign(cases, window, "w_next1", 1), ".");
    EXPECT_EQ(campaign::identity_of(next).factors, cases.campaign.factors);
    const auto all = ask("w");
    EXPECT_THAT(study::model_influence_of(all, all.observable("y")).refused, HasSubstr("shares that add to one"));
}

}  // namespace grainsweep::tests::report_folded_cases_test
