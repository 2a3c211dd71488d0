// Main program and workers are killed at seeded moments; the campaign is resumed and must end in the same science.
#include "stats/random.hpp"
#include "tests/support/progress.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

namespace grainsweep::tests::kill_and_resume_test {

using stats::Stream;

constexpr int cases = 240;

const char* config = R"({
  "campaign": "killed",
  "scene": "rehearsal",
  "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}, {"name": "x3", "between": [0, 1]}],
  "fixed": {"response": "ishigami", "noise": 0.1, "wait_seconds": 0.004},
  "design": {"kind": "halton", "points": 240},
  "limits": {"attempts": 1000}
})";

std::string dump(const std::filesystem::path& db, const Folder& folder) {
    const auto ended = run_program({"dump", db.string()}, folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    return ended.out;
}

/// The dump of an undisturbed campaign.
std::string undisturbed(const Folder& folder, const std::string& workers) {
    const auto db = folder / ("calm" + workers + ".db");
    const auto ended = run_program({"run", (folder / "c.json").string(), "--db", db.string(), "-j", workers, "--quiet"},
                                   folder.path());
    EXPECT_EQ(ended.code, 0) << ended.err;
    return dump(db, folder);
}

/// No worker of this database lives on: waits a moment for the kernel to deliver the news.
void expect_no_orphans(const std::filesystem::path& db) {
    for (int tries = 0; tries < 200 && !processes_with(db.string()).empty(); ++tries) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    EXPECT_TRUE(processes_with(db.string()).empty()) << "a process outlived its main program";
}

TEST(KillAndResume, OneAndFourWorkersGiveTheSameDump) {
    const Folder folder;
    folder.write("c.json", config);
    const std::string one = undisturbed(folder, "1");
    EXPECT_GT(one.size(), 1000U);
    EXPECT_TRUE(one == undisturbed(folder, "4"));
}

// Workers overshoot the stopping point by what is under way; that must not show.
TEST(KillAndResume, AConvergedCampaignStopsAtTheSamePointWithOneAndFourWorkers) {
    const Folder folder;
    folder.write("c.json", R"({
      "campaign": "stopping", "scene": "rehearsal",
      "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
      "fixed": {"response": "spreading_a", "noise": 0.05},
      "design": {"kind": "halton", "sequences": 8, "points": 20000},
      "convergence": {"observable": "y", "tolerance": 0.02, "block": 200}})");
    const std::string one = undisturbed(folder, "1");
    EXPECT_TRUE(one == undisturbed(folder, "4"));
    const auto status = run_program({"status", (folder / "calm4.db").string(), "--format", "json"}, folder.path());
    EXPECT_NE(status.out.find("\"stopped_at\""), std::string::npos);
    EXPECT_EQ(status.out.find("\"stopped_at\":null"), std::string::npos) << status.out;
}

TEST(KillAndResume, MainProgramKilledAtTwentySeededMoments) {
    const Folder folder;
    constexpr int few = 100;
    std::string fewer = config;
    fewer.replace(fewer.find("240"), 3, std::to_string(few));
    folder.write("c.json", fewer);
    const std::string calm = undisturbed(folder, "2");
    for (std::uint64_t moment = 0; moment < 20; ++moment) {
        const auto db = folder / ("killed" + std::to_string(moment) + ".db");
        const auto command =
            program_command({"run", (folder / "c.json").string(), "--db", db.string(), "-j", "2", "--quiet"});
        {
            Process run(command, folder.path());
            await_settled(run, db, static_cast<std::int64_t>(Stream(11, moment).uniform(0) * few));
            run.signal(SIGKILL);
            run.wait();
        }
        expect_no_orphans(db);
        const auto ended = Process(command, folder.path()).wait();
        EXPECT_EQ(ended.code, 0) << ended.err;
        EXPECT_TRUE(dump(db, folder) == calm) << "killed at moment " << moment;
    }
}

TEST(KillAndResume, WorkersKilledAtTwentySeededMoments) {
    const Folder folder;
    folder.write("c.json", config);
    const std::string calm = undisturbed(folder, "2");
    const auto db = folder / "workers.db";
    const auto command =
        program_command({"run", (folder / "c.json").string(), "--db", db.string(), "-j", "2", "--quiet"});
    Process run(command, folder.path());
    int killed = 0;
    for (std::uint64_t moment = 0; moment < 20; ++moment) {
        await_settled(run, db, static_cast<std::int64_t>(static_cast<double>(moment) / 20 * cases));
        const auto workers = run.children();
        if (workers.empty()) continue;
        const auto victim = static_cast<std::size_t>(Stream(12, moment).bits(0) % workers.size());
        ::kill(workers[victim], SIGKILL);
        ++killed;
    }
    EXPECT_GE(killed, 15);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_TRUE(dump(db, folder) == calm);
    expect_no_orphans(db);
}

TEST(KillAndResume, AnInterruptedRunParksAndGoesOn) {
    const Folder folder;
    folder.write("c.json", config);
    const std::string calm = undisturbed(folder, "2");
    const auto db = folder / "interrupted.db";
    const auto command =
        program_command({"run", (folder / "c.json").string(), "--db", db.string(), "-j", "2", "--quiet"});
    {
        Process run(command, folder.path());
        await_settled(run, db, cases / 3);
        run.signal(SIGINT);
        EXPECT_EQ(run.wait().code, 130);
    }
    const auto settled = number_in(db, "SELECT count(outcome) FROM sim_case");
    EXPECT_LT(settled, cases);
    EXPECT_GE(settled, cases / 3);
    expect_no_orphans(db);
    const auto ended = Process(command, folder.path()).wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_TRUE(dump(db, folder) == calm);
}

}  // namespace grainsweep::tests::kill_and_resume_test
