// A file server that does not answer: a call that waits, without processor time, and that no signal a process handles
// ends. The worker is replaced at no cost of its case; the main program waits with its disk and goes on with it.
#include "tests/support/failing_call.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>

namespace grainsweep::tests::hung_mount_test {

using namespace std::chrono_literals;
using testing::HasSubstr;

const char* impatient = R"("workers": 2, "silence_seconds": 3,
    "launcher": ["/bin/sh", "-c", "exec \"$@\" --checkpoint-seconds 0", "sh"])";

TEST(HungMount, AWorkerThatWaitsForItsDiskIsReplaced) {
    const SmallCampaign campaign(impatient);
    const auto trial = campaign.attempt({"worker", "sync", ".aside", "before", 3, "1000"});
    EXPECT_TRUE(trial.happened);
    EXPECT_EQ(trial.disturbed.code, 0) << trial.disturbed.err;
    EXPECT_THAT(trial.disturbed.err, HasSubstr("gave no sign of life for 3 s and is replaced"));
    EXPECT_EQ(trial.complaint, "");
}

TEST(HungMount, AMainProgramThatWaitsForItsDiskGoesOnWithIt) {
    const SmallCampaign campaign;
    const auto trial = campaign.attempt({"main", "sync", "d.db-wal", "before", 5, "2"});
    EXPECT_TRUE(trial.happened);
    EXPECT_EQ(trial.disturbed.code, 0) << trial.disturbed.err;
    EXPECT_EQ(trial.disturbed.err, "");
    EXPECT_EQ(trial.complaint, "");
}

// Its program itself lies on such a server: the main program does not wait with it.
TEST(HungMount, AWorkerWhoseProgramIsNotLoadedIsReplaced) {
    const SmallCampaign campaign(R"("workers": 1, "start_seconds": 2,
        "launcher": ["/bin/sh", "-c", "exec \"$@\" --checkpoint-seconds 0", "sh"])");
    const auto trial = campaign.attempt({"main", "exec", "/bin/sh", "before", 1, "1000"});
    EXPECT_TRUE(trial.happened);
    EXPECT_EQ(trial.disturbed.code, 0) << trial.disturbed.err;
    EXPECT_THAT(trial.disturbed.err, HasSubstr("was not ready within 2 s and is replaced"));
    EXPECT_EQ(trial.complaint, "");
}

constexpr const char* packing = "x,y,z\n6,6,6\n4,6,6\n6,4,6\n";

/// Gives a worker that waits in opening the pipe what it waits for; nothing where none does.
void answer(const std::filesystem::path& pipe) {
    const int file = ::open(pipe.c_str(), O_WRONLY | O_NONBLOCK);
    if (file < 0) return;
    EXPECT_GT(::write(file, packing, std::strlen(packing)), 0);
    ::close(file);
}

// The system itself lets the call wait: opening a pipe that has no writer.
TEST(HungMount, AnInputFileThatDoesNotOpenIsNoFailureOfTheCase) {
    const Folder folder;
    const auto file = folder.write("packing.csv", packing);
    folder.write("c.json", R"({"campaign": "c", "scene": "tpms_discharge",
        "factors": [{"name": "friction", "levels": [0.2]}], "fixed": {"packing": "packing.csv", "edge": 12, "shell": 1, "end_time": 0.001},
        "design": {"kind": "lattice"}, "execution": {"workers": 1, "silence_seconds": 3}})");
    // The main program has read the file and waits a second before it hands out the case: the server goes.
    const auto token = folder / "token";
    Process run(command_with({"main", "write", "pipe", "before", 1, "1"}, token, {"run", "c.json", "--quiet"}),
                folder.path());
    while (run.running() && !has_happened(token)) std::this_thread::sleep_for(1ms);
    std::filesystem::rename(file, folder / "kept.csv");
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    const auto ask = [&](const std::string& sql) {
        return run_program({"query", "c.db", sql, "--format", "csv"}, folder.path()).out;
    };
    while (run.running() && ask("SELECT count(*) FROM attempt WHERE outcome = 'abandoned'") != "count(*)\n1\n")
        std::this_thread::sleep_for(50ms);
    // And is back.
    std::filesystem::rename(file, folder / "pipe");
    std::filesystem::rename(folder / "kept.csv", file);
    for (; run.running(); std::this_thread::sleep_for(10ms)) answer(folder / "pipe");
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("gave no sign of life for 3 s"));
    EXPECT_EQ(ask("SELECT failures, attempts, outcome FROM sim_case"), "failures,attempts,outcome\n0,2,completed\n");
}

}  // namespace grainsweep::tests::hung_mount_test
