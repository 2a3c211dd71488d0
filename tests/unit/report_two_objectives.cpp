// A window of two objectives: its front, hypervolume and next cases on a published problem, and what its output holds.
#include "sweep/campaign/input_error.hpp"
#include "sweep/report/window_page.hpp"
#include "sweep/report/window_tables.hpp"
#include "sweep/study/response_models.hpp"
#include "tests/support/two_objectives.hpp"
#include "tests/support/written.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace grainsweep::tests::report_two_objectives_test {

using namespace report;
using namespace study;
using testing::HasSubstr;

struct TwoObjectives : testing::Test {
    Folder folder;
    store::Store store{folder / "a.db", store::Store::Mode::create};
    Problem problem = bnh();

    /// Cases of 12 points, and of so many batches of four.
    ModelCases searched(int batches) {
        (void)answer_all_by(store, problem.campaign(12, 1), problem.formulas());
        for (int k = 1; k <= batches; ++k) {
            const auto cases = read_model_cases(store, "c");
            const auto window = window_of(store, cases, problem.request(4));
            EXPECT_EQ(window.next.size(), 4U);
            (void)answer_all_by(store, next_campaign(cases, window, fmt::format("c_next{}", k), k), problem.formulas());
        }
        return read_model_cases(store, "c");
    }
};

TEST_F(TwoObjectives, TheirNextCasesApproachTheTrueFront) {
    const auto cases = searched(5);
    ASSERT_EQ(cases.settings.size(), 32U);
    const auto request = problem.request(0);
    const auto window = window_of(store, cases, request);
    const double truth = problem.true_volume(), found = problem.volume_of(cases);
    ASSERT_TRUE(window.volume);
    EXPECT_NEAR(window.volume->value, found, 2e-3 * truth) << "by the models, as by the values";
    EXPECT_LE(found, truth);
    double random = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) random += problem.random_search(5 * 32, seed) / 20;
    EXPECT_GT(found, random) << "five times as many at random";
    EXPECT_GE(window.volume->value + window.volume->further, truth * (1 - 1e-4));
    EXPECT_LE(window.volume->value + window.volume->further, truth * 1.01);
    ASSERT_GE(window.computed_front.size(), 6U);
    double last_1 = -1, last_2 = 1e9;
    for (const auto& one : window.computed_front) {
        const auto y = problem.of(one.setting);
        EXPECT_TRUE(problem.allows(y));
        EXPECT_NEAR(one.judged->objectives[0].mean, y.at("f1"), 4 * one.judged->objectives[0].mean_error + 0.1);
        EXPECT_GT(one.judged->objectives[0].mean, last_1);
        EXPECT_LT(one.judged->objectives[1].mean, last_2);
        last_1 = one.judged->objectives[0].mean;
        last_2 = one.judged->objectives[1].mean;
    }
    ASSERT_TRUE(window.best) << "a compromise";
    const auto y = problem.of(window.best->setting);
    EXPECT_TRUE(problem.allows(y));
    EXPECT_NEAR((140 - y.at("f1")) * (50 - y.at("f2")), 3477, 30) << "largest product, at x = y = 2.2";
}

TEST_F(TwoObjectives, TheOutputHasFrontHypervolumeAndBatches) {
    const auto cases = searched(1);
    const auto request = problem.request(2);
    const auto window = window_of(store, cases, request);
    const auto json = tests::parsed(window_json(cases, request, window));
    EXPECT_EQ(json["objectives"], nlohmann::ordered_json::parse(
                                      R"([{"observable": "f1", "maximize": false, "reference": 140.0},
                                          {"observable": "f2", "maximize": false, "reference": 50.0}])"));
    EXPECT_EQ(json["objective"]["observable"], "f1");
    EXPECT_EQ(json["hypervolume"]["value"], window.volume->value);
    EXPECT_GT(json["hypervolume"]["further"], 0);
    EXPECT_EQ(json["computed_front"][0]["means"].size(), 2U);
    EXPECT_EQ(json["computed_front"][0]["observables"].size(), 2U);
    ASSERT_EQ(json["batches"].size(), 2U);
    EXPECT_EQ(json["batches"][0]["campaign"], "c");
    EXPECT_EQ(json["batches"][0]["cases"], 12);
    EXPECT_EQ(json["batches"][1]["campaign"], "c_next1");
    EXPECT_EQ(json["batches"][1]["cases"], 4);
    EXPECT_LT(json["batches"][0]["hypervolume"], json["batches"][1]["hypervolume"]);
    EXPECT_EQ(json["batches"][1]["hypervolume"], json["hypervolume"]["value"]);
    std::ostringstream text;
    write(text, window_document(cases, request, window), Format::text);
    for (const char* part : {"hypervolume of the computed front", "front of f1 and f2: computed cases", "f2_error",
                             "smallest f1 and smallest f2, as a compromise", "beyond f1 140 and f2 50", "c_next1"})
        EXPECT_THAT(text.str(), HasSubstr(part));
    const auto data = tests::parsed(window_page_data(cases, request, window, {}));
    EXPECT_EQ(data["against"], "f2");
    EXPECT_THAT(data["volume"].get<std::string>(), HasSubstr("hypervolume"));
}

