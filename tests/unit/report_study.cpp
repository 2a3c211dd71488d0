// The study: moments, verdicts and influences recomputed from stored answers, and what is said about them.
#include "sweep/campaign/input_error.hpp"
#include "sweep/report/convergence_tables.hpp"
#include "sweep/report/influence_tables.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/study/error_text.hpp"
#include "sweep/study/history.hpp"
#include "sweep/study/influence.hpp"
#include "tests/support/study.hpp"
#include "tests/support/written.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace grainsweep::tests::report_study_test {

using namespace report;
using namespace study;

using store::Store;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST_F(Study, ReadsFactorsAndResponsesInOrderOfThePoints) {
    answer_by(store, halton("c", 64), [](const Inputs& inputs) { return linear(inputs); });
    const auto responses = ask("c");
    ASSERT_EQ(responses.rows(), 64u);
    EXPECT_EQ(responses.settled, 64u);
    EXPECT_EQ(responses.settled_points, 64);
    ASSERT_EQ(responses.factors.size(), 2u);
    EXPECT_EQ(responses.factors[1].name, "x2");
    EXPECT_EQ(responses.factors[1].ends().second, 0.5);
    ASSERT_NE(responses.main_observable(), nullptr);
    EXPECT_EQ(responses.main_observable()->name, "y");
    for (std::size_t row = 0; row < 64; ++row) {
        const double x1 = responses.factors[0].values[row], x2 = responses.factors[1].values[row];
        EXPECT_DOUBLE_EQ(responses.main_observable()->values[row], 1 + 2 * x1 + 2 * x2);
        EXPECT_DOUBLE_EQ(responses.factors[1].coordinate(row), 2 * x2);
    }
}

TEST_F(Study, LevelsKeepTheOrderOfTheFile) {
    answer_by(store, R"({"campaign": "c", "scene": "rehearsal",
        "factors": [{"name": "response", "levels": ["sum", "ishigami", "g_function"]}, {"name": "x1", "levels": [0.5, 0.25]}],
        "design": {"kind": "lattice"}})",
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    const auto responses = ask("c");
    EXPECT_THAT(responses.factors[0].seen_texts(), ElementsAre("sum", "ishigami", "g_function"));
    EXPECT_THAT(responses.factors[1].seen_texts(), ElementsAre("0.5", "0.25"));
    EXPECT_THAT(responses.factors[0].values, ElementsAre(0, 0, 1, 1, 2, 2));
    EXPECT_EQ(factor_text(responses.factors[0], 3), "ishigami");
}

TEST_F(Study, OnlyAGaplessBeginningIsJudged) {
    answer_by(
        store, halton("c", 64), [](const Inputs& inputs) { return linear(inputs); }, 30);
    const auto responses = ask("c");
    EXPECT_EQ(responses.rows(), 64u);
    EXPECT_EQ(responses.settled, 30u);
    EXPECT_EQ(responses.settled_points, 30);
    const auto history = history_of(responses, responses.observable(""));
    EXPECT_EQ(history.all.count, 30);
    EXPECT_THAT(history.warnings, Contains(HasSubstr("34 of 64 cases are not settled")));
}

