// A run that may take so long and no longer: it ends in time with exit code 75, and run after run the campaign ends in
// the science of an undisturbed one.
#include "tests/support/progress.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

namespace grainsweep::tests::limited_time_test {

using nlohmann::json;
using testing::HasSubstr;

constexpr int again = 75;

class LimitedCampaign {
public:
    LimitedCampaign(int points, double seconds, double walltime) {
        json config = {{"campaign", "limited"},
                       {"scene", "rehearsal"},
                       {"factors", {{{"name", "x1"}, {"between", {0, 1}}}}},
                       {"fixed", {{"noise", 0.1}, {"wait_seconds", seconds}}},
                       {"design", {{"kind", "halton"}, {"points", points}}}};
        folder_.write("calm.json", config.dump());
        config["execution"] = {{"walltime", walltime}};
        folder_.write("c.json", config.dump());
    }
    [[nodiscard]] std::vector<std::string> command(const std::string& config = "c.json") const {
        return program_command({"run", config, "--db", config + ".db", "-j", "2", "--quiet"});
    }
    [[nodiscard]] Ended run(const std::string& config = "c.json") const {
        return Process(command(config), folder_.path()).wait();
    }
    [[nodiscard]] std::string dump(const std::string& config) const {
        return run_program({"dump", config + ".db"}, folder_.path()).out;
    }
    void expect_the_science_of_a_calm_run() const {
        EXPECT_EQ(run("calm.json").code, 0);
        EXPECT_TRUE(dump("c.json") == dump("calm.json"));
        EXPECT_GT(dump("c.json").size(), 100U);
    }
    [[nodiscard]] std::int64_t ask(const std::string& sql) const { return number_in(folder_ / "c.json.db", sql); }
    [[nodiscard]] const Folder& folder() const { return folder_; }

private:
    Folder folder_;
};

TEST(Walltime, RunAfterRunTheCampaignIsFinished) {
    const LimitedCampaign campaign(16, 0.25, 2);
    int runs = 1;
    Ended ended;
    for (; runs < 10; ++runs) {
        const auto start = std::chrono::steady_clock::now();
        ended = campaign.run();
        EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
        if (ended.code != again) break;
    }
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_GT(runs, 1);
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'crashed'"), 0);
    campaign.expect_the_science_of_a_calm_run();
}

TEST(Walltime, ACaseLongerThanARunGoesOnInTheNext) {
    const LimitedCampaign campaign(1, 7, 4);
    auto ended = campaign.run();
    EXPECT_EQ(ended.code, again) << ended.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'abandoned'"), 1);
    for (int runs = 0; runs < 5 && ended.code == again; ++runs) ended = campaign.run();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_GE(campaign.ask("SELECT count(*) FROM attempt"), 2);
    campaign.expect_the_science_of_a_calm_run();
}

TEST(Walltime, CheckpointsLieWhereAllNodesSeeThem) {
    const LimitedCampaign campaign(1, 7, 4);
    auto command = campaign.command();
    command.insert(command.end(), {"--artefacts", (campaign.folder() / "for all").string()});
    auto ended = Process(command, campaign.folder().path()).wait();
    EXPECT_EQ(ended.code, again) << ended.err;
    EXPECT_FALSE(std::filesystem::is_empty(campaign.folder() / "for all"));
    EXPECT_FALSE(std::filesystem::exists(campaign.folder() / "c.json.artefacts"));
    for (int runs = 0; runs < 5 && ended.code == again; ++runs)
        ended = Process(command, campaign.folder().path()).wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_LT(campaign.ask("SELECT max(wall_seconds) FROM attempt"), 6) << "it went on from there";
}

TEST(Walltime, ASystemThatAsksGetsTheSameAnswer) {
    for (const int signal : {SIGTERM, SIGUSR1}) {
        const LimitedCampaign campaign(2, 5, 600);
        {
            Process run(campaign.command(), campaign.folder().path());
            await_number(run, campaign.folder() / "c.json.db", "SELECT count(*) FROM attempt", 2);
            std::this_thread::sleep_for(std::chrono::milliseconds(300));
            run.signal(signal);
            run.signal(signal);  // a container and a script that passes it on
            const auto ended = run.wait();
            EXPECT_EQ(ended.code, again) << ended.err;
        }
        EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'abandoned'"), 2);
        EXPECT_EQ(campaign.run().code, 0);
        EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'completed' AND wall_seconds < 4.9"), 2)
            << "both go on from where they were";
    }
}

TEST(Walltime, TheEndOfTheJobIsOne) {
    const LimitedCampaign campaign(1, 60, 0);
    const auto now =
        std::chrono::duration_cast<std::chrono::seconds>(std::chrono::system_clock::now().time_since_epoch());
    std::vector<std::string> command = {"/usr/bin/env", "SLURM_JOB_END_TIME=" + std::to_string(now.count() + 4)};
    for (const auto& word : campaign.command()) command.push_back(word);
    const auto ended = Process(command, campaign.folder().path()).wait();
    EXPECT_EQ(ended.code, again) << ended.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'abandoned'"), 1);
}

}  // namespace grainsweep::tests::limited_time_test
