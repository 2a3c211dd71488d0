// The study: moments, verdicts and influences recomputed from stored answers, and what is said about them.
#include "stats/random.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/report/effects.hpp"
#include "sweep/report/history.hpp"
#include "sweep/report/influence.hpp"
#include "sweep/report/page.hpp"
#include "sweep/report/study_tables.hpp"
#include "sweep/report/summary.hpp"
#include "tests/support/answered.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace grainsweep::tests {
using namespace report;

namespace {

using report::Responses;
using store::Store;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::string halton(const std::string& name, int points, const std::string& more = "") {
    return R"({"campaign": ")" + name + R"(", "scene": "rehearsal",
        "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 0.5]}],
        "design": {"kind": "halton", "sequences": 8, "points": )" +
           std::to_string(points) + "}" + more + "}";
}

/// First-order indices 0.8 and 0.2 (x2 spans half of its unit): V = 4 a^2/12 + a^2/12 with 2 x1 and 2 x2.
double linear(const Inputs& inputs) {
    return 1 + 2 * input(inputs, "x1") + 2 * input(inputs, "x2");
}

struct Study : testing::Test {
    Folder folder;
    Store store{folder / "a.db", Store::Mode::create};

    Responses ask(const std::string& name) {
        return report::read_responses(store, report::find_campaigns(store, name).front());
    }
};

TEST_F(Study, ReadsFactorsAndResponsesInOrderOfThePoints) {
    answer_by(store, halton("c", 64), [](const Inputs& inputs) { return linear(inputs); });
    const auto responses = ask("c");
    ASSERT_EQ(responses.rows(), 64u);
    EXPECT_EQ(responses.settled, 64u);
    EXPECT_EQ(responses.settled_points, 64);
    ASSERT_EQ(responses.factors.size(), 2u);
    EXPECT_EQ(responses.factors[1].name, "x2");
    EXPECT_EQ(responses.factors[1].high, 0.5);
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
    EXPECT_THAT(responses.factors[0].levels, ElementsAre("sum", "ishigami", "g_function"));
    EXPECT_THAT(responses.factors[1].levels, ElementsAre("0.5", "0.25"));
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
    EXPECT_THAT(history.warnings, Contains(HasSubstr("they count in the provisional figures only")));

    const auto text = report::closing_summary(store, "c", folder / "a.db");
    EXPECT_THAT(text, HasSubstr("provisional moments over all 426 finished cases"));
    EXPECT_THAT(text, Not(HasSubstr("moments over 0 points")));
    EXPECT_THAT(text, HasSubstr("largest"));
    const auto rows = provisional_rows(responses, responses.observable("y"), history);
    ASSERT_EQ(rows.rows.size(), 1u);
    EXPECT_EQ(rows.columns.back(), "provisional");
    EXPECT_EQ(text_of(rows.rows[0].back()), "1");
    const auto json = to_json(responses, responses.observable("y"), history, {});
    EXPECT_EQ(json["provisional"]["values"], 426);
    EXPECT_EQ(json["finished"], 426);
    EXPECT_EQ(json["converged"], false);
    const std::vector<report::PageSource> sources = {{&store, "a.db"}};
    const nlohmann::ordered_json page = report::page_data(sources);
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
    EXPECT_THAT(report::closing_summary(store, "c", folder / "a.db"), HasSubstr("where: 64 candidates"));
}

// A verdict needs one observable; it is the same without the others.
TEST_F(Study, OneObservableAloneGivesTheSameVerdict) {
    answer_by(store, halton("c", 640, R"(, "convergence": {"observable": "y", "tolerance": 0.05})"), linear, 500);
    const auto whole = ask("c");
    const auto alone = report::read_response(store, store.campaigns()[0], "y");
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
    EXPECT_THAT(
        history_of(responses, responses.observable("y")).warnings,
        Contains("asked now: 16 points x 1; stored: 64 points x 1: view and statistics are over what is stored"));
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
    EXPECT_THAT(history.warnings, Contains(std::to_string(failed) + " of 160 cases have no value and are left out"));
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
    EXPECT_THAT(history.warnings, Contains(HasSubstr("a lattice has no errors")));
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

TEST_F(Study, SharesOfTheVarianceFromAnyDesign) {
    answer_by(store, halton("c", 1600), [](const Inputs& inputs) { return linear(inputs); });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(influence.method, report::Influence::Method::given_data);
    EXPECT_EQ(influence.factors[0].bins, 16u);
    EXPECT_EQ(influence.used, 1600);
    EXPECT_NEAR(influence.factors[0].first.value, 0.8, 0.01);
    EXPECT_NEAR(influence.factors[1].first.value, 0.2, 0.01);
    EXPECT_GT(influence.factors[0].first.half_width, 0);
    EXPECT_LT(influence.factors[0].first.half_width, 0.05);
    const auto table = influence_table(influence);
    EXPECT_EQ(text_of(table.rows[0][0]), "x1");
}

TEST_F(Study, ALatticeTellsItsIndicesLineByLine) {
    answer_by(store, R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}], "design": {"kind": "lattice", "levels": 7}})",
              [](const Inputs& inputs) { return std::abs(input(inputs, "x1") - 0.5) + 0.01 * input(inputs, "x2"); });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(influence.factors[0].bins, 7u);
    // An additive response: the indices are shares of the lattice's own variance and add up to 1.
    EXPECT_NEAR(influence.factors[0].first.value + influence.factors[1].first.value, 1, 1e-12);
    EXPECT_GT(influence.factors[0].first.value, 0.99);
    EXPECT_TRUE(std::isnan(influence.factors[0].first.half_width));
}

