// Which curves the page draws, and how they are thinned.
#include "sweep/campaign/reader.hpp"
#include "sweep/report/page.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/study/curves.hpp"
#include "tests/support/archive.hpp"
#include "tests/support/written.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace grainsweep::tests::report_curves_test {

using testing::ElementsAre;

struct ReportCurves : testing::Test {
    Folder folder;
    store::Store store{folder / "a.db", store::Store::Mode::create};

    /// Six cells, two repeats each; all but the last case answered: a series of 1001 samples, a histogram at eight
    /// times and a profile, all told apart by the case's number.
    void answer_all_but_the_last() {
        const auto campaign = campaign::parse_campaign(
            R"({"campaign": "cells", "scene": "tpms_discharge", "replicates": 2,
                "factors": [{"name": "cell", "levels": ["schwarz_p", "gyroid", "diamond", "iwp", "frd", "i2y"]}],
                "design": {"kind": "lattice"}})",
            folder.path());
        const auto placed = campaign::unfold(campaign, store::make_filter("", campaign::filter_names(campaign)));
        store.enrol(campaign, placed, here());
        store.group([&] {
            for (std::size_t i = 0; i + 1 < placed.size(); ++i) {
                campaign::CaseResult result;
                result.attempt = {placed[i].question.id, 1};
                const auto number = static_cast<double>(i);
                auto& series = result.observations.series;
                for (int k = 0; k <= 1000; ++k)
                    series["retention_series"].push_back({.time = 0.01 * k, .bin = std::nan(""), .value = number + k});
                for (int t = 0; t < 8; ++t)
                    for (int b = 1; b <= 3; ++b)
                        series["overlap_histogram"].push_back(
                            {.time = 1.0 * t, .bin = 0.1 * b, .value = 100 * number + 10 * t + b});
                for (int b = 0; b < 4; ++b)
                    series["retained_profile"].push_back({.time = std::nan(""), .bin = 1.0 * b, .value = number});
                store.begin(result.attempt);
                store.finish(result);
            }
        });
    }
    [[nodiscard]] study::Curves curves(const study::CurveChoice& choice = {}) const {
        return study::read_curves(store, study::read_responses(store, store.campaigns().front()), choice);
    }
};

TEST_F(ReportCurves, AreThoseOfCompletedCasesInTheOrderOfTheScene) {
    answer_all_but_the_last();
    const auto all = curves();
    EXPECT_EQ(all.completed, 11u);
    EXPECT_EQ(all.drawn, 11u);
    std::vector<std::string> names;
    for (const auto& family : all.families) names.push_back(family.name);
    EXPECT_THAT(names, ElementsAre("overlap_histogram", "retained_profile", "retention_series"));

    const auto& retention = all.families[2];
    EXPECT_FALSE(retention.over_bins);
    EXPECT_TRUE(std::isnan(retention.at_time));
    ASSERT_EQ(retention.curves.size(), 11u);
    EXPECT_EQ(retention.curves[2].label, "gyroid");
    EXPECT_EQ(retention.curves[3].label, "gyroid");  // its repeat
    EXPECT_EQ(retention.curves[10].label, "i2y");
    const auto& one = retention.curves[5];
    ASSERT_EQ(one.x.size(), 200u);
    EXPECT_EQ(one.x.front(), 0);
    EXPECT_EQ(one.x.back(), 10);
    EXPECT_EQ(one.y.back(), 1005);
    for (std::size_t k = 0; k < one.x.size(); ++k) EXPECT_NEAR(one.y[k], 5 + 100 * one.x[k], 1e-9);
}

TEST_F(ReportCurves, AHistogramIsShownAQuarterOfTheWayAProfileAsItIs) {
    answer_all_but_the_last();
    const auto all = curves();
    const auto& histogram = all.families[0];
    EXPECT_TRUE(histogram.over_bins);
    EXPECT_EQ(histogram.at_time, 2);
    EXPECT_THAT(histogram.curves[4].x, ElementsAre(0.1, 0.2, 0.1 * 3));
    EXPECT_THAT(histogram.curves[4].y, ElementsAre(421, 422, 423));
    const auto& profile = all.families[1];
    EXPECT_TRUE(profile.over_bins);
    EXPECT_TRUE(std::isnan(profile.at_time));
    EXPECT_THAT(profile.curves[4].x, ElementsAre(0, 1, 2, 3));
}

TEST_F(ReportCurves, ManyCasesAreDrawnAtRandomAndTheSameEveryTime) {
    answer_all_but_the_last();
    const auto few = curves({.most_curves = 4, .most_samples = 3});
    EXPECT_EQ(few.completed, 11u);
    EXPECT_EQ(few.drawn, 4u);
    std::set<std::size_t> rows;
    for (const auto& curve : few.families[2].curves) {
        rows.insert(curve.row);
        EXPECT_THAT(curve.x, ElementsAre(0, 5, 10));
    }
    EXPECT_EQ(rows.size(), 4u);
    const auto again = curves({.most_curves = 4, .most_samples = 3});
    for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(again.families[2].curves[k].row, few.families[2].curves[k].row);
}

TEST_F(ReportCurves, StandInThePage) {
    answer_all_but_the_last();
    const report::PageSource source{&store, "a.db"};
    const auto data = tests::parsed(report::page_data({&source, 1}));
    const auto& curves = data["campaigns"][0]["curves"];
    EXPECT_EQ(curves["drawn"], 11);
    EXPECT_EQ(curves["families"][2]["over"], "time (sqrt(2 L/g))");
    EXPECT_EQ(curves["families"][2]["over_bins"], false);
    EXPECT_TRUE(curves["families"][2]["at"].is_null());
    EXPECT_EQ(curves["families"][0]["at"], 2);
    EXPECT_EQ(curves["families"][2]["curves"][0]["x"].size(), 200u);
}

}  // namespace grainsweep::tests::report_curves_test
