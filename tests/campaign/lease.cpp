// A worker that receives nothing ends by itself; one that was stopped together with its main program has missed
// nothing.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>
#include <sys/types.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::lease_test {

using namespace std::chrono_literals;

bool runs_program(pid_t pid) {
    std::error_code gone;
    const auto program = program_command({}).front();
    return std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/exe", gone) ==
           std::filesystem::canonical(program);
}

template <class Condition>
bool soon(Condition condition) {
    for (int i = 0; i < 100 && !condition(); ++i) std::this_thread::sleep_for(100ms);
    return condition();
}

TEST(Lease, TimeSpentStoppedDoesNotCountSilenceDoes) {
    const Folder folder;
    const auto worker = program_command({"worker", "--artefacts", folder.path().string(), "--lease-seconds", "2"});
    std::string command = R"(while sleep 0.2; do echo '{"lease": true}' || exit; done | exec)";
    for (const auto& word : worker) command += " '" + word + "'";
    Process both({"/bin/bash", "-c", command}, folder.path());
    std::vector<pid_t> pair;
    ASSERT_TRUE(soon([&] {
        pair = both.children();
        return std::ranges::any_of(pair, runs_program);
    }));
    const auto told = std::ranges::find_if(pair, runs_program);
    const auto main_program = std::ranges::find_if_not(pair, runs_program);
    ASSERT_NE(main_program, pair.end());
    const auto alive = [&] { return runs_program(*told); };

    std::this_thread::sleep_for(500ms);
    for (const pid_t pid : pair) ::kill(pid, SIGSTOP);
    std::this_thread::sleep_for(2500ms);
    ::kill(*told, SIGCONT);
    std::this_thread::sleep_for(300ms);  // a main program sends every ten seconds, not at once
    ::kill(*main_program, SIGCONT);
    std::this_thread::sleep_for(1200ms);
    EXPECT_TRUE(alive());

    ::kill(*main_program, SIGSTOP);
    EXPECT_TRUE(soon([&] { return !alive(); }));
    ::kill(*main_program, SIGCONT);
    EXPECT_EQ(both.wait().code, 3);
}

}  // namespace grainsweep::tests::lease_test