// Hundreds of cases may be finished while one of the first still runs: what they say is shown, and not judged.
TEST_F(Study, FinishedCasesBehindAnOpenOneGiveProvisionalFigures) {
    answer_by(store, halton("c", 640, R"(, "convergence": {"observable": "y"})"), linear, 640,
              [](const campaign::PlacedCase& placed) { return placed.point != 0 && placed.point % 3 != 1; });
    const auto responses = ask("c");
    EXPECT_EQ(responses.settled, 0u);
    const auto history = history_of(responses, responses.observable("y"));
    EXPECT_EQ(history.all.points, 0);
    ASSERT_TRUE(history.provisional);
    EXPECT_EQ(history.provisional->count, static_cast<std::int64_t>(responses.finished()));
    const auto& mean = history.provisional->of(stats::Statistic::mean);
    EXPECT_NEAR(mean.value, 2.5, 3 * mean.error);
    EXPECT_EQ(history.converged, std::optional(false));
    EXPECT_THAT(history.verdict, HasSubstr("not converged: first check at 80 points, 0 are settled"));
    EXPECT_THAT(history.warnings, Contains(HasSubstr("only the provisional figures include them")));

    const auto text = tests::text_of(report::closing_summary(store, "c", folder / "a.db", true));
    EXPECT_THAT(text, HasSubstr("provisional moments of all 426 finished cases"));
    EXPECT_THAT(text, Not(HasSubstr("moments over 0 points")));
    EXPECT_THAT(text, HasSubstr("largest"));
    const auto rows = provisional_rows(responses, responses.observable("y"), history);
    ASSERT_EQ(rows.rows.size(), 1u);
    EXPECT_EQ(rows.columns.back(), "provisional");
    EXPECT_EQ(text_of(rows.rows[0].back()), "1");
    const auto json = tests::parsed(to_json(responses, responses.observable("y"), history, {}));
    EXPECT_EQ(json["provisional"]["values"], 426);
    EXPECT_EQ(json["finished"], 426);
    EXPECT_EQ(json["converged"], false);
    const std::vector<report::PageSource> sources = {{&store, "a.db"}};
    const nlohmann::ordered_json page = tests::parsed(report::page_data(sources));
    const nlohmann::ordered_json& shown = page["campaigns"][0]["observables"][0]["history"];
    EXPECT_EQ(shown["provisional"]["count"], 426);
    EXPECT_EQ(shown["notes"].back().get<std::string>().rfind("provisional, over all finished cases (426 values)", 0),
              0u);
}

TEST_F(Study, WhereAllFinishedCasesAreSettledNothingIsProvisional) {
    answer_by(store, halton("c", 64), linear, 30);
    const auto responses = ask("c");
    EXPECT_FALSE(history_of(responses, responses.observable("y")).provisional);
}

TEST_F(Study, WhatTheConditionLeavesOutIsCounted) {
    answer_by(store, halton("c", 64, R"(, "where": "x1 < 0.5")"), linear, 20);
    const auto responses = ask("c");
    EXPECT_EQ(responses.candidates, 64);
    EXPECT_EQ(responses.dropped(), 64 - static_cast<std::int64_t>(responses.rows()));
    EXPECT_EQ(points_line(responses), "64 candidates, " + std::to_string(responses.dropped()) + " left out by where, " +
                                          std::to_string(responses.rows()) + " cases asked, 20 finished");
    EXPECT_THAT(tests::text_of(report::closing_summary(store, "c", folder / "a.db", true)),
                HasSubstr("where: 64 candidates"));
}

// A verdict needs one observable; it is the same without the others.
TEST_F(Study, OneObservableAloneGivesTheSameVerdict) {
    answer_by(store, halton("c", 640, R"(, "convergence": {"observable": "y", "tolerance": 0.05})"), linear, 500);
    const auto whole = ask("c");
    const auto alone = study::read_response(store, store.campaigns()[0], "y");
    const auto expected = history_of(whole, whole.observable("y")), found = history_of(alone, alone.observable("y"));
    EXPECT_EQ(found.verdict, expected.verdict);
    EXPECT_EQ(found.converged, expected.converged);
    EXPECT_EQ(found.checks.size(), expected.checks.size());
}

