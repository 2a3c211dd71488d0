// TERM and Ctrl-C between two waves, where no pool attends to them: the documented codes, always.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace grainsweep::tests::end_requests_test {

using namespace std::chrono_literals;

const char* calibration = R"({"campaign": "cal", "scene": "rehearsal",
 "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
 "fixed": {"response": "spreading_a", "x4": 0.5, "noise": 0.02, "wait_seconds": 0.01},
 "calibration": {"targets": [{"observable": "y", "value": 0.2370, "error": 0.003, "inputs": {"x3": 0.5}},
                             {"observable": "y", "value": 0.4949, "error": 0.003, "inputs": {"x3": 0.95}}],
                 "discrepancy": {"y": 0.001}, "waves": 3, "points_per_wave": 12}, "execution": {"workers": 2}})";

/// Stored answers, by the file that a run writes every second and removes between waves.
std::string ended_at(int signal, std::chrono::milliseconds after, const Folder& folder) {
    Process run(program_command({"calibrate", "c.json", "--db", "c.db"}), folder.path());
    std::error_code ignored;
    for (const auto last = std::chrono::steady_clock::now() + 30s;
         run.running() && !std::filesystem::exists(folder / "c.now", ignored) &&
         std::chrono::steady_clock::now() < last;)
        std::this_thread::sleep_for(2ms);
    while (run.running() && std::filesystem::exists(folder / "c.now", ignored)) std::this_thread::sleep_for(2ms);
    std::this_thread::sleep_for(after);
    if (run.running()) run.signal(signal);
    return std::to_string(run.wait().code);
}

TEST(EndRequests, BetweenWavesHaveTheDocumentedCodes) {
    for (const auto& [signal, code] : {std::pair{SIGTERM, "75"}, {SIGINT, "130"}, {SIGUSR1, "75"}}) {
        const Folder folder;
        folder.write("c.json", calibration);
        EXPECT_EQ(ended_at(signal, 0ms, folder), code) << signal;
        const auto resumed = run_program({"calibrate", "c.json", "--db", "c.db", "--quiet"}, folder.path());
        EXPECT_TRUE(resumed.code == 0 || resumed.code == 1) << resumed.err;
        EXPECT_EQ(run_program({"verify", "c.db"}, folder.path()).code, 0);
    }
}

/// Whether the process answers the signal itself.
bool answers(pid_t process, int signal) {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with("SigCgt:")) return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1U) != 0;
    return false;
}

TEST(EndRequests, FromTheFirstMoment) {
    const Folder folder;
    folder.write("c.json", calibration);
    for (int tries = 0; tries < 5; ++tries) {
        Process run(program_command({"calibrate", "c.json", "--quiet"}), folder.path());
        while (run.running() && !answers(run.pid(), SIGTERM)) std::this_thread::sleep_for(1ms);
        std::this_thread::sleep_for(tries * 20ms);
        run.signal(SIGTERM);
        EXPECT_EQ(run.wait().code, 75) << tries;
    }
}

}  // namespace grainsweep::tests::end_requests_test
