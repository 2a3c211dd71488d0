// What is not as it was written is found, named, and asked again: never read as data.
#include "sweep/store/database.hpp"
#include "tests/support/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <cmath>
#include <string>
#include <vector>

namespace grainsweep::tests::store_checksums_test {

using campaign::Outcome;
using store::Store;
using testing::HasSubstr;

struct StoreChecksums : testing::Test {
    Folder folder;
    std::filesystem::path file = folder / "a.db";
    campaign::Campaign asked = small_campaign("c");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 6);
    std::string whole;

    StoreChecksums() {
        Store store(file, Store::Mode::create);
        store.enrol(asked, cases, here());
        for (std::size_t k = 0; k < cases.size(); ++k) store.group([&] { write(store, k, 1); });
        store.group([&] {
            store.record("c", {"y", 4, 1, 0.5, std::nan(""), 0, 3, 0.1, 0.2, 0.3, 0.4, 0.5, 0, 0, false});
            store.stop("c", 6);
        });
        whole = dump_of(store);
    }

    void write(Store& store, std::size_t k, std::int64_t attempt) const {
        auto given = answer(cases[k].question, attempt);
        given.observations.series["y_series"] = {{.time = 0.5, .value = 1.0 / 3}, {.time = 1, .bin = 2, .value = 0}};
        given.cost.phases = {{"contact", 0.25}};
        if (k == 5) {
            given.outcome = Outcome::unstable;
            given.message = "overlap 0.3 d";
        }
        store.begin(given.attempt);
        ASSERT_TRUE(store.finish(given));
    }
    void damage(std::string_view sql) const {
        store::Connection db(file, store::Connection::Access::write);
        db.execute(sql);
    }
    std::vector<store::Damage> verified() const { return Store(file, Store::Mode::read).verify(); }
    std::string refusal(const std::function<void(const Store&)>& question) const {
        const Store store(file, Store::Mode::read);
        try {
            question(store);
        } catch (const SystemError& broken) {
            return broken.what();
        }
        return "answered";
    }
    std::string id(std::size_t k) const { return cases[k].question.id; }
};

TEST_F(StoreChecksums, WhatIsAsWrittenIsSound) {
    EXPECT_TRUE(verified().empty());
    EXPECT_EQ(dump_of(Store(file, Store::Mode::read)), whole);
}

TEST_F(StoreChecksums, AnotherNumberOfThreadsIsFoundAndNoneIsAsBeforeItWasKept) {
    damage("UPDATE attempt SET threads = 2 WHERE case_key = 2");
    EXPECT_EQ(verified().size(), 1u);
    damage("UPDATE attempt SET threads = NULL WHERE case_key = 2");
    EXPECT_TRUE(verified().empty());
}

TEST_F(StoreChecksums, ANumberThatChangedIsNamed) {
    damage(
        "UPDATE observation SET value = value + 1e-13 WHERE case_key = 2 AND observable_id = "
        "(SELECT observable_id FROM observable WHERE name = 'y_series') AND sample = 0");
    const auto found = verified();
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, "case");
    EXPECT_EQ(found[0].case_id, id(1));
    EXPECT_EQ(found[0].campaign, "c");
    EXPECT_EQ(found[0].observable, "y_series");
    for (const auto& sentence : {refusal([](const Store& store) { (void)dump_of(store); }),
                                 refusal([](const Store& store) { (void)store.values("c", "y"); }),
                                 refusal([](const Store& store) { (void)store.campaigns(); }),
                                 refusal([](const Store& store) { (void)store.convergence("c", "y"); }),
                                 refusal([&](const Store& store) { (void)store.result(id(1)); }),
                                 refusal([&](const Store& store) { (void)store.find_case(id(1)); })}) {
        EXPECT_THAT(sentence, AllOf(HasSubstr(id(1)), HasSubstr("'y_series' is not as written"),
                                    HasSubstr("grainsweep verify"), HasSubstr("asks a damaged case again")));
    }
    EXPECT_EQ(refusal([&](const Store& store) { (void)store.result(id(0)); }), "answered") << "others are sound";
    EXPECT_EQ(refusal([](const Store& store) { (void)store.status(); }), "answered");
}

