// Where cases failed nothing is recommended, counted, drawn or predicted: windows, predictions, pages.
#include "stats/random.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/report/model_panels.hpp"
#include "sweep/report/model_tables.hpp"
#include "sweep/report/window_page.hpp"
#include "sweep/report/window_tables.hpp"
#include "sweep/study/answers.hpp"
#include "sweep/study/process_window.hpp"
#include "tests/support/answered.hpp"
#include "tests/support/drawings.hpp"
#include "tests/support/written.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <optional>
#include <variant>

namespace grainsweep::tests::report_failed_cases_test {

using namespace report;
using namespace study;

using testing::AnyOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

/// y = 1 - x1 + (x2 - 0.5)/10 where x1 > 0.3; there is no answer below.
struct FailedCases : testing::Test {
    Folder folder;
    store::Store store{folder / "a.db", store::Store::Mode::create};

    ModelCases cases(const Formula& formula, int points = 80, const std::string& more = "") {
        answer_by(store,
                  R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
                      {"name": "x2", "between": [0, 1]}], "design": {"kind": "halton", "points": )" +
                      std::to_string(points) + "}" + more + "}",
                  formula);
        return read_model_cases(store, "c");
    }
    static std::optional<double> jams(const Inputs& inputs) {
        if (!(input(inputs, "x1") > 0.3)) return std::nullopt;
        return 1 - input(inputs, "x1") + (input(inputs, "x2") - 0.5) / 10;
    }
};

TEST_F(FailedCases, NoSettingIsRecommendedAmongThem) {
    const auto known = cases(jams);
    EXPECT_THAT(failed_text(known), testing::MatchesRegex("2[3-5] of 80 cases failed \\(2[3-5] unstable\\)"));
    const WindowRequest request{.where = "y >= 0.5", .objectives = {{"y"}}, .next = 5};
    const auto window = window_of(store, known, request);
    ASSERT_TRUE(window.best);
    EXPECT_GE(window.best->setting[0], 0.29) << "the largest y of the model is at x1 = 0";
    EXPECT_LT(window.best->setting[0], 0.4);
    EXPECT_GE(window.best->answers, 0.95);
    EXPECT_GE(window.best->probability, 0.95);
    EXPECT_NEAR(window.share_failed, 0.33, 0.04) << "0.3, and a border that is known to a twentieth";
    EXPECT_NEAR(window.share_of_box, 0.17, 0.04) << "0.3 < x1 < 0.5";
    for (const auto* list : {&window.front, &window.next})
        for (const auto& one : *list) {
            EXPECT_TRUE(one.believed) << one.setting[0];
            EXPECT_GT(one.setting[0], 0.25);
        }
    EXPECT_THAT(window.notes, Contains(HasSubstr("has an answer with a probability below 0.95")));
    EXPECT_THAT(window.notes, Contains(testing::MatchesRegex("at the best setting a case has an answer with "
                                                             "probability .* of the 5 nearest cases failed.*")));

    EXPECT_THAT(tests::text_of(window_document(known, request, window)), HasSubstr("near_failed"));
    const auto json = tests::parsed(window_json(known, request, window));
    EXPECT_EQ(json["share_failed"], window.share_failed);
    EXPECT_EQ(json["best"]["near_cases"], 5);
    EXPECT_EQ(json["best"]["answers"], window.best->answers);
}

TEST_F(FailedCases, AFactorAsTheObjectiveStopsBeforeThem) {
    const auto known = cases(jams);
    for (const bool by_factor_alone : {false, true}) {
        const auto window =
            window_of(store, known,
                      {.where = by_factor_alone ? "x2 >= 0" : "y >= 0.1", .objectives = {{"x1", false}}, .next = 3});
        ASSERT_TRUE(window.best);
        EXPECT_NEAR(window.best->setting[0], 0.33, 0.04);
        for (const auto& one : window.next) EXPECT_GT(one.setting[0], 0.25);
    }
}

TEST_F(FailedCases, WithoutOneTheShareThatMayFailIsSaid) {
    const auto known = cases([](const Inputs& inputs) { return 1 - input(inputs, "x1"); });
    const WindowRequest request{.where = "y >= 0.5", .objectives = {{"y"}}};
    const auto window = window_of(store, known, request);
    EXPECT_EQ(window.share_failed, 0);
    EXPECT_THAT(window.notes,
                testing::Contains(HasSubstr("none of 80 cases failed: up to 3.7 % of the box may fail")).Times(1));
    EXPECT_THAT(tests::text_of(window_document(known, request, window)), testing::Not(HasSubstr("near_")));
}

