// Databases of every earlier schema: the present program reads them as they are, leaves them to the older program while
// it refuses a question, and continues them. Files of schemas 1 and 10 are kept as text. Those between are the first
// one, migrated and taken back.
#include "tests/support/archive.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"
#include "tests/support/whole_campaign.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

namespace grainsweep::tests::old_archives_test {

using nlohmann::json;

std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// Makes the database that the SQL text describes, in the journal mode of the program.
void make(const std::filesystem::path& file, const std::string& sql) {
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
    const auto all = "PRAGMA journal_mode = WAL;" + sql;
    EXPECT_EQ(sqlite3_exec(db, all.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
    sqlite3_close(db);
}

/// Its parameter: the schema.
class OldArchive : public testing::TestWithParam<int> {
protected:
    OldArchive() {
        std::filesystem::copy(reference("old_archives/campaign.json"), folder / "c.json");
        const bool kept = GetParam() == 1 || GetParam() == 10;
        make(folder / "old.db", contents(reference(fmt::format("old_archives/schema_{}.sql", kept ? GetParam() : 1))));
        if (kept) return;
        EXPECT_EQ(ask({"run", "c.json", "--quiet"}).code, 1) << "its cases are settled: it is only migrated";
        take_back_to_schema(GetParam(), folder / "old.db");
    }
    [[nodiscard]] Ended ask(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder.path());
    }
    [[nodiscard]] json query(const std::string& sql) const {
        const auto ended = ask({"query", "old.db", sql, "--format", "json"});
        EXPECT_EQ(ended.code, 0) << ended.err;
        return json::parse(ended.out);
    }
    [[nodiscard]] json attempts_of(const std::string& outcome) const {
        const auto found = query("SELECT case_id FROM old WHERE outcome = '" + outcome + "' LIMIT 1");
        const auto explained = ask({"explain", "old.db", found[0]["case_id"], "--format", "json"});
        EXPECT_EQ(explained.code, 0) << explained.err;
        return json::parse(explained.out)["attempts"];
    }
    /// In the header of the file: https://www.sqlite.org/fileformat.html, 1.3.
    [[nodiscard]] int schema() const {
        constexpr std::size_t lowest_byte_of_user_version = 63;
        return contents(folder / "old.db").at(lowest_byte_of_user_version);
    }
    Folder folder;
    const std::string dump = contents(reference("old_archives/schema_1.dump"));
};

TEST_P(OldArchive, IsReadAsItIs) {
    const auto before = contents(folder / "old.db");
    EXPECT_EQ(ask({"dump", "old.db"}).out, dump);
    EXPECT_EQ(query("SELECT count(*) AS n FROM old")[0]["n"], 12);
    EXPECT_EQ(attempts_of("completed").size(), 1U);
    for (const auto* command : {"status", "converge", "sensitivity", "verify"})
        EXPECT_EQ(ask({command, "old.db"}).code, 0) << command;
    EXPECT_EQ(ask({"report", "old.db", "-o", "old.html"}).code, 0);
    EXPECT_TRUE(contents(folder / "old.db") == before) << "to the byte";
    EXPECT_EQ(schema(), GetParam());
}

TEST_P(OldArchive, IsLeftToTheOlderProgramByAQuestionThatIsRefused) {
    const auto before = contents(folder / "old.db");
    auto other = json::parse(contents(folder / "c.json"));
    other["seed"] = 77;
    folder.write("other.json", other.dump());
    const auto refused = ask({"run", "other.json", "--quiet"});
    EXPECT_EQ(refused.code, 2) << refused.err;
    EXPECT_TRUE(contents(folder / "old.db") == before) << "to the byte";
}

// Every case of it is settled or given up: a run only brings it up to date. Then more points are computed.
TEST_P(OldArchive, IsContinued) {
    EXPECT_EQ(ask({"run", "c.json", "--quiet"}).code, 1);
    EXPECT_EQ(ask({"dump", "old.db"}).out, dump) << "no answer has changed";
    EXPECT_EQ(query("SELECT count(*) AS n FROM attempt")[0]["n"], 12);
    EXPECT_EQ(ask({"run", "c.json", "--quiet", "--points", "18"}).code, 1);
    EXPECT_EQ(ask({"run", "c.json", "--quiet", "--points", "18", "--db", "new.db"}).code, 1);
    EXPECT_EQ(ask({"dump", "old.db"}).out, ask({"dump", "new.db"}).out);
    EXPECT_EQ(complaints(folder / "old.db"), "ok");
    const auto verified = ask({"verify", "old.db"});
    EXPECT_EQ(verified.code, 0) << verified.out;
}

TEST_P(OldArchive, ItsAttemptsAreOfTheMachineThatRanThem) {
    ASSERT_EQ(ask({"run", "c.json", "--quiet", "--again", "unstable"}).code, 1);
    const auto attempts = attempts_of("unstable");
    ASSERT_EQ(attempts.size(), 2U);
    EXPECT_EQ(attempts[0]["host"], "another host");
    EXPECT_NE(attempts[1]["host"], "another host");
    if (GetParam() == 1) {
        EXPECT_EQ(attempts[0]["processor"], "another processor");
        EXPECT_EQ(attempts[0]["instruction_path"], "avx2");
    }
    EXPECT_EQ(query("SELECT count(*) AS n FROM attempt WHERE computer_id IS NULL")[0]["n"], 0);
}

INSTANTIATE_TEST_SUITE_P(Released, OldArchive, testing::Range(1, 12),
                         [](const auto& one) { return "Schema" + std::to_string(one.param); });

// Heap, hopper and drum were scenes before they became machines, whose cases have other ids.
TEST(OldHeap, IsLeftToTheOlderProgramWithASentence) {
    const Folder folder;
    make(folder / "old.db", contents(reference("old_archives/heap.sql")));
    const auto before = contents(folder / "old.db");
    const auto ask = [&](const std::vector<std::string>& arguments) { return run_program(arguments, folder.path()); };
    const auto config = [&](const std::string& name) {
        return R"({"campaign": ")" + name + R"(", "scene": "heap", "fixed": {"friction": 0.1}, "factors": [
            {"name": "lift_speed", "between": [0.01, 1]}, {"name": "floor", "levels": ["smooth", "rough"]}],
            "design": {"kind": "halton", "scramble": "none", "points": 12}})";
    };
    folder.write("old.json", config("old"));
    folder.write("other.json", config("other"));
    const std::string sentence = "of an older program. Since then heap is a machine, whose cases have other ids";
    const auto run = ask({"run", "old.json", "--quiet"});
    EXPECT_EQ(run.code, 2);
    EXPECT_NE(run.err.find(sentence), std::string::npos) << run.err;
    const auto replay = ask({"replay", "old.db", "11550ae5065324c5da1908b6f88e8748"});  // completed
    EXPECT_EQ(replay.code, 2);
    EXPECT_NE(replay.err.find("'heap' " + sentence), std::string::npos) << replay.err;
    for (const auto* begun : {"774bb3623de1a94469a88703a58e4f4e", "c0beceb5939e40afac2c62891d74f096"}) {
        const auto explained = ask({"explain", "old.db", begun});
        EXPECT_NE(explained.out.find("does not run it: it is of scene 'heap' of an older program"), std::string::npos)
            << explained.out;
    }
    EXPECT_TRUE(contents(folder / "old.db") == before) << "to the byte";
    EXPECT_EQ(ask({"plan", "other.json", "--db", "old.db"}).code, 0) << "another name in the same database";
}

}  // namespace grainsweep::tests::old_archives_test