TEST_F(StoreChecksums, WhateverChangesIsFound) {
    store::Connection(file, store::Connection::Access::write).execute("PRAGMA wal_checkpoint(TRUNCATE)");
    const Folder copies;
    const auto copy = copies / "a.db";
    for (const auto* change : {
             "UPDATE observation SET sample = 7 WHERE case_key = 1 AND sample = 1",
             "DELETE FROM observation WHERE case_key = 1 AND sample = 1",
             "UPDATE observation SET time = NULL WHERE case_key = 1 AND sample = 1",
             "UPDATE sim_case SET outcome = 'skipped' WHERE case_key = 3",
             "UPDATE sim_case SET outcome = NULL WHERE case_key = 3",
             "UPDATE sim_case SET seed = seed + 1 WHERE case_key = 3",
             "UPDATE sim_case SET wall_seconds = 0.5 WHERE case_key = 3",
             "UPDATE sim_case SET attempts = 2 WHERE case_key = 3",
             "UPDATE sim_case SET checksum = checksum - 1 WHERE case_key = 3",
             "UPDATE case_input SET value = value * 1.0000001 WHERE case_key = 4",
             "DELETE FROM case_input WHERE case_key = 4",
             "UPDATE attempt SET message = 'overlap 0.2 d' WHERE case_key = 6",
             "UPDATE attempt SET cpu_seconds = 1 WHERE case_key = 2",
             "UPDATE attempt SET started = '2020' WHERE case_key = 2",
             "DELETE FROM attempt WHERE case_key = 2",
             "UPDATE campaign SET seed = 2",
             "UPDATE campaign SET stopped_at = 5",
             "UPDATE campaign_case SET sequence = 1 - sequence WHERE point = 2",
             "DELETE FROM campaign_case WHERE point = 2",
             "UPDATE convergence SET mean = 2",
             "DELETE FROM convergence",
             "UPDATE observable SET name = 'z' WHERE name = 'y'",
             "UPDATE parameter SET default_value = 0.25 WHERE name = 'x1'",
             "UPDATE provenance SET campaign_text = campaign_text || ' '",
             "UPDATE provenance SET processor = 'another'",
             "DROP VIEW series",
         }) {
        std::filesystem::copy_file(file, copy, std::filesystem::copy_options::overwrite_existing);
        store::Connection(copy, store::Connection::Access::write).execute(change);
        const Store store(copy, Store::Mode::read);
        EXPECT_FALSE(store.verify().empty()) << change;
        std::string text;
        try {
            text = dump_of(store);
        } catch (const SystemError&) {
        }
        EXPECT_TRUE(text.empty() || text == whole) << change;
    }
}

TEST_F(StoreChecksums, ADamagedCaseIsAskedAgainAndItsLogSaysSo) {
    damage(
        "UPDATE observation SET value = 0.25 WHERE case_key = 2 AND observable_id = "
        "(SELECT observable_id FROM observable WHERE name = 'y')");
    damage("UPDATE case_input SET value = 0.25 WHERE case_key = 4");
    damage("UPDATE attempt SET message = 'another' WHERE case_key = 6");
    {
        Store store(file, Store::Mode::create);
        const auto states = store.enrol(asked, cases, here());
        for (std::size_t k = 0; k < cases.size(); ++k) {
            const bool damaged = k == 1 || k == 3 || k == 5;
            EXPECT_EQ(states[k].outcome, damaged ? Outcome::abandoned : Outcome::completed) << k;
            EXPECT_EQ(states[k].attempts, 1) << k;
        }
        ASSERT_EQ(store.notes().size(), 3u);
        EXPECT_THAT(store.notes()[0],
                    AllOf(HasSubstr(id(1).substr(0, 12)), HasSubstr("'y'"), HasSubstr("asked again")));
        EXPECT_THAT(store.attempts(id(1)).at(0).message, HasSubstr("found damaged"));
        EXPECT_TRUE(store.verify().empty());
        for (const std::size_t k : {1u, 3u, 5u}) store.group([&] { write(store, k, 2); });
        store.enrol(asked, cases, here());
        EXPECT_TRUE(store.notes().empty());
    }
    EXPECT_TRUE(verified().empty());
    EXPECT_EQ(dump_of(Store(file, Store::Mode::read)), whole);
}

