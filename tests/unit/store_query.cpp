// The views keep the contract's columns, a query only reads, the statistics agree with their definitions.
#include "sweep/campaign/input_error.hpp"
#include "tests/support/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::tests::store_query_test {

using store::Store;
using testing::ElementsAre;
using testing::HasSubstr;

struct StoreQuery : testing::Test {
    Folder folder;
    std::filesystem::path file = folder / "a.db";
    campaign::Campaign asked = small_campaign("first");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 8);
    Store store{file, Store::Mode::create};

    StoreQuery() { store.enrol(asked, cases, here()); }
    std::string refusal(std::string_view sql) {
        try {
            (void)store.query(sql);
        } catch (const campaign::InputError& wrong) {
            return wrong.what();
        }
        return "answered";
    }
};

TEST_F(StoreQuery, TimeAndMemoryAreLimited) {
    const auto limited = [&](std::string_view sql, const Store::QueryLimits& limits) {
        std::int64_t rows = 0;
        try {
            store.query(
                sql, limits, [](const auto&) {}, [&](const auto&) { ++rows; });
        } catch (const campaign::InputError& wrong) {
            return std::string(wrong.what());
        }
        return std::to_string(rows) + " rows";
    };
    const std::string endless = "WITH RECURSIVE n (k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM n) SELECT ";
    EXPECT_THAT(limited(endless + "count(*) FROM n", {.seconds = 0.05}), HasSubstr("takes too long"));
    EXPECT_THAT(limited("SELECT group_concat(format('%1000d', k)) FROM (" + endless + "k FROM n LIMIT 100000)",
                        {.seconds = 30, .bytes = 32 << 20}),
                HasSubstr("more than 32 MiB of memory"));
    EXPECT_EQ(limited(endless + "k FROM n LIMIT 200000", {.seconds = 30, .bytes = 32 << 20}), "200000 rows");
    EXPECT_EQ(limited("SELECT * FROM first", {.seconds = 0.05, .bytes = 32 << 20}), "8 rows") << "and goes on as ever";
    settle(store, cases[0].question, 1);
}

TEST_F(StoreQuery, AViewOfTheCampaignsNameHasTheColumnsOfTheContract) {
    settle(store, cases[4].question, 1);
    const auto table = store.query("SELECT * FROM first ORDER BY point");
    EXPECT_THAT(table.columns, ElementsAre("point", "sequence", "replicate", "case_id", "seed", "outcome", "attempts",
                                           "wall_seconds", "x1", "x2", "y"));
    ASSERT_EQ(table.rows.size(), 8u);
    EXPECT_EQ(std::get<std::string>(table.rows[4][3]), cases[4].question.id);
    EXPECT_EQ(std::get<std::int64_t>(table.rows[4][4]), static_cast<std::int64_t>(cases[4].question.seed));
    EXPECT_EQ(std::get<std::string>(table.rows[4][5]), "completed");
    EXPECT_EQ(std::get<std::int64_t>(table.rows[4][6]), 1);
    EXPECT_EQ(std::get<double>(table.rows[4][7]), 0.25);
    EXPECT_EQ(std::get<double>(table.rows[4][8]), std::get<double>(cases[4].question.inputs.at("x1")));
    EXPECT_EQ(std::get<double>(table.rows[4][10]), answer(cases[4].question, 1).observations.scalars.at("y"));
    for (const std::size_t hole : {5u, 7u, 10u}) EXPECT_EQ(text_of(table.rows[3][hole]), "NULL");
}

// Without the index every case of the view was compared with every place of the campaign.
TEST_F(StoreQuery, AJoinOfACampaignWithSeriesLooksEachCaseUp) {
    for (const char* join : {"ON s.case_id = c.case_id",
                             "ON s.point = c.point AND s.replicate = c.replicate AND "
                             "s.campaign = 'first'",
                             "ON s.campaign = 'first' AND s.point = c.point"}) {
        const auto plan =
            store.query("EXPLAIN QUERY PLAN SELECT * FROM first AS c JOIN series AS s " + std::string(join));
        int scans = 0;
        bool of_places = false;
        for (const auto& row : plan.rows) {
            const auto step = text_of(row.back());
            scans += step.find("SCAN") == std::string::npos ? 0 : 1;
            // One search by the campaign alone is the loop over the view; a second one inside it is the defect.
            const bool all_places = step.find("SEARCH p USING PRIMARY KEY (campaign_id=?)") != std::string::npos;
            EXPECT_FALSE(all_places && of_places) << join;
            of_places = of_places || all_places;
        }
        EXPECT_LE(scans, 1) << join;
    }
}

