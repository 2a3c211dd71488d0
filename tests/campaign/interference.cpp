// What comes from outside is no failure of a case: signals that ask, frozen workers, a main program that is stopped.
#include "tests/support/scripted_worker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::interference_test {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;

// What the worker writes is kept in a file, and the interval between checkpoints is short.
const char* plain = "exec \"$@\" --checkpoint-seconds 0.1 > >(exec tee -a lines)";

bool runs_program(pid_t pid) {
    std::error_code gone;
    return std::filesystem::read_symlink("/proc/" + std::to_string(pid) + "/exe", gone) ==
           std::filesystem::canonical(program_command({}).front());
}

/// Waits until a worker has saved a case, or the run is over. Cases here are not started before their workers are
/// ready.
bool await_checkpoint(Process& run, const ScriptedCampaign& campaign) {
    const auto whole_files = [&] {
        std::error_code absent;
        for (const auto& entry : std::filesystem::directory_iterator(campaign.folder() / "scripted.artefacts", absent))
            if (entry.path().extension() == ".artefact") return true;
        return false;
    };
    while (run.running() && !whole_files()) std::this_thread::sleep_for(1ms);
    return run.running();
}

pid_t worker_of(const Process& run) {
    for (const pid_t pid : run.children())
        if (runs_program(pid)) return pid;
    return -1;
}

/// One case of a second and a half that may fail but once; `signal` hits its worker in the middle of it.
struct Hit {
    ScriptedCampaign campaign;
    Ended ended;

    Hit(int signal, int attempts)
        : campaign(plain, 1, {{"fixed", {{"wait_seconds", 1.5}}}, {"limits", {{"attempts", attempts}}}}) {
        Process run(campaign.command(), campaign.folder().path());
        if (await_checkpoint(run, campaign)) ::kill(worker_of(run), signal);
        ended = run.wait();
    }
    /// Attempts that began from a checkpoint.
    [[nodiscard]] int resumed() const {
        std::ifstream lines(campaign.folder() / "lines");
        int count = 0;
        for (std::string line; std::getline(lines, line);)
            count += line.find("\"resumed\":true") != std::string::npos ? 1 : 0;
        return count;
    }
    [[nodiscard]] json attempts() const {
        return campaign.query("SELECT outcome, message, wall_seconds AS took FROM attempt ORDER BY number");
    }
};

TEST(Interference, ASignalThatAsksIsNoFailureOfTheCase) {
    for (const int signal : {SIGTERM, SIGINT, SIGUSR1}) {
        const Hit hit(signal, 1);
        EXPECT_EQ(hit.ended.code, 0) << hit.ended.err;
        const auto rows = hit.attempts();
        ASSERT_EQ(rows.size(), 2U) << signal;
        EXPECT_EQ(rows[0]["outcome"], "abandoned");
        EXPECT_THAT(rows[0]["message"].get<std::string>(), HasSubstr("by signal " + std::to_string(signal)));
        EXPECT_EQ(rows[1]["outcome"], "completed");
        EXPECT_EQ(hit.resumed(), 1) << "it goes on from its checkpoint";
        EXPECT_EQ(hit.campaign.ask("SELECT failures FROM sim_case"), 0);
    }
}

TEST(Interference, ARetryAfterACrashDoesNotStartFromItsCheckpoint) {
    const Hit hit(SIGSEGV, 2);
    EXPECT_EQ(hit.ended.code, 0) << hit.ended.err;
    const auto rows = hit.attempts();
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0]["outcome"], "crashed");
    EXPECT_EQ(rows[1]["outcome"], "completed");
    EXPECT_EQ(hit.resumed(), 0);
    EXPECT_GE(rows[1]["took"], 1.5) << "from its beginning";
}

