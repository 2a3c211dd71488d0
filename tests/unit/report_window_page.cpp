// What the page of a process window holds, and that nothing in it asks a network.
#include "sweep/report/window_page.hpp"
#include "sweep/report/window_tables.hpp"
#include "sweep/study/process_window.hpp"
#include "sweep/study/response_models.hpp"
#include "tests/support/answered.hpp"
#include "tests/support/drawings.hpp"
#include "tests/support/written.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

namespace grainsweep::tests::report_window_page_test {

using namespace report;
using namespace study;

using testing::HasSubstr;
using testing::Not;

/// y = x1 - x2/2 + x3/100 over x1, x2 in [0, 1] and two levels of x3; x1 <= 0.5 is asked for. Best: x1 = 0.5, x2 = 0.
struct WindowPage : testing::Test {
    Folder folder;
    store::Store store{folder / "a.db", store::Store::Mode::create};
    WindowRequest request{.where = "x1 <= 0.5 and y >= -0.2", .objectives = {{"y"}}, .next = 2};

    ModelCases cases(const std::string& more = "") {
        answer_by(store,
                  R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
                      {"name": "x2", "between": [0, 1]}, {"name": "x3", "levels": [0, 1]}],
                      "design": {"kind": "halton", "points": 80})" +
                      more + "}",
                  [](const Inputs& inputs) {
                      return input(inputs, "x1") - 0.5 * input(inputs, "x2") + 0.01 * input(inputs, "x3");
                  });
        return read_model_cases(store, "c");
    }
};

TEST_F(WindowPage, MapsTheTwoFactorsThatMatterMostThroughTheBestSetting) {
    const auto known = cases();
    const auto window = window_of(store, known, request);
    const auto data = tests::parsed(window_page_data(known, request, window, {}));
    EXPECT_EQ(data["meets"], true);
    EXPECT_NEAR(data["best"]["setting"][0], 0.5, 0.01);
    EXPECT_NEAR(data["best"]["setting"][1], 0.0, 0.01);
    const auto pictures = window_pictures(known, request, window, {});
    EXPECT_THAT(pictures.order, testing::ElementsAre(0, 1, 2));
    const auto& map = pictures.map.value();
    ASSERT_EQ(map.count, 41U);
    ASSERT_EQ(map.probability.size(), 41U * 41U);
    for (std::size_t j = 0; j < 41; ++j)
        for (std::size_t i = 0; i < 41; ++i) {
            const double x1 = (static_cast<double>(i) + 0.5) / 41, x2 = (static_cast<double>(j) + 0.5) / 41;
            const double y = x1 - x2 / 2;
            if (std::abs(x1 - 0.5) < 0.02 || std::abs(y + 0.2) < 0.05) continue;
            EXPECT_NEAR(map.probability[j * 41 + i], x1 <= 0.5 && y >= -0.2 ? 1 : 0, 0.02) << x1 << ' ' << x2;
            EXPECT_NEAR(map.objective[j * 41 + i], y, 0.03);
        }
}

TEST_F(WindowPage, FactorsThatDecideTheConditionComeBeforeThoseOfTheObjective) {
    const auto known = cases();
    request.where = "x2 <= 0.3 and x3 >= 0.5";
    const auto pictures = window_pictures(known, request, window_of(store, known, request), {});
    EXPECT_EQ(pictures.order[2], 0U) << "x1 alone moves the objective";
}

/// The largest x1 with y <= 0.3: x1 = 0.8, at x2 = 1.
TEST_F(WindowPage, AFactorMayBeTheObjective) {
    const auto known = cases();
    request.where = "y <= 0.3";
    request.objectives = {{"x1"}};
    const auto window = window_of(store, known, request);
    ASSERT_TRUE(window.goals[0].factor);
    ASSERT_TRUE(window.best);
    EXPECT_NEAR(window.best->setting[0], 0.8, 0.02);
    EXPECT_NEAR(window.best->setting[1], 1, 0.02);
    EXPECT_GE(window.best->probability, 0.95);
    EXPECT_EQ(window.best->objectives[0].mean, window.best->setting[0]);
    EXPECT_EQ(window.best->objectives[0].mean_error, 0);
    ASSERT_EQ(window.models.size(), 1U);
    for (const auto& one : window.next) EXPECT_GT(one.setting[0], window.best->setting[0]) << "no gain below";
    ASSERT_EQ(window.against->model, 0U);
    for (std::size_t k = 1; k < window.front.size(); ++k) {
        EXPECT_GT(window.front[k].setting[0], window.front[k - 1].setting[0]);
        EXPECT_GT(window.front[k].predictions[0].mean, window.front[k - 1].predictions[0].mean);
    }
    const auto json = tests::parsed(window_json(known, request, window));
    EXPECT_EQ(json["objective"], nlohmann::ordered_json({{"factor", "x1"}, {"maximize", true}}));
    EXPECT_EQ(json["best"]["mean"], window.best->setting[0]);
    EXPECT_TRUE(window_pictures(known, request, window, {}).map.value().objective.empty())
        << "it would be the factor's own axis";
    request.objectives[0].maximise = false;
    request.where = "y >= 0.3";
    const auto least = window_of(store, known, request);
    ASSERT_TRUE(least.best);
    EXPECT_NEAR(least.best->setting[0], 0.3, 0.02);
    EXPECT_NEAR(least.best->setting[1], 0, 0.02);
}