TEST_F(StoreQuery, AFactorAtItsDefaultIsShown) {
    auto second = small_campaign("second", 3);
    second.space.factors[2] = {"response", campaign::Levels{{std::string("sum"), std::string("ishigami")}}};
    Inputs inputs = second.scene().defaults();
    store.enrol(second, std::vector{campaign::PlacedCase{question(second, inputs, 0), 0, 0, 0}}, here());
    const auto row = store.query("SELECT x1, x2, response, typeof(x1) FROM second").rows.at(0);
    EXPECT_EQ(text_of(row[0]), "0.5");
    EXPECT_EQ(text_of(row[2]), "sum");
    EXPECT_EQ(text_of(row[3]), "real");
}

TEST_F(StoreQuery, NamesThatMeetInAViewAreToldApart) {
    SceneInfo scene = asked.scene();
    scene.name = "twins";
    scene.parameters[0].name = "seed";
    scene.parameters[1].name = "y";
    campaign::Campaign twins = asked;
    twins.name = "twins_campaign";
    twins.space.scene = unowned(scene);
    twins.space.factors[0].name = "seed";
    twins.space.factors[1].name = "y";
    store.enrol(twins, {}, here());
    const auto columns = store.query("SELECT * FROM twins_campaign").columns;
    EXPECT_THAT(std::vector(columns.begin() + 8, columns.end()), ElementsAre("seed_input", "y", "y_observed"));
}

TEST_F(StoreQuery, TheFixedViewsHaveTheColumnsOfTheContract) {
    auto given = answer(cases[1].question, 1);
    given.observations.series["y_series"] = {{.time = 0.5, .bin = NAN, .value = 2}};
    store.group([&] {
        store.begin(given.attempt);
        store.finish(given);
    });
    const auto series = store.query("SELECT * FROM series");
    EXPECT_THAT(series.columns,
                ElementsAre("campaign", "point", "replicate", "case_id", "observable", "time", "bin", "value"));
    ASSERT_EQ(series.rows.size(), 1u);
    EXPECT_EQ(text_of(series.rows[0][4]), "y_series");
    EXPECT_EQ(text_of(series.rows[0][6]), "NULL");
    EXPECT_THAT(
        store.query("SELECT * FROM convergence_history").columns,
        ElementsAre("campaign", "observable", "points", "mean", "sd", "skewness", "g1", "kurtosis", "mean_error",
                    "sd_error", "skewness_error", "g1_error", "kurtosis_error", "zero_share", "excluded", "converged"));
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM inputs WHERE case_id = '" + cases[1].question.id + "'"), "21");
    const auto tables = store.query("SELECT name FROM sqlite_schema WHERE type = 'table' ORDER BY name");
    std::vector<std::string> names;
    for (const auto& row : tables.rows) names.push_back(text_of(row[0]));
    EXPECT_THAT(names, ElementsAre("attempt", "attempt_computer", "attempt_import", "attempt_program", "campaign",
                                   "campaign_case", "campaign_file", "campaign_import", "case_input", "convergence",
                                   "file_checksum", "machine", "observable", "observation", "parameter", "program",
                                   "program_content", "provenance", "sim_case", "table_checksum"));
    const auto by = store.query(
        "SELECT version, \"commit\", compiler, flags, instruction_path, processor, host, start, "
        "campaign_text, campaign_hash FROM provenance");
    ASSERT_EQ(by.rows.size(), 1u);
    EXPECT_EQ(text_of(by.rows[0][8]), asked.text);
    EXPECT_EQ(text_of(by.rows[0][9]), campaign::content_hash(asked.text));
}