// A list is judged where its campaign gives a rule, as the run that follows it does.
TEST_F(Study, AListIsJudgedByARuleAndByNothingElse) {
    const auto list = [](const std::string& name, const std::string& more) {
        std::string rows;
        for (int k = 0; k < 64; ++k) rows += (k == 0 ? "[" : ", [") + std::to_string(0.5 + 0.4 * (k % 7 - 3) / 3) + "]";
        return R"({"campaign": ")" + name + R"(", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
            "design": {"kind": "list", "rows": [)" +
               rows + "]}" + more + "}";
    };
    const auto x1 = [](const Inputs& inputs) { return input(inputs, "x1"); };
    answer_by(store, list("plain", ""), x1);
    answer_by(store, list("ruled", R"(, "convergence": {"observable": "y", "rule": "any_change", "block": 16})"), x1);
    const auto plain = ask("plain"), ruled = ask("ruled");
    EXPECT_TRUE(history_of(plain, plain.observable("y")).checks.empty());
    EXPECT_EQ(history_of(ruled, ruled.observable("y")).checks.size(), 4u);
    EXPECT_THAT(history_of(ruled, ruled.observable("y")).warnings, Contains(HasSubstr("listed points are no sample")));
}

TEST_F(Study, ACampaignThatIsAskedForLessSaysSo) {
    answer_by(store, halton("c", 64), linear);
    answer_by(store, halton("c", 16), linear);
    const auto responses = ask("c");
    EXPECT_EQ(responses.rows(), 64u);
    EXPECT_EQ(responses.candidates, 64);
    EXPECT_THAT(history_of(responses, responses.observable("y")).warnings,
                Contains("asked now: 16 points x 1; stored: 64 points x 1; view and statistics use the stored cases"));
}

// The order of a lattice means nothing: every case with a final outcome counts, wherever the others lie.
TEST_F(Study, APartOfALatticeIsCounted) {
    const std::string text = R"({"campaign": "c", "scene": "rehearsal", "replicates": 2,
        "factors": [{"name": "x1", "levels": [0.2, 0.4, 0.6, 0.8]}], "design": {"kind": "lattice"}})";
    answer_by(
        store, text, [](const Inputs& inputs) { return input(inputs, "x1"); }, 8,
        [](const campaign::PlacedCase& placed) { return placed.replicate == 0 && placed.point != 1; });
    const auto responses = ask("c");
    EXPECT_EQ(responses.rows(), 8u);
    EXPECT_EQ(responses.settled, 3u);
    EXPECT_EQ(responses.counted_points(), 3);
    EXPECT_THAT(responses.judged(responses.observable("y")), ElementsAre(0.2, 0.6, 0.8));
    const auto history = history_of(responses, responses.observable("y"));
    EXPECT_EQ(history.all.count, 3);
    EXPECT_EQ(history.all.points, 3);
    EXPECT_EQ(responses.candidates, 4);
    EXPECT_THAT(history.warnings, Contains("5 of 8 cases are not settled"));
}

TEST_F(Study, AStoppedCampaignIsJudgedOnWhereItStopped) {
    answer_by(store, halton("c", 64), [](const Inputs& inputs) { return linear(inputs); });
    store.group([&] { store.stop("c", 40); });
    const auto responses = ask("c");
    EXPECT_EQ(responses.settled, 40u);
    EXPECT_EQ(responses.settled_points, 40);
    EXPECT_EQ(history_of(responses, responses.observable("y")).all.count, 40);
}

TEST_F(Study, MomentsOfAKnownResponseLieWithinTheirErrors) {
    answer_by(
        store,
        halton(
            "c", 1000,
            R"(, "convergence": {"observable": "y", "block": 400, "tolerance": 0.05, "gates": ["mean", "sd", "kurtosis"]})"),
        [](const Inputs& inputs) { return linear(inputs); });
    const auto responses = ask("c");
    const auto history = history_of(responses, responses.observable("y"));
    ASSERT_EQ(history.checks.size(), 2u);
    EXPECT_EQ(history.checks[1].points, 800);
    EXPECT_EQ(history.all.points, 1000);
    EXPECT_TRUE(history.has_rule);
    EXPECT_EQ(history.verdict.substr(0, 23), "converged at 800 points");
    // mean 2.5; variance 4/12 + 1/12; kurtosis of the sum 3 + (excess -1.2)(4^2 + 1)/25.
    const auto& mean = history.all.of(stats::Statistic::mean);
    const auto& sd = history.all.of(stats::Statistic::sd);
    const auto& kurtosis = history.all.of(stats::Statistic::kurtosis);
    EXPECT_NEAR(mean.value, 2.5, 3 * mean.error);
    EXPECT_NEAR(sd.value, std::sqrt(5.0 / 12), 3 * sd.error);
    EXPECT_NEAR(kurtosis.value, 3 - 1.2 * 17 / 25, 3 * kurtosis.error);
    EXPECT_LT(mean.error, 0.01);
    EXPECT_GT(mean.error, 0);

    const auto rows = checks_rows(responses, responses.observable("y"), history);
    ASSERT_EQ(rows.rows.size(), 3u);
    EXPECT_EQ(text_of(rows.rows[2][2]), "1000");
    ASSERT_EQ(rows.columns[15], "converged");
    EXPECT_EQ(text_of(rows.rows[2][15]), "0");  // no multiple of the block: shown, not judged
    EXPECT_EQ(text_of(rows.rows[1][15]), "1");
}

