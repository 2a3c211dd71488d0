// Figures by a response model beside the plain ones: moments with the model as control variate, total indices.
#include "stats/random.hpp"
#include "sweep/report/convergence_tables.hpp"
#include "sweep/report/influence_tables.hpp"
#include "sweep/study/estimators.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/model_influence.hpp"
#include "sweep/study/responses.hpp"
#include "tests/support/answered.hpp"
#include "tests/support/written.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::report_model_figures_test {

using namespace report;
using namespace study;

using store::Store;
using testing::Contains;
using testing::DoubleNear;
using testing::HasSubstr;
using testing::Not;

struct ModelFigures : testing::Test {
    Folder folder;
    Store store{folder / "a.db", Store::Mode::create};

    static std::string campaign_of(const std::string& design, const std::string& more = "") {
        return R"({"campaign": "c", "scene": "rehearsal",
            "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
            "design": )" +
               design + more + "}";
    }
    static std::string halton(int points) {
        return R"({"kind": "halton", "sequences": 8, "points": )" + std::to_string(points) + "}";
    }
    /// x1 + 2 x2 + 4 (x1 - 1/2)(x2 - 1/2): variances 1/12, 1/3 and 1/9; mean 3/2.
    static double response(const Inputs& inputs) {
        const double x1 = input(inputs, "x1"), x2 = input(inputs, "x2");
        return x1 + 2 * x2 + 4 * (x1 - 0.5) * (x2 - 0.5);
    }
    Responses responses() { return read_responses(store, store.campaigns().front()); }
    Estimators estimators() {
        const auto all = responses();
        return estimators_of(store, all, all.observable(""));
    }
};

constexpr double variance = 1.0 / 12 + 1.0 / 3 + 1.0 / 9;

TEST_F(ModelFigures, MomentsWithTheModelAreSharperAndHoldTheTruth) {
    answer_by(store, campaign_of(halton(104)), response);
    const auto found = estimators();
    ASSERT_TRUE(found.assisted) << found.refused;
    const auto& mean = found.assisted->of(stats::Statistic::mean);
    const auto& sd = found.assisted->of(stats::Statistic::sd);
    EXPECT_LT(mean.assisted.half_width, 0.5 * mean.plain.half_width);
    EXPECT_LT(sd.assisted.half_width, 0.5 * sd.plain.half_width);
    EXPECT_NEAR(mean.assisted.value, 1.5, 2 * mean.assisted.half_width);
    EXPECT_NEAR(sd.assisted.value, std::sqrt(variance), 2 * sd.assisted.half_width);
    EXPECT_TRUE(mean.takes_assisted);
    EXPECT_TRUE(found.scatter_from.empty());
    const auto all = responses();
    EXPECT_EQ(estimators_table(history_of(all, all.observable("")), found).columns.size(), 3U)
        << "without replicates the scatter is unknown";
}

TEST_F(ModelFigures, ReplicatesTellTheScatterWhichIsTakenOut) {
    constexpr double scatter = 0.3;
    answer_by(store, campaign_of(halton(128), R"(, "replicates": 2)"), [number = 0](const Inputs& inputs) mutable {
        return response(inputs) +
               scatter * std::sqrt(3.0) * (2 * stats::Stream(3, 0).uniform(static_cast<std::uint64_t>(++number)) - 1);
    });
    const auto found = estimators();
    ASSERT_TRUE(found.assisted) << found.refused;
    EXPECT_EQ(found.scatter_from, "replicates");
    const auto& sd = found.assisted->of(stats::Statistic::sd);
    EXPECT_NEAR(sd.without_scatter.value, std::sqrt(variance), 1.5 * sd.without_scatter.half_width);
    EXPECT_NEAR(sd.assisted.value, std::sqrt(variance + scatter * scatter), 1.5 * sd.assisted.half_width);
    EXPECT_NEAR(found.assisted->budget[0].scatter, scatter * scatter / (variance + scatter * scatter), 0.05);
}

TEST_F(ModelFigures, JsonHasBothAndNamesWhatIsThere) {
    answer_by(store, campaign_of(halton(104)), response);
    const auto all = responses();
    const auto history = history_of(all, all.observable(""));
    const auto json = tests::parsed(estimators_json(history, estimators()));
    for (const char* statistic : {"mean", "sd", "skewness", "g1", "kurtosis"})
        EXPECT_TRUE(json["plain"][statistic]["value"].is_number()) << statistic;
    for (const char* statistic : {"mean", "sd", "g1", "kurtosis"})
        EXPECT_TRUE(json["model_assisted"][statistic]["error"].is_number()) << statistic;
    EXPECT_EQ(json["model_assisted"]["mean"]["taken"], true);
    EXPECT_TRUE(json["without_scatter"].is_null());
    EXPECT_LT(json["model_error"], 0.1);
}

