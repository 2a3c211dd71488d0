// What others do to the file while a run holds it, and files that no run of ours made: no wrong value is remembered as
// sound, nothing is read without end, and numbers that no run writes end in a sentence.
#include "sweep/campaign/input_error.hpp"
#include "sweep/store/campaign_name.hpp"
#include "sweep/store/database.hpp"
#include "sweep/store/file_checksum.hpp"
#include "tests/support/archive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>

namespace grainsweep::tests::store_tampering_test {

using campaign::Outcome;
using store::Store;
using testing::AllOf;
using testing::HasSubstr;

/// Another program at the file.
void by_another(const std::filesystem::path& file, std::string_view sql) {
    store::Connection(file, store::Connection::Access::write).execute(sql);
}

bool known_as_it_is(const std::filesystem::path& file) {
    store::Connection db(file, store::Connection::Access::read);
    const store::Transaction one_state(db, store::Transaction::Kind::read);
    return store::is_as_remembered(db, file);
}

/// "": it was not refused.
template <class Ask>
std::string refusal_of(Ask&& ask) {
    try {
        ask();
    } catch (const SystemError& broken) {
        return broken.what();
    }
    return {};
}

struct StoreTampering : testing::Test {
    Folder folder;
    std::filesystem::path file = folder / "a.db";
    campaign::Campaign asked = small_campaign("c");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 12);
    std::optional<Store> store;

    /// A run up to its last answer.
    void run() {
        store.reset();
        std::filesystem::remove(file);
        store.emplace(file, Store::Mode::create);
        store->enrol(asked, cases, here());
        for (const auto& placed : cases) settle(*store, placed.question, 1);
        store->group([&] {
            store::ConvergenceRow row{};
            row.observable = "y";
            row.points = 8;
            store->record("c", row);
        });
    }
    void run_to_the_end() {
        run();
        store->remember_file();
        store.reset();
    }
    [[nodiscard]] std::string refused_dump() const {
        return refusal_of([&] { (void)dump_of(Store(file, Store::Mode::read)); });
    }
};

TEST_F(StoreTampering, WhatChangesDuringARunIsFoundBeforeTheFileIsRemembered) {
    for (const char* change : {
             "UPDATE observation SET value = value + 0.125 WHERE case_key = 3",
             "UPDATE observation SET value = NULL WHERE case_key = 3",
             "DELETE FROM observation WHERE case_key = 3",
             "DELETE FROM observation",
             "INSERT INTO observation SELECT case_key, observable_id, 1, NULL, NULL, 1 FROM observation WHERE case_key "
             "= 3",
             "UPDATE case_input SET value = 0.5 WHERE case_key = 3",
             "DELETE FROM case_input WHERE case_key = 3",
             "UPDATE attempt SET message = 'another' WHERE case_key = 3",
             "DELETE FROM attempt WHERE case_key = 3",
             "INSERT INTO attempt (case_key, number, provenance_id, started) VALUES (3, 2, 1, '')",
             "UPDATE sim_case SET outcome = 'unstable' WHERE case_key = 3",
             "UPDATE sim_case SET outcome = NULL WHERE case_key = 3",
             "DELETE FROM observation; DELETE FROM attempt; DELETE FROM case_input; DELETE FROM campaign_case; DELETE "
             "FROM sim_case",
             "UPDATE campaign_case SET case_key = 4 WHERE point = 2",
             "DELETE FROM campaign_case WHERE point = 2",
             "INSERT INTO campaign_case VALUES (1, 99, 0, 1, 3)",
             "UPDATE campaign SET stopped_at = 4",
             "UPDATE observable SET name = 'z' WHERE name = 'y'",
             "UPDATE parameter SET default_value = 0.25 WHERE name = 'x1'",
             "UPDATE provenance SET campaign_text = '{}'",
             "UPDATE convergence SET converged = 1",
             "DELETE FROM convergence",
             "DELETE FROM table_checksum",
             "DROP TABLE table_checksum",
         }) {
        run();
        by_another(file, "PRAGMA foreign_keys = OFF");
        {
            store::Connection other(file, store::Connection::Access::write);
            other.execute("PRAGMA foreign_keys = OFF");
            other.execute(change);
        }
        EXPECT_NE(refusal_of([&] { store->remember_file(); }), "") << change;
        store.reset();
        EXPECT_FALSE(known_as_it_is(file)) << change;
        EXPECT_NE(refused_dump(), "") << change;
        EXPECT_FALSE(Store(file, Store::Mode::read).verify().empty()) << change;
    }
}