TEST_F(Study, TotalIndicesFromSaltelliAndElementaryEffectsFromMorris) {
    const std::string factors = R"("scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 0.5]}], )";
    answer_by(store, R"({"campaign": "s", )" + factors + R"("design": {"kind": "saltelli", "base_points": 512}})",
              [](const Inputs& inputs) { return input(inputs, "x1") * input(inputs, "x2"); });
    auto responses = ask("s");
    const auto saltelli = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(saltelli.method, report::Influence::Method::saltelli);
    EXPECT_EQ(saltelli.used, 512);
    // y = u1 u2 / 2: both first-order indices 3/7, both total indices 4/7.
    for (const auto& factor : saltelli.factors) {
        EXPECT_NEAR(factor.first.value, 3.0 / 7, 0.02) << factor.factor;
        EXPECT_NEAR(factor.first_saltelli.value, 3.0 / 7, 0.06) << factor.factor;
        EXPECT_NEAR(factor.total.value, 4.0 / 7, 0.03) << factor.factor;
    }

    EXPECT_THAT(saltelli.notes, Contains(HasSubstr("every total index holds the scatter of single runs")));

    answer_by(store, R"({"campaign": "m", )" + factors + R"("design": {"kind": "morris", "trajectories": 12}})",
              [](const Inputs& inputs) { return linear(inputs); });
    responses = ask("m");
    const auto morris = influence_of(responses, responses.observable("y"));
    EXPECT_EQ(morris.method, report::Influence::Method::morris);
    ASSERT_TRUE(morris.factors[0].effects && morris.factors[1].effects);
    EXPECT_EQ(morris.used, 12);
    EXPECT_NEAR(morris.factors[0].effects->mu_star, 2, 1e-12);  // per unit of the range
    EXPECT_NEAR(morris.factors[1].effects->mu_star, 1, 1e-12);
    EXPECT_NEAR(morris.factors[1].effects->sigma, 0, 1e-12);
}

TEST_F(Study, UnknownNamesGetTheNearestRightWord) {
    answer_by(store, halton("spread", 16), [](const Inputs& inputs) { return linear(inputs); });
    try {
        (void)report::find_campaigns(store, "sprad");
        FAIL();
    } catch (const campaign::WrongQuestion& error) {
        EXPECT_THAT(error.what(), HasSubstr("Did you mean 'spread'?"));
    }
    const auto responses = ask("spread");
    try {
        (void)responses.observable("yy");
        FAIL();
    } catch (const campaign::WrongQuestion& error) {
        EXPECT_THAT(error.what(), HasSubstr("Did you mean 'y'?"));
    }
    Store empty(folder / "empty.db", Store::Mode::create);
    EXPECT_THROW((void)report::find_campaigns(empty, ""), campaign::WrongQuestion);
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
    const auto text = report::closing_summary(store, "c", folder / "a.db");
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
    EXPECT_EQ(report::with_error(0.270150, 0.00112), "0.2702 ± 0.0011");
    EXPECT_EQ(report::with_error(-12.34, 3.21), "-12.3 ± 3.2");
    EXPECT_EQ(report::with_error(12345.6, 321), "12346 ± 321");
    EXPECT_EQ(report::with_error(3.21e-7, 4.4e-9), "(3.210 ± 0.044)e-7");
    EXPECT_EQ(report::with_error(0, 0.5), "0.00 ± 0.50");
    EXPECT_EQ(report::with_error(1.5, none), "1.5");
    EXPECT_EQ(report::with_error(1.5, 0), "1.5 ± 0");
    EXPECT_EQ(report::with_error(none, 1), "-");
}