TEST_F(FailedCases, WhereNearlyAllFailedThereIsNoWindow) {
    // An answer at every sixth case, alone among failed ones.
    int number = 0;
    const auto known = cases(
        [&](const Inputs& inputs) -> std::optional<double> {
            if (number++ % 6 != 0) return std::nullopt;
            return 1 - input(inputs, "x1");
        },
        96);
    try {
        const auto window = window_of(store, known, {.where = "y >= 0.5", .objectives = {{"y"}}});
        EXPECT_LT(window.share_of_box, 0.1);
        EXPECT_GT(window.share_failed, 0.8);
    } catch (const campaign::InputError& wrong) {
        EXPECT_THAT(wrong.what(), HasSubstr("80 of 96 cases failed (80 unstable)"));
        EXPECT_THAT(wrong.what(), HasSubstr("none can be recommended"));
    }
}

TEST_F(FailedCases, APredictionAmongThemSaysThatNoCaseNearHasAnAnswer) {
    const auto known = cases(jams);
    const auto model = learn_or_refuse(known, known.observable("y"));
    const std::vector<Setting> settings = {{0.05, 0.5}, {0.7, 0.5}};
    const auto predicted = study::predict(known, model, settings, false);
    EXPECT_TRUE(std::isnan(predicted.predictions[0].mean));
    EXPECT_TRUE(std::isnan(predicted.predictions[0].mean_error));
    EXPECT_NEAR(predicted.predictions[1].mean, 0.3, 0.02);
    EXPECT_THAT(failures_near(known, predicted),
                testing::MatchesRegex(
                    "no case near x1 = 0.05, x2 = 0.5 has an answer, with probability (0.99.|1.000): 5 of the "
                    "5 nearest cases failed .5 unstable.\n"));
    const auto json = tests::parsed(predictions_json(known, model, predicted));
    EXPECT_TRUE(json["points"][0]["mean"].is_null());
    EXPECT_LT(json["points"][0]["answers"], 0.02);
    EXPECT_LE(json["points"][0]["answers_low"], json["points"][0]["answers"]);
    EXPECT_GE(json["points"][0]["answers_high"], json["points"][0]["answers"]);
    EXPECT_EQ(json["points"][0]["near_cases"], 5);
    EXPECT_EQ(json["points"][0]["near_failed"], 5);
    EXPECT_GT(json["points"][1]["answers"], 0.99);
    EXPECT_EQ(json["points"][1]["near_failed"], 0);
    const auto table = predictions_table(known, model, predicted);
    EXPECT_THAT(table.columns, testing::ElementsAre("x1", "x2", "mean", "mean_error", "scatter", "inside", "answers",
                                                    "answers_low", "answers_high", "near_cases", "near_failed"));
    EXPECT_EQ(table.rows[0][2], store::Table::Cell{});
    const auto extrapolated = study::predict(known, model, settings, true);
    EXPECT_NEAR(extrapolated.predictions[0].mean, 0.95, 0.1) << "what the model says, where it is asked to say it";
    EXPECT_THAT(failures_near(known, extrapolated), HasSubstr("no case near"));
}

TEST_F(FailedCases, PagesDrawThemAndNothingOverThem) {
    const auto known = cases(jams);
    const auto model = learn_or_refuse(known, known.observable("y"));
    EXPECT_EQ(known.failed[0].outcome, campaign::Outcome::unstable);
    EXPECT_LE(known.failed[0].setting[0], 0.3);
    const auto page = model_pictures(known, model, {});
    for (std::size_t i = 0; i < 31; ++i) {
        const double x = page.curves[0].at[i];
        if (x > 0.2 && x < 0.4) continue;
        EXPECT_EQ(std::isnan(page.curves[0].mean[i]), x < 0.3) << x;
        EXPECT_EQ(std::isnan(page.curves[0].averaged[i]), x < 0.3) << x;
    }
    EXPECT_TRUE(std::isnan(page.map.value().slice[0]));
    EXPECT_TRUE(std::isnan(page.map.value().averaged[0]));
    const auto crosses_of = [](const plot::Panel& panel) { return std::get<plot::Points>(panel.marks.back()); };
    const Quantity up{"y", 1};
    const auto drawn_curve = crosses_of(curve_panel(known, 0, page.curves[0], up, {"y", 0, 1}));
    EXPECT_EQ(drawn_curve.shape, plot::Points::Shape::cross);
    ASSERT_EQ(drawn_curve.x.size(), known.failed.size());
    for (std::size_t k = 0; k < known.failed.size(); ++k) {
        EXPECT_EQ(drawn_curve.x[k], known.failed[k].setting[0]);
        EXPECT_EQ(drawn_curve.y[k], 0) << "at the lower edge";
    }

    const WindowRequest request{.where = "y >= 0.5", .objectives = {{"y"}}};
    const auto window = window_of(store, known, request);
    const auto drawn = tests::parsed(window_page_data(known, request, window, {}));
    EXPECT_EQ(drawn["failed"], true);
    EXPECT_THAT(drawn["failed_near"].get<std::string>(), HasSubstr("of the 5 nearest cases failed"));
    for (const auto& figure : drawings_of(drawn["campaigns"][0])["maps"])
        EXPECT_THAT(figure["svg"].get<std::string>(), HasSubstr("failed cases"));
    const auto pictures = window_pictures(known, request, window, {});
    const auto& map = pictures.map.value();
    for (std::size_t k = 0; k < 41 * 41; ++k) {
        const double x1 = (static_cast<double>(map.across == 0 ? k % 41 : k / 41) + 0.5) / 41;
        if (x1 > 0.22) continue;
        EXPECT_LT(map.probability[k], 0.2) << x1;
        EXPECT_TRUE(std::isnan(map.objective[k])) << x1;
    }
    EXPECT_TRUE(std::isnan(pictures.curves[0].responses[0].mean[0]));
}