/// The rows of `observation` as they are, by descending case: as a flipped bit of a key leaves one of them.
void put_out_of_order(const std::filesystem::path& file) {
    const auto execute = [&](const std::string& sql) {
        sqlite3* db = nullptr;
        ASSERT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
        EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
        sqlite3_close(db);
    };
    const auto declare = [](const std::string& from, const std::string& to) {
        return "PRAGMA writable_schema = ON; UPDATE sqlite_schema SET sql = replace(sql, '" + from + "', '" + to +
               "') WHERE name = 'observation'";
    };
    execute(declare("(case_key, observable_id", "(case_key DESC, observable_id"));
    execute(
        "CREATE TEMP TABLE kept AS SELECT * FROM observation; DELETE FROM observation; "
        "INSERT INTO observation SELECT * FROM kept");
    execute(declare("(case_key DESC, observable_id", "(case_key, observable_id"));
}

// What is written into such a table may not be found again, and SQLite's quick check sees nothing.
TEST_F(StoreChecksums, RowsOutOfOrderAreNotWrittenTo) {
    put_out_of_order(file);
    const auto damaged = [&](auto&& use) {
        try {
            use();
        } catch (const SystemError& broken) {
            return std::string(broken.what());
        }
        return std::string();
    };
    EXPECT_THAT(damaged([&] { Store(file, Store::Mode::create).enrol(asked, cases, here()); }),
                HasSubstr("table observation: its rows are not in the order of their keys"));
    EXPECT_THAT(damaged([&] { (void)dump_of(Store(file, Store::Mode::read)); }), HasSubstr("damaged"));
}

TEST_F(StoreChecksums, ALogThatChangedCostsNoAnswer) {
    {
        Store store(file, Store::Mode::create);
        store.enrol(asked, cases, here());
        store.group([&] { write(store, 0, 2); });
    }
    damage("UPDATE attempt SET message = 'another' WHERE case_key = 1 AND number = 1");
    Store store(file, Store::Mode::create);
    EXPECT_EQ(store.enrol(asked, cases, here())[0].outcome, Outcome::completed);
    EXPECT_EQ(store.notes().size(), 1u);
    EXPECT_THAT(store.attempts(id(0)).at(0).message, HasSubstr("this row was found damaged"));
    EXPECT_TRUE(store.verify().empty());
}

TEST_F(StoreChecksums, ADesignThatChangedIsPutRight) {
    damage("UPDATE campaign_case SET sequence = 1 - sequence WHERE point = 2; UPDATE convergence SET mean = 2");
    {
        Store store(file, Store::Mode::create);
        EXPECT_THROW(store.enrol(asked, small_design(asked, 3), here()), SystemError) << "it knows a part only";
        store.enrol(asked, cases, here());
        EXPECT_TRUE(store.verify().empty());
        EXPECT_TRUE(store.convergence("c", "y").empty()) << "verdicts are given anew";
    }
    EXPECT_EQ(only_cell(Store(file, Store::Mode::read), "SELECT sequence FROM campaign_case WHERE point = 2"), "0");
}

TEST_F(StoreChecksums, ADescriptionThatChangedEndsTheRun) {
    damage("UPDATE observable SET name = 'z' WHERE name = 'y'");
    Store store(file, Store::Mode::create);
    EXPECT_THROW(store.enrol(asked, cases, here()), SystemError) << "which observable this was, nothing tells";
}

TEST_F(StoreChecksums, AFileFromBeforeIsProtectedFromTheNextRunOn) {
    take_back_to_schema(4, file);
    {
        const Store store(file, Store::Mode::read);
        EXPECT_FALSE(store.has_checksums());
        EXPECT_EQ(dump_of(store), whole);
        EXPECT_TRUE(store.verify().empty());
    }
    {
        Store store(file, Store::Mode::create);
        (void)store.enrol(asked, cases, here());
    }
    {
        const Store store(file, Store::Mode::read);
        EXPECT_TRUE(store.has_checksums());
        EXPECT_EQ(dump_of(store), whole);
        EXPECT_TRUE(store.verify().empty());
    }
    damage("UPDATE sim_case SET wall_seconds = 0.5 WHERE case_key = 3");
    EXPECT_EQ(verified().size(), 1u);
}

TEST_F(StoreChecksums, WhatAUserAddsIsNoDamage) {
    damage(
        "ANALYZE; CREATE TABLE mine (x); CREATE VIEW my_view AS SELECT * FROM c; CREATE INDEX my_index ON "
        "observation (value); VACUUM");
    EXPECT_TRUE(verified().empty());
}

}  // namespace grainsweep::tests::store_checksums_test