TEST(Interference, AFrozenWorkerIsReplacedAtNoCostOfTheCase) {
    const ScriptedCampaign campaign(
        plain, 2,
        {{"fixed", {{"wait_seconds", 1.5}}}, {"limits", {{"attempts", 1}}}, {"execution", {{"silence_seconds", 3}}}});
    Process run(campaign.command(), campaign.folder().path());
    ASSERT_TRUE(await_checkpoint(run, campaign));
    const pid_t frozen = worker_of(run);
    ::kill(frozen, SIGSTOP);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("waiting for a sign of life of worker " + std::to_string(frozen)));
    EXPECT_THAT(ended.err, HasSubstr("gave no sign of life for 3 s and is replaced"));
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'abandoned'"), 1);
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM scripted WHERE outcome = 'completed'"), 2);
    EXPECT_FALSE(runs_program(frozen)) << "it does not live on";
}

TEST(Interference, AWorkerThatIsNeverReadyIsReplaced) {
    const ScriptedCampaign campaign("mkdir first 2>/dev/null && sleep 1000; exec \"$@\"", 2,
                                    {{"execution", {{"start_seconds", 1}}}});
    const auto ended = campaign.run();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("to be ready, "));
    EXPECT_THAT(ended.err, HasSubstr("was not ready within 1 s and is replaced"));
    EXPECT_EQ(campaign.ask("SELECT max(attempts) FROM scripted"), 1);
}

TEST(Interference, WorkersThatAreNeverReadyEndTheRun) {
    const ScriptedCampaign campaign("echo queued; exec sleep 1000", 2, {{"execution", {{"start_seconds", 0.3}}}});
    const auto ended = campaign.run();
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("was not ready within 0.3 s"));
    EXPECT_THAT(ended.err, HasSubstr("before that: queued"));
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt"), 0);
}

// Limits are of the main program's own running time: silence, a case's wall time and the lease all pass while it is
// stopped.
TEST(Interference, AMainProgramThatIsStoppedForAWhileCostsNothing) {
    const ScriptedCampaign campaign("exec \"$@\" --lease-seconds 15", 8,
                                    {{"fixed", {{"wait_seconds", 0.5}}},
                                     {"limits", {{"attempts", 1}, {"wall_seconds", 3}}},
                                     {"execution", {{"silence_seconds", 3}, {"workers", 2}}}});
    Process run(campaign.command(), campaign.folder().path());
    while (run.running() && worker_of(run) < 0) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(700ms);
    ASSERT_TRUE(run.running());
    run.signal(SIGSTOP);
    std::this_thread::sleep_for(3500ms);
    run.signal(SIGCONT);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(ended.err, "");
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM scripted WHERE outcome = 'completed' AND attempts = 1"), 8);
}

// The main program is stopped for so long that its workers give it up: what they had is given back when it goes on.
TEST(Interference, AMainProgramThatIsStoppedForLongFindsItsCasesGivenBack) {
    const ScriptedCampaign campaign("exec \"$@\" --lease-seconds 2", 1,
                                    {{"fixed", {{"wait_seconds", 7}}}, {"limits", {{"attempts", 1}}}});
    Process run(campaign.command(), campaign.folder().path());
    while (run.running() && worker_of(run) < 0) std::this_thread::sleep_for(1ms);
    std::this_thread::sleep_for(500ms);
    run.signal(SIGSTOP);
    const pid_t worker = worker_of(run);
    for (int tries = 0; tries < 1000 && runs_program(worker); ++tries) std::this_thread::sleep_for(10ms);
    EXPECT_FALSE(runs_program(worker));
    run.signal(SIGCONT);
    run.signal(SIGINT);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 130) << ended.err;
    EXPECT_EQ(campaign.ask("SELECT outcome FROM attempt"), "abandoned");
    EXPECT_THAT(campaign.ask("SELECT message FROM attempt").get<std::string>(),
                HasSubstr("got no message from the main program"));
    EXPECT_EQ(campaign.ask("SELECT failures FROM sim_case"), 0);
}

}  // namespace grainsweep::tests::interference_test