TEST_F(StoreQuery, OnlyOneReadingStatementIsAnswered) {
    const auto before = dump_of(store);
    const auto other = folder / "stolen.db";
    for (const std::string sql : {"DELETE FROM sim_case",
                                  "UPDATE campaign SET seed = 2",
                                  "INSERT INTO campaign_case VALUES (1,1,1,1,1)",
                                  "DROP VIEW first",
                                  "CREATE TABLE t (x)",
                                  "CREATE TEMP TABLE t (x)",
                                  "PRAGMA user_version = 9",
                                  "PRAGMA journal_mode",
                                  "BEGIN",
                                  "COMMIT",
                                  "VACUUM",
                                  "ANALYZE",
                                  "REINDEX",
                                  "SAVEPOINT s",
                                  "SELECT load_extension('x')",
                                  "SELECT 1; SELECT 2",
                                  "SELECT 1; DELETE FROM sim_case",
                                  "SELECT 1;;;/* */ SELECT 2",
                                  "",
                                  "  ",
                                  "-- nothing",
                                  "SELECT ?",
                                  "SELECT nothing",
                                  "SELEC 1",
                                  "SELECT * FROM fisrt",
                                  "WITH t AS (SELECT 1) DELETE FROM sim_case",
                                  "SELECT 1 RETURNING 1",
                                  "DELETE FROM sim_case RETURNING case_id"}) {
        EXPECT_NE(refusal(sql), "answered") << sql;
    }
    EXPECT_NE(refusal("ATTACH '" + other.string() + "' AS other"), "answered");
    EXPECT_NE(refusal("VACUUM INTO '" + other.string() + "'"), "answered");
    EXPECT_FALSE(std::filesystem::exists(other));
    EXPECT_EQ(dump_of(store), before);
    EXPECT_THAT(refusal("SELECT * FROM fisrt"), HasSubstr("no such table: fisrt"));
    EXPECT_THAT(refusal("SELECT 1; SELECT 2"), HasSubstr("one statement"));
    EXPECT_EQ(only_cell(store, "SELECT 1; -- and no more\n ;"), "1");
    EXPECT_EQ(
        only_cell(store,
                  "WITH RECURSIVE n(k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM n WHERE k < 9) SELECT sum(k) FROM n"),
        "45");
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM pragma_table_info('first')"), "11");
    EXPECT_EQ(only_cell(store, "SELECT count(*) FROM json_each('[1, 2]')"), "2");
    settle(store, cases[0].question, 1);  // and afterwards the archive still writes
}

TEST_F(StoreQuery, StatisticsFollowTheirDefinitions) {
    const std::string four = "(SELECT column1 AS x FROM (VALUES (1), (2.0), (4), (9), (NULL)))";
    const auto of = [&](const std::string& statistic) {
        return std::stod(only_cell(store, "SELECT " + statistic + "(x) FROM " + four));
    };
    // 1, 2, 4, 9: mean 4, deviations -3, -2, 0, 5; sums of squares 38, cubes 90, fourth powers 722.
    EXPECT_DOUBLE_EQ(of("sd"), std::sqrt(38.0 / 4));
    EXPECT_DOUBLE_EQ(of("median"), 3);
    EXPECT_DOUBLE_EQ(of("pearson_skewness"), 3 * (4 - 3) / std::sqrt(9.5));
    EXPECT_DOUBLE_EQ(of("g1"), 22.5 / std::pow(9.5, 1.5));
    EXPECT_DOUBLE_EQ(of("kurtosis"), 180.5 / (9.5 * 9.5));
    EXPECT_EQ(only_cell(store, "SELECT median(column1) FROM (VALUES (3), (1), (2))"), "2");
}

TEST_F(StoreQuery, StatisticsOfNothingOrOfEqualsAreNull) {
    EXPECT_EQ(only_cell(store, "SELECT median(y) FROM first"), "NULL");
    EXPECT_EQ(only_cell(store, "SELECT sd(point) FROM first WHERE point < 0"), "NULL");
    for (const char* statistic : {"pearson_skewness", "g1", "kurtosis"}) {
        EXPECT_EQ(only_cell(store, "SELECT " + std::string(statistic) + "(0.1) FROM first"), "NULL");
    }
    EXPECT_EQ(only_cell(store, "SELECT sd(0.1) FROM first"), "0");
    EXPECT_THAT(refusal("SELECT sd(case_id) FROM first"), HasSubstr("numbers"));
}

TEST_F(StoreQuery, AReaderSeesWhatTheWriterHasCommitted) {
    const Store reader(file, Store::Mode::read);
    EXPECT_EQ(only_cell(reader, "SELECT count(y) FROM first"), "0");
    settle(store, cases[0].question, 1);
    EXPECT_EQ(only_cell(reader, "SELECT count(y) FROM first"), "1");
    store.group([&] {
        store.begin({cases[1].question.id, 1});
        store.finish(answer(cases[1].question, 1));
        EXPECT_EQ(only_cell(reader, "SELECT count(y) FROM first"), "1") << "not yet durable, not yet shown";
    });
    EXPECT_EQ(only_cell(reader, "SELECT count(y) FROM first"), "2");
    EXPECT_EQ(dump_of(reader), dump_of(store));
}

