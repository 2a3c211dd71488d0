// Archives written by older programs: they open, become of today's form, and stay true.
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"
#include "tests/support/whole_campaign.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace grainsweep::tests::old_archives_test {

using nlohmann::json;

std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// The archive that the SQL text describes.
void make(const std::filesystem::path& file, const std::string& sql) {
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
    sqlite3_close(db);
}

class OldArchive : public testing::Test {
protected:
    OldArchive() {
        std::filesystem::copy(reference("old_archives/campaign.json"), folder / "c.json");
        make(folder / "old.db", contents(reference("old_archives/schema_1.sql")));
    }
    json query(const std::string& sql) {
        const auto ended = run_program({"query", "old.db", sql, "--format", "json"}, folder.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
        return json::parse(ended.out);
    }
    Folder folder;
};

TEST_F(OldArchive, IsReadAsItIs) {
    const auto dumped = run_program({"dump", "old.db"}, folder.path());
    EXPECT_EQ(dumped.out, contents(reference("old_archives/schema_1.dump")));
    const std::string id = query("SELECT case_id FROM old LIMIT 1")[0]["case_id"];
    const auto explained = run_program({"explain", "old.db", id, "--format", "json"}, folder.path());
    EXPECT_EQ(json::parse(explained.out)["attempts"][0]["host"], "another host") << explained.err;
}

// Every case of it is settled or given up: a run only brings it up to date.
TEST_F(OldArchive, OpensAndStaysTrue) {
    const auto run = run_program({"run", "c.json", "--quiet"}, folder.path());
    EXPECT_EQ(run.code, 1) << run.err;
    const auto dumped = run_program({"dump", "old.db"}, folder.path());
    EXPECT_EQ(dumped.code, 0) << dumped.err;
    EXPECT_EQ(dumped.out, contents(reference("old_archives/schema_1.dump")));
    EXPECT_EQ(query("SELECT count(*) AS n FROM attempt")[0]["n"], 12);
    EXPECT_EQ(grainsweep::tests::complaints(folder / "old.db"), "ok");
}

TEST_F(OldArchive, ItsAttemptsAreOfTheMachineThatRanThem) {
    ASSERT_EQ(run_program({"run", "c.json", "--quiet", "--again", "unstable"}, folder.path()).code, 1);
    const std::string id = query("SELECT case_id FROM old WHERE outcome = 'unstable' LIMIT 1")[0]["case_id"];
    const auto explained = run_program({"explain", "old.db", id, "--format", "json"}, folder.path());
    ASSERT_EQ(explained.code, 0) << explained.err;
    const auto attempts = json::parse(explained.out)["attempts"];
    ASSERT_EQ(attempts.size(), 2U);
    EXPECT_EQ(attempts[0]["host"], "another host");
    EXPECT_EQ(attempts[0]["processor"], "another processor");
    EXPECT_EQ(attempts[0]["instruction_path"], "avx2");
    EXPECT_NE(attempts[1]["host"], "another host");
    EXPECT_EQ(query("SELECT count(*) AS n FROM attempt WHERE computer_id IS NULL")[0]["n"], 0);
}

}  // namespace grainsweep::tests::old_archives_test