// A page that the run holds in memory is sound there; what counts is the disk.
TEST_F(StoreTampering, AFlippedBitOfTheFileIsFound) {
    run();
    store->remember_file();
    const double value = store->values("c", "y").at(5).value;
    std::string bytes;
    {
        std::ifstream stream(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    std::string stored(sizeof value, '\0');  // as SQLite stores it, the highest byte first
    std::memcpy(stored.data(), &value, sizeof value);
    std::ranges::reverse(stored);
    const auto at = bytes.find(stored);
    ASSERT_NE(at, std::string::npos);
    {
        std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
        stream.seekp(static_cast<std::streamoff>(at) + 3);
        stream.put(static_cast<char>(bytes[at + 3] ^ 0x10));
    }
    EXPECT_THAT(refusal_of([&] { store->remember_file(); }), HasSubstr("observable 'y' is not as written"));
    store.reset();
    EXPECT_THAT(refused_dump(), HasSubstr("observable 'y' is not as written"));

    store.emplace(file, Store::Mode::create);
    store->enrol(asked, cases, here());
    EXPECT_THAT(store->notes(), testing::ElementsAre(HasSubstr("asked again")));
    settle(*store, cases[5].question, 2);
    store->remember_file();
    store.reset();
    EXPECT_TRUE(known_as_it_is(file));
}

TEST_F(StoreTampering, WhatChangesBetweenOpeningAndEnrollingIsFound) {
    run_to_the_end();
    ASSERT_TRUE(known_as_it_is(file));
    store.emplace(file, Store::Mode::create);
    by_another(file, "UPDATE observation SET value = value + 0.125 WHERE case_key = 3");
    EXPECT_EQ(store->enrol(asked, cases, here()).at(2).outcome, Outcome::abandoned);
    EXPECT_THAT(store->notes(), testing::ElementsAre(HasSubstr("asked again")));
}

TEST_F(StoreTampering, AnAlteredRowIsNotMadeTrueByAChangeBesideIt) {
    run();
    by_another(file, "UPDATE campaign SET seed = seed + 1; UPDATE attempt_computer SET host = 'another'");
    store->group([&] {
        store->stop("c", 8);
        store->begin({cases[0].question.id, 2}, {"1", "c", "b", "p", "q", "a new one"});
        EXPECT_TRUE(store->finish(answer(cases[0].question, 2)));
    });
    EXPECT_THAT(refusal_of([&] { store->remember_file(); }), HasSubstr("not as written"));
    EXPECT_THAT(refusal_of([&] { (void)store->campaigns(); }), HasSubstr("not as written"));
}

TEST_F(StoreTampering, WhatARunReadsBackIsCheckedAgain) {
    run();
    EXPECT_EQ(store->values("c", "y").size(), 12u);
    by_another(file, "UPDATE observation SET value = 7 WHERE case_key = 3");
    settle(*store, cases[0].question, 2);
    EXPECT_THAT(refusal_of([&] { (void)store->values("c", "y"); }), HasSubstr("'y' is not as written"));
}

TEST_F(StoreTampering, TriggersOfOthersDoNotTouchWhatIsStored) {
    store.emplace(file, Store::Mode::create);
    by_another(file,
               "CREATE TRIGGER alter_it AFTER INSERT ON observation BEGIN UPDATE observation SET value = 7 WHERE "
               "case_key = new.case_key; END;"
               "CREATE TRIGGER lose_it AFTER UPDATE ON sim_case BEGIN DELETE FROM observation; END;"
               "CREATE TRIGGER stop_it AFTER UPDATE ON campaign BEGIN UPDATE campaign SET stopped_at = 2; END");
    store->enrol(asked, cases, here());
    for (const auto& placed : cases) settle(*store, placed.question, 1);
    store->remember_file();
    store.reset();
    EXPECT_TRUE(known_as_it_is(file));
    Store other(folder / "other.db", Store::Mode::create);
    other.enrol(asked, cases, here());
    for (const auto& placed : cases) settle(other, placed.question, 1);
    EXPECT_EQ(dump_of(Store(file, Store::Mode::read)), dump_of(other));
}

TEST_F(StoreTampering, RowsOfNoCaseOnlyCostTheChecksum) {
    run();
    {
        store::Connection other(file, store::Connection::Access::write);
        other.execute("PRAGMA foreign_keys = OFF; INSERT INTO observation VALUES (99, 1, 0, NULL, NULL, 1)");
    }
    EXPECT_EQ(refusal_of([&] { store->remember_file(); }), "");
    store.reset();
    EXPECT_FALSE(known_as_it_is(file));
    EXPECT_EQ(refused_dump(), "");
}

TEST_F(StoreTampering, ViewsAreMadeAnew) {
    auto other = small_campaign("other", 1);
    run();
    store->enrol(other, small_design(other, 2), here());
    store->remember_file();
    store.reset();
    const auto all =
        "SELECT sql FROM sqlite_schema WHERE type = 'view' AND name IN ('c', 'other', 'series', 'inputs', "
        "'convergence_history') ORDER BY name";
    const auto before = Store(file, Store::Mode::read).query(all).rows;
    ASSERT_EQ(before.size(), 5u);
    const auto text = dump_of(Store(file, Store::Mode::read));
    for (const char* change : {"DROP VIEW series", "DROP VIEW c", "DROP VIEW other",
                               "DROP VIEW inputs; CREATE VIEW inputs AS SELECT 1 AS name",
                               "DROP VIEW other; CREATE VIEW other AS SELECT 1 AS point"}) {
        by_another(file, change);
        EXPECT_EQ(dump_of(Store(file, Store::Mode::read)), text) << change;
        EXPECT_FALSE(Store(file, Store::Mode::read).verify().empty()) << change;
        {
            Store again(file, Store::Mode::create);
            again.enrol(asked, cases, here());
            EXPECT_THAT(again.notes(), testing::ElementsAre(HasSubstr("are made anew"))) << change;
            again.remember_file();
        }
        EXPECT_EQ(Store(file, Store::Mode::read).query(all).rows, before) << change;
        EXPECT_TRUE(Store(file, Store::Mode::read).verify().empty()) << change;
        EXPECT_TRUE(known_as_it_is(file)) << change;
    }
}

/// A view without end in the place of another, as somebody may send one.
std::string endless_view(const std::string& name, const std::string& columns) {
    return "DROP VIEW IF EXISTS " + name + "; CREATE VIEW " + name + " AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL " +
           "SELECT i + 1 FROM n) SELECT " + columns + " FROM n";
}

TEST_F(StoreTampering, NoCommandReadsAViewButQuery) {
    run_to_the_end();
    const auto text = dump_of(Store(file, Store::Mode::read));
    by_another(file, endless_view("inputs", "'x' AS case_id, 'x1' AS name, 1.0 AS value") + ";" +
                         endless_view("series", "'c' AS campaign, i AS time") + ";" + endless_view("c", "i AS point") +
                         ";" + endless_view("convergence_history", "i AS campaign"));
    const Store read(file, Store::Mode::read);
    EXPECT_EQ(dump_of(read), text);
    EXPECT_EQ(read.find_case(cases[0].question.id)->inputs.size(), cases[0].question.inputs.size());
    EXPECT_EQ(read.campaigns().size(), 1u);
    EXPECT_EQ(read.status().rows.size(), 1u);
    EXPECT_TRUE(read.result(cases[0].question.id).has_value());
    EXPECT_EQ(read.placement("c").places.size(), 12u);
    EXPECT_EQ(read.places(cases[0].question.id).size(), 1u);
    EXPECT_EQ(read.attempts(cases[0].question.id).size(), 1u);
}

TEST_F(StoreTampering, WhatIsNoTableOfOursIsRefusedWhenTheFileIsOpened) {
    for (const auto& [change, why] : {
             std::pair{"ALTER TABLE sim_case RENAME TO other; " + endless_view("sim_case", "i AS case_key"),
                       "sim_case is a view"},
             {"DROP TABLE convergence; " + endless_view("convergence", "i AS campaign_id"), "convergence is a view"},
             {"DROP TABLE file_checksum; " + endless_view("file_checksum", "i AS pages, i AS checksum"),
              "file_checksum is a view"},
             {"DROP TABLE table_checksum; CREATE VIRTUAL TABLE table_checksum USING fts5(name)",
              "table_checksum is a virtual table"},
             {"DROP TABLE convergence; CREATE TABLE convergence (campaign_id, points AS (1))",
              "column points of table convergence is computed"},
             {std::string("DROP TABLE convergence"), "it has no table convergence"},
         }) {
        run_to_the_end();
        by_another(file, "PRAGMA legacy_alter_table = ON; " + change);
        for (const auto mode : {Store::Mode::read, Store::Mode::create})
            EXPECT_THAT(refusal_of([&] { const Store opened(file, mode); }),
                        AllOf(HasSubstr("not as this program made it"), HasSubstr(why)))
                << change;
    }
}

TEST_F(StoreTampering, NumbersThatNoRunWritesAreRefusedWithoutChecksums) {
    for (const char* change : {
             "UPDATE campaign_case SET point = -1 WHERE point = 11",
             "UPDATE campaign_case SET point = 9000000000000000000 WHERE point = 11",
             "UPDATE campaign_case SET replicate = -1 WHERE point = 11",
             "UPDATE campaign_case SET sequence = -5 WHERE point = 11",
             "UPDATE sim_case SET attempts = -2147483649 WHERE case_key = 3",
             "UPDATE sim_case SET failures = -1 WHERE case_key = 3",
             "UPDATE sim_case SET revision = -1 WHERE case_key = 3",
             "UPDATE attempt SET number = -3 WHERE case_key = 3",
             "UPDATE campaign SET sequences = 0",
             "UPDATE campaign SET replicates = -1",
             "UPDATE campaign SET replicates = 4000000000",
             "UPDATE campaign SET stopped_at = -4",
             "UPDATE campaign SET convergence_block = 0",
             "UPDATE campaign SET candidates = -1",
             "UPDATE campaign SET design_extent = 'points = 640000000000'",
             "UPDATE campaign SET asked_replicates = 0",
             "UPDATE convergence SET points = -8",
         }) {
        run_to_the_end();
        take_back_to_schema(4, file);
        by_another(file, change);
        const auto why = HasSubstr("out of range");
        EXPECT_THAT(refused_dump(), why) << change;
        EXPECT_THAT(refusal_of([&] { (void)Store(file, Store::Mode::read).campaigns(); }), why) << change;
        EXPECT_THAT(refusal_of([&] { (void)Store(file, Store::Mode::read).values("c", "y"); }), why) << change;
        EXPECT_THAT(refusal_of([&] { (void)Store(file, Store::Mode::read).placement("c"); }), why) << change;
        EXPECT_THAT(refusal_of([&] { const Store opened(file, Store::Mode::create); }), why) << change;
        EXPECT_FALSE(Store(file, Store::Mode::read).verify().empty()) << change;
    }
}

/// Whether a database where nothing is has a table of that name.
bool resolved_by_sqlite(const std::string& name) {
    try {
        (void)store::Connection::in_memory().prepare("SELECT 1 FROM " + store::quoted_name(name));
    } catch (const store::RefusedSql& refused) {
        return !refused.words().starts_with("no such table: ");
    }
    return true;
}

TEST(CampaignName, WhatSqliteResolvesByItselfIsRefused) {
    std::vector<std::string> names = {"sqlite_schema",   "SQLITE_master",  "sqlite_temp_schema",
                                      "sqlite_anything", "sim_case",       "campaign_case_by_case",
                                      "Series",          "attempt_program"};
    const auto scratch = store::Connection::in_memory();
    for (const auto& [list, prefix] : {std::pair{"PRAGMA module_list", ""}, {"PRAGMA pragma_list", "pragma_"}}) {
        auto rows = scratch.prepare(list);
        while (rows.step()) {
            auto name = prefix + rows.get<std::string>(0);
            if (!resolved_by_sqlite(name)) continue;  // a module of tables that are made first
            names.push_back(name);
            std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::toupper(c); });
            names.push_back(name);
        }
    }
    EXPECT_GT(names.size(), 30u);
    for (const auto& name : names) EXPECT_THROW(store::check_campaign_name(name), campaign::InputError) << name;
    for (const char* name : {"pragma", "pragma_mine", "json_mine", "sqlite", "table_info", "c"})
        EXPECT_NO_THROW(store::check_campaign_name(name)) << name;
}

TEST_F(StoreTampering, AViewNamedLikeAFunctionOfSqliteHidesNothing) {
    run_to_the_end();
    const auto text = dump_of(Store(file, Store::Mode::read));
    for (const char* name : {"pragma_table_info", "pragma_function_list", "pragma_table_list", "json_each"})
        by_another(file, std::string("CREATE VIEW ") + name + " AS SELECT 1 AS one");
    EXPECT_EQ(dump_of(Store(file, Store::Mode::read)), text);
    EXPECT_THROW((void)Store(file, Store::Mode::read).query("SELECT pint FROM c"), campaign::InputError);
    EXPECT_THROW((void)Store(file, Store::Mode::read).query("SELECT medain(y) FROM c"), campaign::InputError);
    Store again(file, Store::Mode::create);
    again.enrol(asked, cases, here());
    again.remember_file();
    EXPECT_TRUE(again.verify().empty());
}

}  // namespace grainsweep::tests::store_tampering_test