TEST_F(TwoObjectives, TheReferenceIsTheWorstComputedValue) {
    const auto cases = searched(0);
    auto request = problem.request(0);
    for (auto& objective : request.objectives) objective.reference.reset();
    const auto window = window_of(store, cases, request);
    for (std::size_t k = 0; k < 2; ++k)
        EXPECT_EQ(window.goals[k].reference, std::ranges::max(cases.observable(k == 0 ? "f1" : "f2").values));
    request.objectives[0].maximise = true;  // f1 and f2 fall together up to x = y = 5 only
    EXPECT_EQ(window_of(store, cases, request).goals[0].reference, std::ranges::min(cases.observable("f1").values));
}

TEST_F(TwoObjectives, OneMayBeAFactorButNotBoth) {
    const auto cases = searched(0);
    // The smallest f2 for the largest x1: without a limit, f2 at x1 = 5 is 4, and least everywhere there.
    const WindowRequest request{.objectives = {{"x1", true}, {"f1", false}}, .next = 2};
    const auto window = window_of(store, cases, request);
    EXPECT_EQ(window.goals[0].factor, 0U);
    for (const auto& one : window.front) EXPECT_NEAR(one.setting[1], 0, 0.4) << "f1 = 4 x1^2 + 4 x2^2";
    for (const auto& one : window.next) EXPECT_LT(one.setting[1], 0.6);
    const auto json = tests::parsed(window_json(cases, request, window));
    EXPECT_EQ(json["objectives"][0]["factor"], "x1");
    EXPECT_EQ(json["computed_front"][0]["observables"].size(), 1U);
    const WindowRequest both{.objectives = {{"x1", true}, {"x2", false}}};
    EXPECT_THROW((void)window_of(store, cases, both), campaign::InputError);
    const WindowRequest twice{.objectives = {{"f1", true}, {"f1", false}}};
    EXPECT_THROW((void)window_of(store, cases, twice), campaign::InputError);
}

TEST_F(TwoObjectives, NoCaseOfTheFrontIsWhereCasesFail) {
    const auto fails = [](double x) { return x < 1; };  // f1 is least there
    const auto answers = [&](const Inputs& inputs) -> std::optional<std::map<std::string, double>> {
        if (fails(input(inputs, "x1"))) return std::nullopt;
        return problem.formulas()(inputs);
    };
    (void)answer_all_by(store, problem.campaign(60, 1), answers);
    const auto cases = read_model_cases(store, "c");
    ASSERT_GT(cases.failed.size(), 6U);
    const auto window = window_of(store, cases, problem.request(4));
    ASSERT_FALSE(window.front.empty());
    for (const auto& one : window.front) {
        EXPECT_GE(one.answers, 0.95);
        EXPECT_FALSE(fails(one.setting[0])) << one.setting[0];
    }
    for (const auto& one : window.next) EXPECT_GE(one.answers, 0.5);
    EXPECT_LT(window.volume->value, 0.97 * problem.true_volume());
}

TEST_F(TwoObjectives, AnUnattainableReferenceDominatesNothing) {
    const auto cases = searched(0);
    auto request = problem.request(2);
    request.objectives[0].reference = -5;
    const auto window = window_of(store, cases, request);
    EXPECT_EQ(window.volume->value, 0);
    EXPECT_GE(window.volume->further, 0);
    std::ostringstream text;
    write(text, window_document(cases, request, window), Format::text);
    EXPECT_THAT(text.str(), HasSubstr("hypervolume of the computed front 0"));
}

/// The factor x2 cannot be set: the front is of averages over it.
TEST_F(TwoObjectives, AreAveragesOverNoise) {
    auto text = problem.campaign(40, 1);
    const std::string place = R"("name": "x2", )";
    text.insert(text.find(place) + place.size(), R"("role": "noise", )");
    (void)answer_all_by(store, text, problem.formulas());
    const auto cases = read_model_cases(store, "c");
    WindowRequest request = problem.request(2);
    request.where.clear();
    const auto window = window_of(store, cases, request);
    ASSERT_FALSE(window.computed_front.empty());
    for (const auto& one : window.computed_front) {
        EXPECT_TRUE(std::isnan(one.setting[1]));
        EXPECT_NEAR(one.judged->objectives[0].mean, 4 * one.setting[0] * one.setting[0] + 12, 1) << "4 <x2^2> = 12";
    }
    for (const auto& one : window.next) EXPECT_FALSE(std::isnan(one.setting[1])) << "a case has all factors";
}

}  // namespace grainsweep::tests::report_two_objectives_test