TEST(Effects, HistogramHoldsEveryFiniteValue) {
    std::vector<double> values = {none, 1, 2, 2, 3, 5, std::numeric_limits<double>::infinity()};
    const auto histogram = report::histogram_of(values);
    EXPECT_EQ(histogram.low, 1);
    EXPECT_EQ(histogram.high, 5);
    EXPECT_EQ(std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::int64_t{0}), 5);
    EXPECT_EQ(histogram.counts.back(), 1);
    EXPECT_THAT(report::histogram_of(std::vector<double>(4, 7.0)).counts, ElementsAre(4));
    EXPECT_TRUE(report::histogram_of(std::vector<double>{none}).counts.empty());
}

TEST(Effects, BinsHoldEqualCountsAndLevelsAreBins) {
    report::FactorColumn factor;
    std::vector<double> response;
    for (int i = 0; i < 320; ++i) {
        factor.values.push_back(i / 320.0);
        response.push_back(3 * i / 320.0);
    }
    response[7] = none;
    report::EffectErrors errors;
    errors.source = report::EffectErrors::Source::parts;
    for (int i = 0; i < 320; ++i) errors.parts.push_back(static_cast<std::size_t>(i % 8));
    const auto effect = main_effect(factor, response, errors);
    ASSERT_EQ(effect.size(), 16u);
    std::int64_t total = 0;
    for (const auto& bin : effect) {
        EXPECT_NEAR(bin.mean, 3 * bin.at, 1e-12);
        EXPECT_GT(bin.error, 0);
        total += bin.count;
    }
    EXPECT_EQ(total, 319);

    factor.levels = {"a", "b"};
    for (std::size_t i = 0; i < factor.values.size(); ++i) factor.values[i] = i % 2 == 0 ? 0 : 1;
    const auto levels = main_effect(factor, response, errors);
    ASSERT_EQ(levels.size(), 2u);
    EXPECT_EQ(levels[1].at, 1);
    EXPECT_EQ(levels[0].count, 160);
    EXPECT_EQ(levels[1].count, 159);
}

/// A uniform disturbance of the case, of standard deviation sigma: what a scene's own random numbers do.
std::optional<double> disturbed(double y, double sigma, std::uint64_t salt, std::uint64_t count) {
    const double u = stats::Stream(salt, count).uniform(0);
    return y + sigma * std::sqrt(12.0) * (u - 0.5);
}

std::string lattice(const std::string& name, int replicates) {
    return R"({"campaign": ")" + name + R"(", "scene": "rehearsal", "replicates": )" + std::to_string(replicates) +
           R"(, "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
        "design": {"kind": "lattice", "levels": [2, 5]}})";
}

// Two levels of a share that the other factor moves from 0 to 1: the values at a level differ by that factor, which is
// no error of their mean.
TEST_F(Study, MainEffectsOfALatticeOfSingleRunsHaveNoWhiskers) {
    answer_by(store, lattice("c", 1), [](const Inputs& inputs) { return input(inputs, "x2"); });
    const auto responses = ask("c");
    const auto& y = responses.observable("y");
    const auto errors = effect_errors(responses, y);
    EXPECT_EQ(errors.source, report::EffectErrors::Source::none);
    EXPECT_THAT(errors.says, HasSubstr("a lattice of single runs gives no error; replicates would"));
    for (const auto& bin : main_effect(responses.factors[0], responses.judged(y), errors)) {
        EXPECT_DOUBLE_EQ(bin.mean, 0.5);
        EXPECT_TRUE(std::isnan(bin.error));
    }
}

TEST_F(Study, MainEffectsOfAReplicatedLatticeHaveTheErrorOfTheirScatter) {
    constexpr double sigma = 0.05;
    std::uint64_t count = 0;
    int covered = 0, bins = 0;
    for (int k = 0; k < 40; ++k) {
        const auto name = "c" + std::to_string(k);
        answer_by(store, lattice(name, 3).insert(1, R"("seed": )" + std::to_string(k + 1) + ", "),
                  [&](const Inputs& inputs) { return disturbed(input(inputs, "x2"), sigma, 5, ++count); });
        const auto responses = ask(name);
        const auto& y = responses.observable("y");
        const auto errors = effect_errors(responses, y);
        EXPECT_EQ(errors.pure.freedom, 20);  // 10 points, 3 runs each
        EXPECT_THAT(errors.says, HasSubstr("pure error, 20 degrees of freedom"));
        for (const auto& bin : main_effect(responses.factors[0], responses.judged(y), errors)) {
            EXPECT_EQ(bin.count, 15);
            EXPECT_NEAR(bin.error, 2.086 * std::sqrt(errors.pure.variance / 15), 1e-4);
            covered += std::abs(bin.mean - 0.5) <= bin.error;
            ++bins;
        }
    }
    EXPECT_EQ(bins, 80);
    EXPECT_GE(covered, 70);  // 95 % of 80 is 76, three standard errors are 5.8
}