TEST_F(Study, ManyChecksAreThinnedForTheEyeAndKeptForPrograms) {
    answer_by(
        store,
        halton("c", 4004, R"(, "convergence": {"observable": "y", "block": 32, "tolerance": 0.1, "gates": ["mean"]})"),
        linear);
    const auto responses = ask("c");
    const auto history = history_of(responses, responses.observable("y"));
    ASSERT_EQ(history.checks.size(), 125u);
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    ASSERT_NE(converged, history.checks.end());
    const auto shown = checks_to_show(history, 20);
    EXPECT_LE(shown.size(), 22u);
    EXPECT_THAT(shown, Contains(&*converged));
    EXPECT_EQ(shown.back(), &history.all);
    EXPECT_EQ(shown[shown.size() - 2]->points, 4000);
    EXPECT_EQ(checks_rows(responses, responses.observable("y"), history).rows.size(), 126u);
}

TEST_F(Study, FailedCasesAreLeftOutCountedAndSaid) {
    answer_by(store, halton("c", 160), [](const Inputs& inputs) -> std::optional<double> {
        if (input(inputs, "x1") > 0.9) return std::nullopt;
        return linear(inputs);
    });
    const auto responses = ask("c");
    EXPECT_EQ(responses.settled, 160u);
    const auto& y = responses.observable("");
    const auto history = history_of(responses, y);
    const auto failed = std::ranges::count(responses.outcomes, std::optional(campaign::Outcome::unstable));
    ASSERT_GT(failed, 8);
    EXPECT_EQ(history.all.excluded, failed);
    EXPECT_EQ(history.all.count, 160 - failed);
    EXPECT_THAT(history.warnings, Contains(std::to_string(failed) + " of 160 cases have no value and are excluded"));
    const auto influence = influence_of(responses, y);
    EXPECT_EQ(influence.excluded, failed);
    EXPECT_THAT(influence.notes, Contains(HasSubstr("without a value are left out")));
    EXPECT_EQ(outcome_line(responses),
              std::to_string(160 - failed) + " completed, " + std::to_string(failed) + " unstable");
}

TEST_F(Study, WarnsOfRulesAndResponsesThatCannotBeTrusted) {
    answer_by(store, halton("eager", 64, R"(, "convergence": {"observable": "y", "rule": "any_change", "block": 32})"),
              [](const Inputs& inputs) { return input(inputs, "x1") < 0.5 ? 0 : 1 + input(inputs, "x1"); });
    auto responses = ask("eager");
    auto warnings = history_of(responses, responses.observable("y")).warnings;
    EXPECT_THAT(warnings, Contains(HasSubstr("any_change stops too early in about half")));
    EXPECT_THAT(warnings, Contains(HasSubstr("of the values are zero: the median jumps")));

    answer_by(store, R"({"campaign": "grid", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "design": {"kind": "lattice", "levels": 5}})",
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    responses = ask("grid");
    const auto history = history_of(responses, responses.observable("y"));
    EXPECT_THAT(history.warnings, Contains(HasSubstr("a lattice gives no errors")));
    EXPECT_TRUE(history.checks.empty());
    EXPECT_NEAR(history.all.of(stats::Statistic::mean).value, 0.5, 1e-15);
    EXPECT_TRUE(std::isnan(history.all.of(stats::Statistic::mean).error));
}

TEST_F(Study, LatticesAreComparedWithTheirSiblings) {
    const auto lattice = [](const std::string& name, int levels, const std::string& range) {
        return R"({"campaign": ")" + name + R"(", "scene": "rehearsal", "factors": [{"name": "x1", "between": )" +
               range + R"(}], "design": {"kind": "lattice", "levels": )" + std::to_string(levels) + "}}";
    };
    const auto x1 = [](const Inputs& inputs) { return input(inputs, "x1"); };
    answer_by(store, lattice("fine", 10, "[0, 1]"), x1);
    answer_by(store, lattice("coarse", 5, "[0, 1]"), x1);
    answer_by(store, lattice("elsewhere", 5, "[0, 0.5]"), x1);
    const auto responses = ask("fine");
    const auto steps = lattice_family(store, responses, responses.observable("y"));
    ASSERT_EQ(steps.size(), 2u);
    EXPECT_EQ(steps[0].campaign, "coarse");
    EXPECT_EQ(steps[1].campaign, "fine");
    EXPECT_TRUE(std::isnan(steps[0].changes[0]));
    // An endpoint lattice overestimates the spread by sqrt((k + 1)/(k - 1)).
    const double coarse = std::sqrt(6.0 / 4), fine = std::sqrt(11.0 / 9);
    EXPECT_NEAR(steps[1].changes[1], (coarse - fine) / fine, 1e-12);
    const auto alone = ask("elsewhere");
    EXPECT_TRUE(lattice_family(store, alone, alone.observable("y")).empty());
}

TEST_F(Study, UnknownNamesGetTheNearestRightWord) {
    answer_by(store, halton("spread", 16), [](const Inputs& inputs) { return linear(inputs); });
    try {
        (void)study::find_campaigns(store, "sprad");
        FAIL();
    } catch (const campaign::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("Did you mean 'spread'?"));
    }
    const auto responses = ask("spread");
    try {
        (void)responses.observable("yy");
        FAIL();
    } catch (const campaign::InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("Did you mean 'y'?"));
    }
    Store empty(folder / "empty.db", Store::Mode::create);
    EXPECT_THROW((void)study::find_campaigns(empty, ""), campaign::InputError);
}

