// Beside a database nothing is left: not after a run, not after a main program was killed and one command read it.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::one_file_test {

std::vector<std::string> names_of(const Folder& folder, const std::string& start) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        const auto name = entry.path().filename().string();
        if (name.starts_with(start)) names.push_back(name);
    }
    std::ranges::sort(names);
    return names;
}

const char* config = R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
    "fixed": {"wait_seconds": 0.01}, "design": {"kind": "halton", "points": 400}})";

TEST(OneFile, AfterARunThatShowedItsTables) {
    const Folder folder;
    folder.write("c.json", config);
    const auto ended = run_program({"run", "c.json", "-j", "2", "--max-cases", "4"}, folder.path());
    EXPECT_EQ(ended.code, 1) << ended.err;
    EXPECT_EQ(names_of(folder, "c.db"), std::vector<std::string>{"c.db"});
    for (const auto& command : std::vector<std::vector<std::string>>{
             {"status", "c.db"}, {"query", "c.db", "SELECT * FROM c"}, {"converge", "c.db"}, {"report", "c.db"}}) {
        EXPECT_EQ(run_program(command, folder.path()).code, 0) << command.front();
        EXPECT_EQ(names_of(folder, "c.db"), std::vector<std::string>{"c.db"}) << command.front();
    }
}

TEST(OneFile, AfterTheMainProgramWasKilledAndOneCommandReadIt) {
    const Folder folder;
    folder.write("c.json", config);
    {
        Process run(program_command({"run", "c.json", "-j", "2", "--quiet"}), folder.path());
        std::error_code none;
        const auto log = folder / "c.db-wal";
        // Some groups of results beyond the schema and the campaign are in the log.
        while (run.running() && !(std::filesystem::file_size(log, none) > 150'000 && !none))
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ASSERT_TRUE(run.running());
        run.signal(SIGKILL);
        run.wait();
    }
    EXPECT_EQ(names_of(folder, "c.db").size(), 3U) << "the log holds the last results";
    const auto status = run_program({"status", "c.db", "--format", "csv"}, folder.path());
    EXPECT_EQ(status.code, 0) << status.err;
    EXPECT_EQ(names_of(folder, "c.db"), std::vector<std::string>{"c.db"});
    EXPECT_EQ(run_program({"status", "c.db", "--format", "csv"}, folder.path()).out, status.out);
}

}  // namespace grainsweep::tests::one_file_test