/// y = x1 everywhere; every tenth case fails, whatever its setting.
std::optional<double> licence(const Inputs& inputs) {
    const auto number = static_cast<std::uint64_t>(input(inputs, "x1") * 1e9 + input(inputs, "x2") * 1e7);
    if (stats::to_unit(stats::splitmix64(number)) < 0.1) return std::nullopt;
    return input(inputs, "x1");
}

TEST_F(FailedCases, WhetherTheyDependOnTheFactorsIsTested) {
    const auto beside = cases(jams);
    const auto found = Answers(beside).tests(beside);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_TRUE(found[0].depends());
    EXPECT_EQ(found[0].features, std::vector<std::string>{"x1"});
    EXPECT_THAT(found[0].text(),
                testing::MatchesRegex("unstable .2[3-5] cases.: the outcome depends on x1 .p (<=|=) 0.00[1-4]."));
}

TEST_F(FailedCases, ThatAreNoPropertyOfTheProcessMayBeLeftOut) {
    const auto all = cases(licence, 160);
    ASSERT_GT(all.failed.size(), 5U);
    const WindowRequest request{.where = "y <= 0.5"};
    const auto window = window_of(store, all, request);
    EXPECT_THAT(window.notes, Contains(HasSubstr("no evidence that the outcome depends on the factors")));
    EXPECT_THAT(window.notes, Contains(HasSubstr("--leave-out unstable")));
    EXPECT_GE(window.share_high - window.share_low, 0.1) << "0.9 is not known to be below 0.95 everywhere";

    const std::vector left_out = {campaign::Outcome::unstable};
    const auto without = read_model_cases(store, "c", left_out);
    EXPECT_TRUE(without.failed.empty());
    EXPECT_EQ(without.cases_left_out, all.failed.size());
    const auto free = window_of(store, without, request);
    EXPECT_NEAR(free.share_of_box, 0.5, 0.02);
    EXPECT_LT(free.share_high - free.share_low, 0.1);
    EXPECT_THAT(free.notes, Contains(HasSubstr("are left out as no property of the process: unstable")));
    EXPECT_THAT(free.notes, Each(testing::Not(HasSubstr("none of"))));
}

TEST_F(FailedCases, ABatchHasNoTwinsAndAFrontBeginsWithComputedCases) {
    // y scatters, so that a case hardly lowers the error at its setting.
    int number = 0;
    const auto known = cases(
        [&](const Inputs& inputs) -> std::optional<double> {
            const double u = stats::to_unit(stats::bits_at(4, 1, static_cast<std::uint64_t>(number++)));
            return 1 - std::pow(input(inputs, "x1") - 0.6, 2) - std::pow(input(inputs, "x2") - 0.4, 2) +
                   0.3 * (u - 0.5);
        },
        80);
    const WindowRequest request{.where = "y >= 0.5", .objectives = {{"y"}}, .next = 6};
    const auto window = window_of(store, known, request);
    ASSERT_EQ(window.next.size(), 6U);
    for (std::size_t i = 0; i < 6; ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GE(std::max(std::abs(window.next[i].setting[0] - window.next[j].setting[0]),
                               std::abs(window.next[i].setting[1] - window.next[j].setting[1])),
                      0.025);

    const WindowRequest trade{.where = "y >= 0.5", .objectives = {{"x1"}}};
    const auto front = window_of(store, known, trade);
    ASSERT_FALSE(front.computed_front.empty());
    const auto& column = known.observable("y").values;
    for (const auto& one : front.computed_front)
        for (std::size_t i = 0; i < known.settings.size(); ++i)
            EXPECT_FALSE(known.settings[i][0] > one.setting[0] && column[i] > one.against);
    const auto text = tests::text_of(window_document(known, trade, front));
    EXPECT_LT(text.find("computed cases, means over the runs"), text.find("predictions with a small error"));
    EXPECT_EQ(tests::parsed(window_json(known, trade, front))["computed_front"].size(), front.computed_front.size());
}

}  // namespace grainsweep::tests::report_failed_cases_test