TEST_F(Study, ExtremesHaveUnits) {
    answer_by(store, R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "wait_seconds", "between": [0, 1]},
        {"name": "x1", "between": [0, 1]}], "design": {"kind": "halton", "points": 8}})",
              [](const Inputs& inputs) { return input(inputs, "x1"); });
    const auto responses = ask("c");
    EXPECT_THAT(extremes_table(responses, responses.observable("y"), 3).columns,
                ElementsAre("", "point", "wait_seconds (s)", "x1", "y", "case_id"));
}

TEST_F(Study, TheRunEndsWithCountsMomentsExtremesAndThePlace) {
    answer_by(store, halton("c", 64), [](const Inputs& inputs) { return linear(inputs); });
    const auto text = tests::text_of(report::closing_summary(store, "c", folder / "a.db", true));
    EXPECT_THAT(text, HasSubstr("c: 64 cases of rehearsal: 64 completed"));
    EXPECT_THAT(text, HasSubstr("largest"));
    EXPECT_THAT(text, HasSubstr("smallest"));
    EXPECT_THAT(text, HasSubstr("±"));
    EXPECT_THAT(text, HasSubstr((folder / "a.db").string()));

    const auto responses = ask("c");
    const auto& y = responses.observable("y");
    const auto table = extremes_table(responses, y, 3);
    ASSERT_EQ(table.rows.size(), 6u);
    const auto at = [&](const char* column, std::size_t row) {
        return table
            .rows[row][static_cast<std::size_t>(std::ranges::find(table.columns, column) - table.columns.begin())];
    };
    EXPECT_EQ(std::get<double>(at("y", 0)), *std::ranges::max_element(y.values));
    EXPECT_EQ(std::get<double>(at("y", 5)), *std::ranges::min_element(y.values));
    const auto largest = static_cast<std::size_t>(std::ranges::max_element(y.values) - y.values.begin());
    EXPECT_EQ(std::get<std::string>(at("case_id", 0)), responses.case_ids[largest]);
    EXPECT_EQ(moments_table(responses).rows.size(), 1u);
}

TEST(Figures, ErrorsHaveTwoDigitsAndValuesTheirPlace) {
    EXPECT_EQ(study::with_error(0.270150, 0.00112), "0.2702 ± 0.0011");
    EXPECT_EQ(study::with_error(-12.34, 3.21), "-12.3 ± 3.2");
    EXPECT_EQ(study::with_error(12345.6, 321), "12346 ± 321");
    EXPECT_EQ(study::with_error(3.21e-7, 4.4e-9), "(3.210 ± 0.044)e-7");
    EXPECT_EQ(study::with_error(0, 0.5), "0.00 ± 0.50");
    EXPECT_EQ(study::with_error(1.5, none), "1.5");
    EXPECT_EQ(study::with_error(1.5, 0), "1.5 ± 0");
    EXPECT_EQ(study::with_error(none, 1), "-");
}

}  // namespace grainsweep::tests::report_study_test
