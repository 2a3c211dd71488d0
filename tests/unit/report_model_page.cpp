// What the report shows of a response model: averages, slices and bands of a response that is known.
#include "sweep/campaign/input_error.hpp"
#include "sweep/report/influence_tables.hpp"
#include "sweep/report/model_page.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/table.hpp"
#include "tests/support/study.hpp"
#include "tests/support/written.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::report_model_page_test {

using namespace report;
using namespace study;

using testing::HasSubstr;
using Json = nlohmann::ordered_json;

/// y = sin(pi x1) + x1 x2/2 + x3/20 over [0, 1]^2 and three levels of x3: averaged over the others it is
/// sin(pi x1) + x1/4 + 1/40 along x1, 2/pi + x2/4 + 1/40 along x2; at their middle the same, but 1 in place of 2/pi.
double known(double x1, double x2, double x3) {
    return std::sin(std::numbers::pi * x1) + x1 * x2 / 2 + x3 / 20;
}

struct ModelPage : Study {
    void answer(int points, const std::string& more = "") {
        answer_by(store,
                  R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
                      {"name": "x2", "between": [0, 1]}, {"name": "x3", "levels": [0, 0.5, 1]}],
                      "design": {"kind": "halton", "points": )" +
                      std::to_string(points) + "}" + more + "}",
                  [](const Inputs& i) { return known(input(i, "x1"), input(i, "x2"), input(i, "x3")); });
    }
    Json data(int points, const std::string& more = "", const PageModels& models = {}) {
        answer(points, more);
        const PageSource source{&store, "a.db"};
        return tests::parsed(page_data({&source, 1}, models))["campaigns"][0]["models"];
    }
    ModelPictures pictures(int points, const std::string& more = "") {
        answer(points, more);
        const auto cases = settled_and_imported_cases(ask("c"));
        return model_pictures(cases, learn_or_refuse(cases, cases.observable("y")), admission(store, cases));
    }
};

TEST_F(ModelPage, TextsBesideItsFigures) {
    const auto models = data(150);
    ASSERT_EQ(models.size(), 1U);
    EXPECT_EQ(models[0]["observable"], "y");
    EXPECT_THAT(models[0]["says"].get<std::string>(), HasSubstr("model of y: 150 cases"));
    EXPECT_EQ(models[0]["over"], Json({"x1", "x2"}));
    EXPECT_EQ(models[0]["others"], "x3 0.5");
    EXPECT_EQ(models[0]["failed"], false);
}

TEST_F(ModelPage, AveragesAndSlicesAreThoseOfTheResponse) {
    const auto found = pictures(150);
    EXPECT_THAT(found.order, testing::ElementsAre(0, 1, 2));
    EXPECT_THAT(found.middle, testing::ElementsAre(0.5, 0.5, 0.5));
    const auto& along_x1 = found.curves[0];
    ASSERT_EQ(along_x1.at.size(), 31U);
    EXPECT_EQ(along_x1.at.front(), 0);
    EXPECT_EQ(along_x1.at.back(), 1);
    for (std::size_t i = 0; i < 31; ++i) {
        const double x = along_x1.at[i];
        EXPECT_NEAR(along_x1.mean[i], known(x, 0.5, 0.5), 0.02) << x;
        EXPECT_NEAR(along_x1.averaged[i], known(x, 0.5, 0.5), 0.02) << x;
        EXPECT_GT(along_x1.mean_half_width[i], 0);
        EXPECT_GE(along_x1.run_half_width[i], along_x1.mean_half_width[i]);
        const double x2 = found.curves[1].at[i];
        EXPECT_NEAR(found.curves[1].mean[i], known(0.5, x2, 0.5), 0.02) << x2;
        EXPECT_NEAR(found.curves[1].averaged[i], 2 / std::numbers::pi + x2 / 4 + 0.025, 0.02) << x2;
    }
    const auto& along_x3 = found.curves[2];
    EXPECT_THAT(along_x3.at, testing::ElementsAre(0.0, 0.5, 1.0));
    EXPECT_NEAR(along_x3.averaged[2] - along_x3.averaged[0], 0.05, 0.01);
}

TEST_F(ModelPage, SharesOfTheVarianceAreThoseOfSensitivity) {
    const auto shares = data(150)[0]["influence"];
    EXPECT_EQ(shares["columns"], Json({"factor", "first order", "total", "interactions"}));
    const auto all = ask("c");
    const auto found = model_influence_of(all, all.observable("y"));
    EXPECT_EQ(shares["rows"], tests::parsed(columns_and_rows(model_influence_table(found)))["rows"]);
    EXPECT_EQ(shares["rows"].size(), 3U);
    EXPECT_EQ(shares["says"].get<std::vector<std::string>>(), model_influence_lines(found));
}

TEST_F(ModelPage, SharesOfTheVarianceAreRefusedWhereThePointsLeaveAPartOut) {
    const auto shares = data(150, R"(, "where": "x1 + x2 <= 1.5")")[0]["influence"];
    EXPECT_TRUE(shares["rows"].empty());
    EXPECT_THAT(shares["says"][0].get<std::string>(), HasSubstr("leaves a part of the box out"));
}

TEST_F(ModelPage, TheMapIsOverTheTwoFactorsThatMatterMost) {
    const auto found = pictures(150, R"(, "where": "x1 + x2 <= 1.5")");
    const auto& map = found.map.value();
    EXPECT_EQ(map.across, 0U);
    EXPECT_EQ(map.up, 1U);
    EXPECT_EQ(map.count, 21U);
    ASSERT_EQ(map.slice.size(), 21U * 21U);
    for (std::size_t j = 0; j < 21; ++j)
        for (std::size_t i = 0; i < 21; ++i) {
            const double x1 = (static_cast<double>(i) + 0.5) / 21, x2 = (static_cast<double>(j) + 0.5) / 21;
            const double slice = map.slice[j * 21 + i], averaged = map.averaged[j * 21 + i];
            ASSERT_EQ(std::isnan(slice), x1 + x2 > 1.5) << "what the condition leaves out is empty";
            ASSERT_EQ(std::isnan(averaged), x1 + x2 > 1.5);
            if (std::isnan(slice)) continue;
            EXPECT_NEAR(slice, known(x1, x2, 0.5), 0.05) << x1 << ' ' << x2;
            EXPECT_NEAR(averaged, known(x1, x2, 0.5), 0.05) << x1 << ' ' << x2;
        }
}

TEST_F(ModelPage, AReasonStandsWhereThereIsNone) {
    const auto models = data(10);
    ASSERT_EQ(models.size(), 1U);
    EXPECT_THAT(models[0]["refused"].get<std::string>(), HasSubstr("10"));
}

TEST_F(ModelPage, LargeCampaignsHaveOneWhereItIsAskedFor) {
    EXPECT_TRUE(data(60, "", {.of = {}, .unasked_cases = 50}).empty());
    EXPECT_EQ(data(60, "", {.of = {"y"}, .unasked_cases = 50}).size(), 1U);
    try {
        (void)data(60, "", {.of = {"yy"}, .unasked_cases = 50});
        ADD_FAILURE() << "an unknown scalar passed";
    } catch (const campaign::InputError& wrong) {
        EXPECT_THAT(wrong.what(), HasSubstr("--model: got 'yy'"));
        EXPECT_THAT(wrong.what(), HasSubstr("Did you mean 'y'?"));
    }
}

}  // namespace grainsweep::tests::report_model_page_test