TEST_F(StoreQuery, ADumpDoesNotKnowTheOrderOfCompletion) {
    Store other(folder / "b.db", Store::Mode::create);
    other.enrol(asked, small_design(asked, 3), here());
    auto elsewhere = here();
    elsewhere.host = "another host";
    other.enrol(asked, cases, elsewhere);
    for (const auto& it : cases) settle(store, it.question, 1);
    auto crash = answer(cases[0].question, 1);
    crash.outcome = campaign::Outcome::crashed;
    crash.message = "on that host";
    other.group([&] {
        other.begin(crash.attempt);
        other.finish(crash);
    });
    EXPECT_NE(dump_of(store), dump_of(other));
    for (std::size_t k = cases.size(); k-- > 0;) settle(other, cases[k].question, 3);
    EXPECT_EQ(dump_of(store), dump_of(other));
    EXPECT_THAT(dump_of(store), HasSubstr("case " + cases[0].question.id + " scene=rehearsal revision=1 seed="));
}

TEST_F(StoreQuery, ADumpOfAStoppedCampaignEndsWhereItStopped) {
    Store other(folder / "b.db", Store::Mode::create);
    other.enrol(asked, cases, here());
    for (std::size_t k = 0; k < 4; ++k) settle(store, cases[k].question, 1);
    for (std::size_t k = 0; k < 7; ++k) settle(other, cases[k].question, 1);  // more workers: further when it stopped
    for (Store* each : {&store, &other}) {
        each->group([&] { each->stop("first", 4); });
    }
    EXPECT_EQ(dump_of(store), dump_of(other));
}

TEST_F(StoreQuery, StatisticsAreTheirDefinitions) {
    // x: 1, 2, 3, 4, 10; y: 2, 1, 4, 3, 7. Values by R 4.2: sd, var, quantile (type 7), cor, cov.
    const std::string rows = " FROM (VALUES (1, 2), (2, 1), (3, 4), (4, 3), (10, 7), (NULL, 5), (6, NULL))";
    const auto of = [&](const std::string& statistic) {
        return std::stod(only_cell(store, "SELECT " + statistic + rows + " WHERE column1 IS NOT 6"));
    };
    EXPECT_DOUBLE_EQ(of("stddev(column1)"), 3.5355339059327378);
    EXPECT_DOUBLE_EQ(of("stddev_samp(column1)"), 3.5355339059327378);
    EXPECT_DOUBLE_EQ(of("variance(column1)"), 12.5);
    EXPECT_DOUBLE_EQ(of("var_samp(column1)"), 12.5);
    EXPECT_DOUBLE_EQ(of("stddev_pop(column1)"), std::sqrt(10.0));
    EXPECT_DOUBLE_EQ(of("var_pop(column1)"), 10);
    EXPECT_EQ(of("stddev_pop(column1)"), of("sd(column1)"));
    EXPECT_DOUBLE_EQ(of("quantile(column1, 0)"), 1);
    EXPECT_DOUBLE_EQ(of("quantile(column1, 0.3)"), 2.2);
    EXPECT_DOUBLE_EQ(of("quantile(column1, 0.5)"), of("median(column1)"));
    EXPECT_DOUBLE_EQ(of("quantile(column1, 1)"), 10);
    EXPECT_DOUBLE_EQ(of("percentile(column1, 90)"), of("quantile(column1, 0.9)"));
    EXPECT_DOUBLE_EQ(of("above(column1, 3)"), 0.4);
    EXPECT_DOUBLE_EQ(of("below(column1, 3)"), 0.4);
    EXPECT_EQ(only_cell(store, "SELECT quantile_error(column1, 0.5, 0)" + rows), "NULL") << "too few values";
    // 400 values in 4 sequences, of which none lies above: Clopper & Pearson, 1 - 0.025^(1/400).
    const std::string many =
        " FROM (WITH RECURSIVE k(i) AS (SELECT 0 UNION ALL SELECT i + 1 FROM k WHERE i < 399) "
        "SELECT i FROM k)";
    EXPECT_NEAR(std::stod(only_cell(store, "SELECT above_error(i, 400, i % 4)" + many)), 0.009180, 1e-6);
    EXPECT_NEAR(std::stod(only_cell(store, "SELECT above_error(i, 199, i % 4)" + many)), 0.005, 0.005);
    EXPECT_GT(std::stod(only_cell(store, "SELECT quantile_error(i, 0.9, i % 4)" + many)), 0);
    EXPECT_THAT(refusal("SELECT quantile_error(column1, 1, 0)" + rows), HasSubstr("p is one number between 0 and 1"));
    EXPECT_DOUBLE_EQ(of("covar_samp(column1, column2)"), 7.5);
    EXPECT_DOUBLE_EQ(of("covar_pop(column1, column2)"), 6);
    EXPECT_NEAR(of("corr(column1, column2)"), 0.92144, 1e-5);
    EXPECT_DOUBLE_EQ(of("corr(column1, -column1)"), -1);
    EXPECT_EQ(only_cell(store, "SELECT corr(1, column2)" + rows), "NULL");
    EXPECT_EQ(only_cell(store, "SELECT stddev(1)"), "NULL") << "one value has no sample deviation";
    EXPECT_EQ(only_cell(store, "SELECT quantile(y, 0.5) FROM first"), "NULL");
    EXPECT_THAT(refusal("SELECT quantile(column1, 1.5)" + rows), HasSubstr("p is one number from 0 to 1"));
    EXPECT_THAT(refusal("SELECT quantile(column1, column2)" + rows), HasSubstr("p is one number from 0 to 1"));
    EXPECT_THAT(refusal("SELECT percentile(column1, -1)" + rows), HasSubstr("P is one number from 0 to 100"));
}