TEST_F(Study, MainEffectsOfASampleCoverTheTruthAsOftenAsTheySay) {
    // y = x1 + 2 x2 + 0.5 over x2 in [0, 0.5]: in a bin of x1 the mean is x1 + 1.
    int covered = 0, bins = 0;
    for (int k = 0; k < 12; ++k) {
        const auto name = "c" + std::to_string(k);
        answer_by(store, halton(name, 320, R"(, "seed": )" + std::to_string(k + 1)),
                  [](const Inputs& inputs) { return input(inputs, "x1") + 2 * input(inputs, "x2") + 0.5; });
        const auto responses = ask(name);
        const auto& y = responses.observable("y");
        for (const auto& bin : main_effect(responses.factors[0], responses.judged(y), effect_errors(responses, y))) {
            covered += std::abs(bin.mean - bin.at - 1) <= bin.error;
            ++bins;
        }
    }
    EXPECT_EQ(bins, 192);
    EXPECT_GE(covered, 173);  // 95 % less three standard errors
}

TEST_F(Study, AWhiskerNeedsFourPartsOfTheSample) {
    answer_by(store, halton("c", 16), [](const Inputs& inputs) { return linear(inputs); });
    auto responses = ask("c");
    const auto& y = responses.observable("y");
    const auto errors = effect_errors(responses, y);
    auto& factor = responses.factors[0];
    factor.levels = {"a", "b"};
    for (std::size_t row = 0; row < 16; ++row) factor.values[row] = row < 3 ? 0 : 1;
    const auto bins = main_effect(factor, responses.judged(y), errors);
    EXPECT_TRUE(std::isnan(bins[0].error));
    EXPECT_GT(bins[1].error, 0);
}

TEST_F(Study, SensitivityTellsInteractionFromScatterWhereReplicatesAllow) {
    std::uint64_t count = 0;
    const auto response = [&](const Inputs& inputs) {  // V: 1/12 + 1/12 + 1/144 x 12 of interaction + 1/12 of scatter
        const double a = input(inputs, "x1") - 0.5, b = input(inputs, "x2") - 0.5;
        return disturbed(a - b + std::sqrt(12.0) * a * b, std::sqrt(1.0 / 12), 3, ++count);
    };
    const std::string text = R"({"campaign": "twice", "scene": "rehearsal", "replicates": 2,
        "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
        "design": {"kind": "halton", "sequences": 8, "points": 1200}})";
    answer_by(store, text, response);
    auto responses = ask("twice");
    auto influence = influence_of(responses, responses.observable("y"));
    EXPECT_NEAR(influence.split.main_effects.value, 0.5, 2 * influence.split.main_effects.half_width);
    EXPECT_NEAR(influence.split.interactions.value, 0.25, 2 * influence.split.interactions.half_width);
    EXPECT_NEAR(influence.split.scatter.value, 0.25, 2 * influence.split.scatter.half_width);
    EXPECT_LT(influence.split.interactions.half_width, 0.06);
    EXPECT_THAT(unexplained_text(influence), HasSubstr("pure error of 1200 degrees of freedom"));

    std::string once = text;
    once.replace(once.find("twice"), 5, "once");
    once.erase(once.find(R"("replicates": 2,)"), 16);
    answer_by(store, once, response);
    responses = ask("once");
    influence = influence_of(responses, responses.observable("y"));
    EXPECT_TRUE(std::isnan(influence.split.scatter.value));
    EXPECT_NEAR(influence.split.unexplained.value, 0.5, 2 * influence.split.unexplained.half_width);
    EXPECT_THAT(unexplained_text(influence), HasSubstr("replicates would tell these apart"));
    const auto json = to_json(responses, responses.observable("y"), influence);
    EXPECT_TRUE(json["variance"]["scatter"]["value"].is_null());
    EXPECT_GT(json["variance"]["unexplained"]["error"], 0);
}

