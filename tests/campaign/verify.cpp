// The real program and a database that is damaged, moved, or no file at all.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::verify_test {

std::string config(int points, const std::string& wait = "0") {
    return R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}], "fixed":
        {"wait_seconds": )" +
           wait + R"(}, "design": {"kind": "halton", "points": )" + std::to_string(points) + "}}";
}

std::string contents(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

struct Damaged : testing::Test {
    Folder folder;
    std::string dump;

    Damaged() {
        folder.write("c.json", config(40));
        EXPECT_EQ(run({"run", "c.json", "--quiet"}).code, 0);
        dump = run({"dump", "c.db"}).out;
    }
    Ended run(const std::vector<std::string>& arguments) const { return run_program(arguments, folder.path()); }
    /// Flips a bit of the stored value of y of the first case.
    void flip_a_measured_value() const {
        const auto at = dump.find("  scalar y = ");
        const double y = std::stod(dump.substr(at + 13));
        std::uint64_t bits = 0;
        std::memcpy(&bits, &y, sizeof bits);
        std::string stored;
        for (int k = 7; k >= 0; --k) stored += static_cast<char>(bits >> (8U * static_cast<unsigned>(k)));
        std::string text = contents(folder / "c.db");
        const auto place = text.find(stored);
        ASSERT_NE(place, std::string::npos);
        text[place + 6] = static_cast<char>(text[place + 6] ^ 4);
        folder.write("c.db", text);
    }
};

/// The command between backquotes of a sentence.
std::string advised(const std::string& sentence) {
    const auto begin = sentence.rfind("`sqlite3"), end = sentence.find('`', begin + 1);
    return begin == std::string::npos ? "" : sentence.substr(begin + 1, end - begin - 1);
}

/// Runs a line of shell; what it prints.
std::string shell(const Folder& folder, const std::string& line) {
    return Process({"/bin/sh", "-c", line}, folder.path()).wait().out;
}

void await_results(Process& run, const std::filesystem::path& log) {
    std::error_code none;
    while (run.running() && !(std::filesystem::file_size(log, none) > 150'000 && !none))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

// A page of the inputs is gone. The advised command copies what is left, and a run computes the rest again.
TEST_F(Damaged, WhatIsReadableIsCopiedOutByTheAdvisedCommand) {
    ASSERT_FALSE(shell(folder, "command -v sqlite3").empty()) << "install sqlite3, as ./bootstrap.sh test does";
    const std::string root =
        shell(folder, "sqlite3 c.db \"SELECT rootpage FROM sqlite_schema WHERE name = 'case_input'\"");
    std::string file = contents(folder / "c.db");
    constexpr std::size_t page = 4096;
    std::fill_n(file.begin() + static_cast<std::ptrdiff_t>((std::stoul(root) - 1) * page), page, '\0');
    folder.write("c.db", file);
    std::string command = advised(run({"run", "c.json", "--quiet"}).err);
    ASSERT_FALSE(command.empty()) << run({"run", "c.json", "--quiet"}).err;
    command.replace(command.find("FILE"), 4, "c.db");
    command.replace(command.find("COPY"), 4, "copy.db");
    shell(folder, command);
    for (const char* table : {"sim_case", "attempt", "observation", "campaign_case"})
        EXPECT_EQ(shell(folder, std::string("sqlite3 copy.db 'SELECT count(*) FROM ") + table + "'"), "40\n") << table;
    shell(folder,
          "sqlite3 copy.db \"PRAGMA application_id = 1735620464; PRAGMA user_version = $(sqlite3 c.db 'PRAGMA "
          "user_version')\"");
    EXPECT_EQ(run({"run", "c.json", "--db", "copy.db", "--quiet"}).code, 0);
    EXPECT_EQ(run({"verify", "copy.db"}).code, 0);
    EXPECT_TRUE(run({"dump", "copy.db"}).out == dump);
}

TEST_F(Damaged, ANumberIsFoundNamedAndAskedAgain) {
    EXPECT_EQ(run({"verify", "c.db"}).code, 0);
    flip_a_measured_value();
    const std::string id = dump.substr(5, 32);
    const auto found = run({"verify", "c.db", "--format", "csv"});
    EXPECT_EQ(found.code, 1);
    EXPECT_EQ(found.out,
              "kind,case_id,campaign,observable,damage\ncase," + id + ",c,y,observable 'y' is not as written\n");
    for (const auto& command : std::vector<std::vector<std::string>>{{"dump", "c.db"},
                                                                     {"converge", "c.db"},
                                                                     {"report", "c.db"},
                                                                     {"explain", "c.db", id},
                                                                     {"replay", "c.db", id}}) {
        const auto refused = run(command);
        EXPECT_EQ(refused.code, 3) << command.front();
        EXPECT_NE(refused.err.find(id), std::string::npos) << refused.err;
        EXPECT_TRUE(refused.out.empty()) << command.front();
    }
    const auto again = run({"run", "c.json", "--quiet"});
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.err.find(id.substr(0, 12) + " is damaged in the database"), std::string::npos) << again.err;
    EXPECT_EQ(run({"verify", "c.db"}).code, 0);
    EXPECT_EQ(run({"dump", "c.db"}).out, dump);
    EXPECT_NE(run({"explain", "c.db", id}).out.find("found damaged"), std::string::npos);
}

TEST(ADatabaseInPlace, IsMissedAtOnce) {
    for (const std::string how : {"moved", "deleted", "replaced"}) {
        const Folder folder;
        folder.write("c.json", config(4000, "0.001"));
        {
            Process run(program_command({"run", "c.json", "-j", "2", "--quiet"}), folder.path());
            await_results(run, folder / "c.db-wal");
            ASSERT_TRUE(run.running());
            if (how == "deleted") std::filesystem::remove(folder / "c.db");
            if (how != "deleted") std::filesystem::rename(folder / "c.db", folder / "elsewhere.db");
            if (how == "replaced") folder.write("c.db", "");
            const auto ended = run.wait();
            EXPECT_EQ(ended.code, 3) << how;
            EXPECT_NE(ended.err.find("moved, deleted or replaced"), std::string::npos) << ended.err;
        }
        if (how != "moved") continue;
        std::filesystem::rename(folder / "elsewhere.db", folder / "c.db");
        EXPECT_EQ(run_program({"verify", "c.db"}, folder.path()).code, 0) << "put back, nothing is lost";
    }
}

TEST(ADatabaseInPlace, IsMissedBetweenLongCases) {
    const Folder folder;
    folder.write("c.json", config(2, "3600"));
    Process run(program_command({"run", "c.json", "-j", "2", "--quiet"}), folder.path());
    while (run.running() && run.children().size() < 2) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    std::filesystem::remove(folder / "c.db");
    EXPECT_EQ(run.wait().code, 3) << "an hour before the next result";
}

TEST(ADatabaseInPlace, HasOneNameAndIsAFile) {
    const Folder folder;
    folder.write("c.json", config(4));
    const auto run = [&](const std::string& database) {
        return run_program({"run", "c.json", "--quiet", "--db", database}, folder.path());
    };
    ASSERT_EQ(run("c.db").code, 0);
    std::filesystem::create_hard_link(folder / "c.db", folder / "same.db");
    for (const std::string name : {"c.db", "same.db", ":memory:", "file:c.db"}) EXPECT_EQ(run(name).code, 2) << name;
    std::filesystem::remove(folder / "same.db");
    std::filesystem::create_symlink("c.db", folder / "link.db");
    for (const std::string name : {"c.db", "link.db", "./c.db"}) EXPECT_EQ(run(name).code, 0) << name;
}

// The old answers are there, whole, at whatever moment the run that asks again is killed.
TEST(AskedAgain, OldAnswersStandUntilTheNewOnesAreStored) {
    const Folder folder;
    folder.write("c.json", config(200, "0.002"));
    const auto run = [&](const std::vector<std::string>& arguments) { return run_program(arguments, folder.path()); };
    ASSERT_EQ(run({"run", "c.json", "-j", "2", "--quiet"}).code, 0);
    const auto dump = run({"dump", "c.db"}).out;
    for (int k = 0; k < 3; ++k) {
        {
            Process again(program_command({"run", "c.json", "-j", "2", "--quiet", "--again", "completed"}),
                          folder.path());
            std::error_code none;
            while (again.running() && !(std::filesystem::file_size(folder / "c.db-wal", none) >
                                            20'000U * (1U + static_cast<unsigned>(k)) &&
                                        !none))
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            again.signal(SIGKILL);
            again.wait();
        }
        EXPECT_EQ(run({"dump", "c.db"}).out, dump);
        const auto resumed = run({"run", "c.json", "--quiet"});
        EXPECT_EQ(resumed.code, 0) << resumed.err;
        EXPECT_EQ(run({"dump", "c.db"}).out, dump);
        EXPECT_EQ(run({"verify", "c.db"}).code, 0);
    }
}

// A worker that may write no large file stands for a full disk; the main program and its database are not limited.
TEST(AFullDisk, UnderTheArtefactsEndsTheRunAndIsNoFailureOfTheCase) {
    const Folder folder;
    const std::string start = R"({"campaign": "c", "scene": "tpms_discharge",
        "factors": [{"name": "friction", "levels": [0.2, 0.3]}], "fixed": {"edge": 12, "end_time": 0.02},
        "design": {"kind": "lattice"}, "execution": {"workers": 1)";
    folder.write("full.json", start + R"(, "launcher": ["/bin/sh", "-c", "ulimit -f 8; exec \"$@\"", "sh"]}})");
    folder.write("free.json", start + "}}");
    const auto full = run_program({"run", "full.json", "--db", "c.db", "--quiet"}, folder.path());
    EXPECT_EQ(full.code, 3) << full.err;
    EXPECT_NE(full.err.find("c.artefacts"), std::string::npos) << full.err;
    EXPECT_NE(full.err.find("File too large"), std::string::npos) << full.err;
    const auto failures = run_program(
        {"query", "c.db", "SELECT sum(failures), group_concat(DISTINCT outcome) FROM sim_case", "--format", "csv"},
        folder.path());
    EXPECT_EQ(failures.out, "sum(failures),group_concat(DISTINCT outcome)\n0,abandoned\n");
    const auto free = run_program({"run", "free.json", "--db", "c.db", "--quiet"}, folder.path());
    EXPECT_EQ(free.code, 0) << free.err;
    run_program({"run", "free.json", "--db", "calm.db", "--quiet"}, folder.path());
    EXPECT_EQ(run_program({"dump", "c.db"}, folder.path()).out, run_program({"dump", "calm.db"}, folder.path()).out);
    for (const auto& entry : std::filesystem::directory_iterator(folder / "c.artefacts"))
        EXPECT_NE(entry.path().extension(), ".aside") << "half a file is left";
}

TEST(AFullDisk, ADatabaseIsNotItsOwnFolderOfArtefacts) {
    const Folder folder;
    folder.write("c.json",
                 R"({"campaign": "c", "scene": "tpms_discharge", "factors": [{"name": "friction", "levels": [0.2]}],
        "fixed": {"edge": 12, "end_time": 0.02}, "design": {"kind": "lattice"}})");
    EXPECT_EQ(run_program({"run", "c.json", "--db", "x.artefacts", "--quiet"}, folder.path()).code, 0);
    EXPECT_TRUE(std::filesystem::is_directory(folder / "x.artefacts.artefacts"));
    EXPECT_EQ(run_program({"verify", "x.artefacts"}, folder.path()).code, 0);
}

}  // namespace grainsweep::tests::verify_test