TEST_F(StoreQuery, StatisticsDoNotDependOnTheUnit) {
    const std::string rows = " FROM (VALUES (1, 2), (2, 1), (3, 4), (4, 3), (10, 7))";
    for (const std::string unit : {"1e305", "1e200", "1e-90", "1e-200", "1e-300"}) {
        const std::string x = "column1 * " + unit;
        const auto ratio = [&](const std::string& statistic) {
            const auto of = [&](const std::string& values) {
                return std::stod(only_cell(store, "SELECT " + statistic + "(" + values + ")" + rows));
            };
            return of(x) / of("column1");
        };
        for (const char* same : {"pearson_skewness", "g1", "kurtosis"}) EXPECT_NEAR(ratio(same), 1, 1e-13) << unit;
        for (const char* as_values : {"sd", "stddev", "median"})
            EXPECT_NEAR(ratio(as_values) / std::stod(unit), 1, 1e-13) << unit;
        EXPECT_NEAR(std::stod(only_cell(store, "SELECT corr(" + x + ", column2)" + rows)), 0.92144, 1e-5) << unit;
        EXPECT_NEAR(std::stod(only_cell(store, "SELECT covar_pop(" + x + ", column2)" + rows)) / std::stod(unit), 6,
                    1e-12)
            << unit;
    }
    EXPECT_EQ(only_cell(store, "SELECT var_pop(column1 * 1e200)" + rows), "NULL") << "beyond double precision";
    EXPECT_EQ(only_cell(store, "SELECT var_pop(column1 * 1e-200)" + rows), "NULL");
}

TEST_F(StoreQuery, AnUnknownNameGetsThoseThereAreAndTheNearest) {
    EXPECT_EQ(refusal("SELECT sequenc FROM first"),
              "SQL: no such column: sequenc; first has point, sequence, replicate, case_id, seed, outcome, attempts, "
              "wall_seconds, x1, x2, y. Did you mean 'sequence'?");
    EXPECT_THAT(refusal("SELECT c.outcme FROM First AS c"), HasSubstr("Did you mean 'outcome'?"));
    EXPECT_THAT(refusal("SELECT time FROM first"), HasSubstr("'time' is a column of series, observation"));
    EXPECT_THAT(refusal("SELECT count(*) FROM first WHERE outcome = \"completed\""),
                HasSubstr("a text stands in single quotes"));
    EXPECT_EQ(
        refusal("SELECT * FROM frist"),
        "SQL: no such table: frist; there are first, convergence_history, inputs, series, attempt, "
        "attempt_computer, attempt_import, attempt_program, campaign, campaign_case, campaign_file, campaign_import, "
        "case_input, convergence, file_checksum, machine, observable, observation, parameter, program, "
        "program_content, provenance, sim_case, "
        "table_checksum. Did "
        "you mean 'first'?");
    EXPECT_EQ(refusal("SELECT stdev(y) FROM first"), "SQL: no such function: stdev. Did you mean 'stddev'?");
    EXPECT_EQ(refusal("SELECT medain(y) FROM first"), "SQL: no such function: medain. Did you mean 'median'?");
}

}  // namespace grainsweep::tests::store_query_test
