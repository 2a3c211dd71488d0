// Cases that stand at several points of a design: each is one run, and counts once.
#include "sweep/study/history.hpp"
#include "sweep/study/influence.hpp"
#include "tests/support/study.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::report_repeated_cases_test {

using testing::Contains;
using testing::HasSubstr;

TEST_F(Study, ACaseThatStandsAtManyPointsCountsOnce) {
    // 4,800 points of a sample over levels are six cases: six runs, whatever the number of points.
    std::uint64_t run = 0;
    answer_by(store, R"({"campaign": "levels", "scene": "rehearsal", "factors": [{"name": "x1", "levels": [0, 1]},
        {"name": "x2", "levels": [0, 0.5, 1]}], "design": {"kind": "halton", "sequences": 8, "points": 4800},
        "convergence": {"observable": "y", "gates": ["mean"], "tolerance": 0.03, "block": 48}})",
              [&](const Inputs&) { return disturbed(1, 0.5, 7, run++); });
    ASSERT_EQ(run, 6U);
    const auto responses = ask("levels");
    EXPECT_EQ(responses.rows(), 6U);
    EXPECT_EQ(responses.repeated.size(), 4794U);
    EXPECT_EQ(responses.dropped(), 0);
    EXPECT_EQ(responses.settled_points, 4800);
    double mean = 0;
    for (std::uint64_t k = 0; k < 6; ++k) mean += *disturbed(1, 0.5, 7, k) / 6;
    const auto history = study::history_of(responses, responses.observable("y"));
    EXPECT_NEAR(history.all.of(stats::Statistic::mean).value, mean, 1e-12);
    EXPECT_EQ(history.all.count, 6);
    EXPECT_TRUE(std::isnan(history.all.of(stats::Statistic::mean).error));
    ASSERT_TRUE(history.converged);
    EXPECT_FALSE(*history.converged);
    EXPECT_THAT(history.warnings, Contains(HasSubstr("4794 of 4800 places repeat an earlier case")));
    EXPECT_THAT(study::points_line(responses), HasSubstr("6 cases asked, 6 finished, 4794 places repeat one of them"));

    const auto influence = study::influence_of(responses, responses.observable("y"));
    EXPECT_EQ(influence.used, 6);
    for (const auto& factor : influence.factors)
        EXPECT_FALSE(factor.first.half_width < 0.2) << factor.factor << factor.first.half_width;
    const auto alone = study::read_response(store, store.campaigns().front(), "y");
    EXPECT_EQ(alone.rows(), 6U);
    EXPECT_EQ(study::history_of(alone, alone.observables.front()).verdict, history.verdict);
}

TEST_F(Study, RowsOfAListThatRepeatCountOnce) {
    answer_by(store, R"({"campaign": "rows", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {"kind": "list", "rows": [[0.1], [0.1], [0.1], [0.1], [0.5], [0.9], [0.9], [0.2]]}})",
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    const auto responses = ask("rows");
    EXPECT_EQ(responses.rows(), 4U);
    const auto history = study::history_of(responses, responses.observable("y"));
    EXPECT_NEAR(history.all.of(stats::Statistic::mean).value, (0.1 + 0.5 + 0.9 + 0.2) / 4, 1e-12);
    EXPECT_EQ(history.all.count, 4);
}

}  // namespace grainsweep::tests::report_repeated_cases_test