TEST_F(WindowPage, CurvesHoldBandsOfTheMeanAndOfARun) {
    const auto known = cases();
    const auto window = window_of(store, known, request);
    const auto data = tests::parsed(window_page_data(known, request, window, {}));
    const auto curves = window_pictures(known, request, window, {}).curves;
    const auto& curve = curves[1];
    ASSERT_EQ(curve.at.size(), 41U);
    EXPECT_EQ(curve.at[0], 0);
    EXPECT_EQ(curve.at[40], 1);
    for (std::size_t i = 0; i < 41; ++i) {
        const auto& y = curve.responses[0];
        const double truth = 0.5 - curve.at[i] / 2 + 0.01 * data["best"]["setting"][2].get<double>();
        EXPECT_NEAR(y.mean[i], truth, 0.03);
        EXPECT_GE(y.run_half_width[i], y.mean_half_width[i]);
    }
    EXPECT_THAT(curves[2].at, testing::ElementsAre(0.0, 1.0)) << "a level each";
    EXPECT_EQ(data["next"].size(), window.next.size());
    EXPECT_GE(window.next.size(), 1U) << "a second one need not be worth a run";
    EXPECT_THAT(data["models"][0].get<std::string>(), HasSubstr("leave-one-out error"));
}

TEST_F(WindowPage, CellsThatTheCampaignLeavesOutAreEmpty) {
    const auto known = cases(R"(, "where": "x2 < 0.5")");
    const auto window = window_of(store, known, request);
    const auto map = window_pictures(known, request, window, admission(store, known)).map.value();
    EXPECT_EQ(map.up, 1U);
    EXPECT_TRUE(std::isnan(map.probability[40 * 41]));
    EXPECT_FALSE(std::isnan(map.probability[0]));
}

TEST_F(WindowPage, ItsFiguresAreDrawnWithTitlesAndUnits) {
    const auto known = cases();
    const auto window = window_of(store, known, request);
    const auto data = tests::parsed(window_page_data(known, request, window, {}));
    const auto figures = drawings_of(data["campaigns"][0]);
    std::vector<std::string> titles;
    for (const char* list : {"maps", "curves"})
        for (const auto& one : figures[list]) titles.push_back(one["title"]);
    EXPECT_THAT(titles, testing::ElementsAre(
                            "Process window: x1 <= 0.5 and y >= -0.2", "y against x1 and x2", "y against x1",
                            "y against x2", "y against x3", "probability of the condition against x1",
                            "probability of the condition against x2", "probability of the condition against x3"));
    const std::string map = figures["maps"][0]["svg"];
    for (const char* part : {">x1<", ">x2<", ">probability<", "stroke-width=\"1.2\""})
        EXPECT_THAT(map, HasSubstr(part));
    // 41 x 41 cells, yellow where the condition holds: two fifths and more of the left half.
    const std::string sure = "#fde725";
    std::size_t cells = 0, yellow = 0;
    for (std::size_t at = map.find("<path"); at != std::string::npos; at = map.find("<path", at + 1)) ++cells;
    for (std::size_t at = map.find(sure); at != std::string::npos; at = map.find(sure, at + 1)) ++yellow;
    EXPECT_GT(cells, 41U * 41U);
    EXPECT_GT(yellow, 1U);
    const std::string curve = figures["curves"][0]["svg"];
    for (const char* part : {"95 % of the mean", "95 % of a single run", "setting", "stroke-dasharray", "fill-opacity"})
        EXPECT_THAT(curve, HasSubstr(part));
}

TEST_F(WindowPage, IsDrawnWhereNothingMeetsTheConditionToo) {
    const auto known = cases();
    request.where = "y > 5";
    const auto window = window_of(store, known, request);
    const auto data = window_page_data(known, request, window, {});
    EXPECT_EQ(tests::parsed(data)["meets"], false);
    std::ostringstream page;
    write_window_page(page, data, "a.db");
    EXPECT_THAT(page.str(), HasSubstr("<!doctype html>"));
    EXPECT_THAT(page.str(), Not(HasSubstr("src=")));
    EXPECT_THAT(page.str(), Not(HasSubstr("{{")));
}

}  // namespace grainsweep::tests::report_window_page_test