TEST_F(ModelFigures, EstimatesOfTwoPopulationsDifferWithoutAContradiction) {
    // A corner fails: the mean over the box, extrapolated into it, is 0.75; of the cases that answer it is 0.725.
    answer_by(store, campaign_of(halton(400)), [](const Inputs& inputs) -> std::optional<double> {
        const double x1 = input(inputs, "x1"), x2 = input(inputs, "x2");
        if (x1 > 0.8 && x2 > 0.8) return std::nullopt;
        return x1 + 0.5 * x2;
    });
    const auto found = estimators();
    ASSERT_TRUE(found.assisted) << found.refused;
    const auto& mean = found.assisted->of(stats::Statistic::mean);
    EXPECT_NEAR(mean.assisted.value, 0.75, 2 * mean.assisted.half_width + 1e-3);
    EXPECT_NEAR(mean.plain.value, 0.725, 2 * mean.plain.half_width);
    EXPECT_GT(mean.assisted.value - mean.plain.value, 2 * std::hypot(mean.assisted.half_width, mean.plain.half_width));
    EXPECT_FALSE(mean.withdrawn) << "both are right, of two populations";
    EXPECT_FALSE(mean.takes_assisted) << "convergence is judged on the cases with a value";
    EXPECT_THAT(found.assisted->remark,
                HasSubstr(" of the whole box is not taken: the " + std::to_string(found.assisted->cases) +
                          " of 400 cases with a value have "));
    EXPECT_THAT(found.assisted->remark, Not(HasSubstr("contradicts")));
    const auto all = responses();
    const auto history = history_of(all, all.observable(""));
    const auto table = estimators_table(history, found);
    const auto json = tests::parsed(estimators_json(history, found));
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
        const auto statistic = stats::assisted_statistics[k];
        const bool withdrawn = found.assisted->of(statistic).withdrawn;
        EXPECT_EQ(text_of(table.rows[k][2]).starts_with("withdrawn"), withdrawn);
        EXPECT_EQ(json["model_assisted"][std::string(to_string(statistic))]["withdrawn"], withdrawn);
    }
    EXPECT_THAT(estimator_lines(found), Contains(HasSubstr("of the whole box, extrapolated into the settings that")));
    EXPECT_THAT(json["population"].get<std::string>(), HasSubstr("of the cases that answer"));
    EXPECT_THAT(model_influence_lines(model_influence_of(all, all.observable(""))),
                Contains(HasSubstr("of the whole box, extrapolated into the settings that failed")));
}

TEST_F(ModelFigures, WhatTheConditionLeavesOutIsNotIntegratedOver) {
    // The mean over x1 < 1/2: 1/4 + 1.
    answer_by(store, campaign_of(halton(256), R"(, "where": "x1 < 0.5")"), response);
    const auto found = estimators();
    ASSERT_TRUE(found.assisted) << found.refused;
    const auto& mean = found.assisted->of(stats::Statistic::mean);
    EXPECT_NEAR(mean.assisted.value, 1.25, 2 * mean.assisted.half_width + 1e-3);
}

TEST_F(ModelFigures, MomentsAreRefusedByTheirReason) {
    answer_by(store, campaign_of(R"({"kind": "lattice", "levels": 12})"), response);
    const auto found = estimators();
    EXPECT_FALSE(found.assisted);
    EXPECT_THAT(found.refused, HasSubstr("4 independently randomised sequences"));
    const auto all = responses();
    const auto json = tests::parsed(estimators_json(history_of(all, all.observable("")), found));
    EXPECT_TRUE(json["model_assisted"].is_null());
    EXPECT_EQ(json["note"], found.refused);
}

TEST_F(ModelFigures, AConstantResponseIsRefused) {
    answer_by(store, campaign_of(halton(104)), [](const Inputs&) { return 3.0; });
    EXPECT_THAT(estimators().refused, HasSubstr("constant"));
    const auto all = responses();
    const auto influence = model_influence_of(all, all.observable(""));
    EXPECT_FALSE(influence.indices);
    EXPECT_THAT(model_influence_lines(influence).front(), HasSubstr("no indices from a response model"));
}

TEST_F(ModelFigures, TotalIndicesAndInteractionsFromAnySample) {
    answer_by(store, campaign_of(halton(160)), response);
    const auto all = responses();
    const auto influence = model_influence_of(all, all.observable(""));
    ASSERT_TRUE(influence.indices) << influence.refused;
    const double pair = 1.0 / 9 / variance;
    const auto& indices = *influence.indices;
    EXPECT_NEAR(indices.first[0].value, 1.0 / 12 / variance, 0.01);
    EXPECT_NEAR(indices.first[1].value, 1.0 / 3 / variance, 0.01);
    EXPECT_NEAR(indices.total[0].value, 1.0 / 12 / variance + pair, 0.01);
    EXPECT_NEAR(indices.total[1].value, 1.0 / 3 / variance + pair, 0.01);
    EXPECT_NEAR(indices.pairs[0].value, pair, 0.01);
    EXPECT_EQ(model_influence_table(influence).rows[0][0], store::Table::Cell("x2")) << "the most influential first";
    EXPECT_THAT(model_influence_lines(influence).front(), HasSubstr("interactions of pairs: x1 with x2 0.2"));
    const auto json = tests::parsed(model_influence_json(influence));
    EXPECT_EQ(json["factors"][0]["name"], "x1");
    EXPECT_EQ(json["pairs"][0]["factors"][1], "x2");
    EXPECT_TRUE(json["scatter_share"].is_number());
    EXPECT_TRUE(json["refused"].is_null());
}

TEST_F(ModelFigures, IndicesAreRefusedWhereAPartOfTheBoxIsLeftOut) {
    answer_by(store, campaign_of(halton(160), R"(, "where": "x1 < 0.5")"), response);
    const auto all = responses();
    EXPECT_THAT(model_influence_of(all, all.observable("")).refused, HasSubstr("leaves a part of the box out"));
}

}  // namespace grainsweep::tests::report_model_figures_test