TEST_F(Study, TrendsSayWhichWayTheResponseGoes) {
    const std::string text = R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]},
        {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]}, {"name": "x4", "between": [0, 1]},
        {"name": "response", "levels": ["sum", "ishigami"]}], "design": {"kind": "halton", "sequences": 8, "points": 800}})";
    answer_by(store, text, [](const Inputs& inputs) {
        return input(inputs, "x1") - 2 * input(inputs, "x2") + 8 * std::pow(input(inputs, "x3") - 0.5, 2);
    });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    const auto trend = [&](std::size_t j) { return std::string(to_string(influence.factors[j].trend)); };
    EXPECT_EQ(trend(0), "rises");
    EXPECT_EQ(trend(1), "falls");
    EXPECT_EQ(trend(2), "bends");
    EXPECT_EQ(trend(3), "");
    EXPECT_EQ(trend(4), "");
    EXPECT_GT(influence.factors[0].rank_correlation.value, 0.2);
    EXPECT_LT(influence.factors[1].rank_correlation.value, -0.5);
    EXPECT_NEAR(influence.factors[2].rank_correlation.value, 0, 2 * influence.factors[2].rank_correlation.half_width);
    EXPECT_TRUE(std::isnan(influence.factors[4].rank_correlation.value));
    const auto table = influence_table(influence);
    EXPECT_THAT(table.columns, ElementsAre("factor", "first order", "trend", "rank correlation"));
}

// Listed points are no sample: whiskers come from replicates alone.
TEST_F(Study, AListedCampaignHasItsVarianceExplained) {
    std::string rows;
    for (int i = 0; i < 40; ++i)
        rows += (i == 0 ? "[" : ", [") + std::to_string(i % 8 / 8.0) + ", " + std::to_string(i / 40.0) + "]";
    answer_by(
        store,
        R"({"campaign": "c", "scene": "rehearsal", "replicates": 2, "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
        "design": {"kind": "list", "rows": [)" +
            rows + "]}}",
        [](const Inputs& inputs) { return input(inputs, "x1") - 3 * input(inputs, "x2"); });
    const auto responses = ask("c");
    const auto& y = responses.observable("y");
    const auto influence = influence_of(responses, y);
    EXPECT_NEAR(influence.split.main_effects.value, 1, 1e-6);
    EXPECT_EQ(influence.split.pure.variance, 0);
    EXPECT_EQ(effect_errors(responses, y).source, report::EffectErrors::Source::pure_error);
}

// A weak straight effect under much scatter has binned means that go up and down: no bend.
TEST_F(Study, ScatterOfBinnedMeansIsNoBend) {
    std::uint64_t count = 0;
    const auto straight = [&](const Inputs& inputs) { return disturbed(0.5 * input(inputs, "x1"), 0.4, 21, ++count); };
    for (int k = 0; k < 10; ++k) {
        const auto name = "c" + std::to_string(k);
        answer_by(store, halton(name, 640, R"(, "seed": )" + std::to_string(k + 1)), straight);
        const auto responses = ask(name);
        EXPECT_EQ(influence_of(responses, responses.observable("y")).factors[0].trend, report::Trend::rises) << name;
    }
}

TEST_F(Study, AReplicatedLatticeHasErrorsOfItsIndices) {
    std::uint64_t count = 0;
    answer_by(store, R"({"campaign": "c", "scene": "rehearsal", "replicates": 4, "factors": [
        {"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}], "design": {"kind": "lattice", "levels": 6}})",
              [&](const Inputs& inputs) { return disturbed(input(inputs, "x1"), 0.2, 9, ++count); });
    const auto responses = ask("c");
    const auto influence = influence_of(responses, responses.observable("y"));
    const double signal = 7.0 / 60;  // variance of six steps from 0 to 1
    const auto& x1 = influence.factors[0].first;
    const auto& x2 = influence.factors[1].first;
    EXPECT_NEAR(x1.value, signal / (signal + 0.04), 2 * x1.half_width);
    EXPECT_NEAR(x2.value, 0, 2 * x2.half_width);
    EXPECT_LT(x1.half_width, 0.1);
    EXPECT_LT(x2.half_width, 0.05);
    EXPECT_THAT(influence.notes, Contains(HasSubstr("pure error, 108 degrees of freedom")));
    EXPECT_EQ(influence.factors[0].trend, report::Trend::rises);
    EXPECT_THAT(unexplained_text(influence), HasSubstr("interactions indistinguishable from zero"));
}

}  // namespace
}  // namespace grainsweep::tests
