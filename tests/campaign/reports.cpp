// The page never costs a file: not the page before it, not a file that is no page.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace grainsweep::tests::reports_test {

std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(Report, ReplacesAPageOnlyByAWholePage) {
    const Folder folder;
    const std::string config =
        R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
      "design": {"kind": "halton", "points": 8}})";
    folder.write("c.json", config);
    ASSERT_EQ(run_program({"run", "c.json", "--quiet"}, folder.path()).code, 0);
    EXPECT_EQ(run_program({"report", "c.db"}, folder.path()).code, 0);
    const std::string page = contents(folder.path() / "c.html");
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    EXPECT_EQ(run_program({"report", "c.db"}, folder.path()).code, 0);  // over the old one

    const auto taken = run_program({"report", "c.db", "-o", "c.json"}, folder.path());
    EXPECT_EQ(taken.code, 2);
    EXPECT_NE(taken.err.find("is not a page"), std::string::npos) << taken.err;
    EXPECT_EQ(contents(folder.path() / "c.json"), config);

    // Not even an empty file, where it belongs to the database.
    for (const char* name : {"c.db", "c.db-wal", "c.db.lock"}) {
        if (name != std::string("c.db")) folder.write(name, "");
        EXPECT_EQ(run_program({"report", "c.db", "-o", name}, folder.path()).code, 2) << name;
    }
    EXPECT_EQ(run_program({"report", "c.db", "-o", "nowhere/c.html"}, folder.path()).code, 2);
    EXPECT_EQ(run_program({"report", "c.db", "-o", "."}, folder.path()).code, 2);

    const auto piped = run_program({"report", "c.db", "-o", "/dev/stdout"}, folder.path());
    EXPECT_EQ(piped.code, 0) << piped.err;
    EXPECT_TRUE(piped.out.starts_with(page.substr(0, 1000)));

    // A disk that is full after 100 blocks of 1024 or 512 bytes: room for the index of the log, not for the page.
    auto limited = program_command({"report", "c.db"});
    limited.insert(limited.begin(), {"/bin/sh", "-c", "ulimit -f 100; exec \"$@\"", "sh"});
    const auto full = Process(limited, folder.path()).wait();
    EXPECT_EQ(full.code, 3);
    EXPECT_NE(full.err.find("c.html"), std::string::npos) << full.err;
    EXPECT_EQ(contents(folder.path() / "c.html"), page);
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_NE(entry.path().extension(), ".aside") << entry.path();
}

}  // namespace grainsweep::tests::reports_test
