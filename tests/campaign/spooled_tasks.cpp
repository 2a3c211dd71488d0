// A campaign without a main program: tasks share a folder, any of them is killed at any moment, and what is collected
// is what a run would have found.
#include "stats/random.hpp"
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::spooled_tasks_test {

using nlohmann::json;
using stats::Stream;
using testing::HasSubstr;

namespace fs = std::filesystem;

class SpooledCampaign {
public:
    explicit SpooledCampaign(const json& more = json::object()) {
        json config = {{"campaign", "spooled"},
                       {"scene", "rehearsal"},
                       {"factors", {{{"name", "x1"}, {"between", {0, 1}}}, {{"name", "x2"}, {"between", {0, 1}}}}},
                       {"fixed", {{"response", "ishigami"}, {"noise", 0.1}, {"wait_seconds", 0.02}}},
                       {"design", {{"kind", "halton"}, {"points", 120}}}};
        config.merge_patch(more);
        folder_.write("c.json", config.dump());
    }
    [[nodiscard]] std::vector<std::string> task(const std::string& share) const {
        return program_command({"work", "c.json", "--spool", (folder_ / "spool").string(), "--share", share, "-j", "2",
                                "--lease", "2", "--quiet"});
    }
    [[nodiscard]] Ended work(const std::string& share) const { return Process(task(share), folder_.path()).wait(); }
    [[nodiscard]] Ended collect(const std::string& database = "collected.db") const {
        return run_program({"collect", database, "spool"}, folder_.path());
    }
    [[nodiscard]] std::string dump(const std::string& database) const {
        return run_program({"dump", database}, folder_.path()).out;
    }
    void expect_the_rows_of_a_run(const std::string& database = "collected.db", int code = 0) const {
        const auto ended = run_program({"run", "c.json", "--db", "run.db", "-j", "2", "--quiet"}, folder_.path());
        EXPECT_EQ(ended.code, code) << ended.err;
        EXPECT_TRUE(dump("run.db") == dump(database));
        EXPECT_GT(dump("run.db").size(), 500U);
        EXPECT_EQ(run_program({"verify", database}, folder_.path()).code, 0);
    }
    /// Files of cases/ that are answers.
    [[nodiscard]] std::size_t answers() const {
        std::size_t count = 0;
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(folder_ / "spool" / "cases", none)) {
            std::ifstream stream(entry.path());
            std::string line;
            if (std::getline(stream, line) && line.starts_with("grainsweep answer")) ++count;
        }
        return count;
    }
    [[nodiscard]] const Folder& folder() const { return folder_; }

private:
    Folder folder_;
};

TEST(Spool, OneTaskAnswersAllAndTheRowsAreThoseOfARun) {
    const SpooledCampaign campaign;
    const auto ended = campaign.work("1/1");
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(campaign.answers(), 120U);
    const auto collected = campaign.collect();
    EXPECT_EQ(collected.code, 0) << collected.err;
    EXPECT_THAT(collected.out, HasSubstr("120 cases collected, 0 were collected before"));
    campaign.expect_the_rows_of_a_run();
}

// What is collected was computed elsewhere: how long the import took says nothing of the cases that are left.
TEST(Spool, AfterCollectingTheTimeLeftIsNotKnown) {
    const SpooledCampaign campaign;
    {
        Process task(campaign.task("1/1"), campaign.folder().path());
        while (task.running() && campaign.answers() < 20) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        task.signal(SIGKILL);
        task.wait();
    }
    EXPECT_EQ(campaign.collect().code, 1);
    const auto status = run_program({"status", "collected.db", "--format", "json"}, campaign.folder().path());
    const auto row = json::parse(status.out)[0];
    EXPECT_GE(row["completed"].get<int>(), 20);
    EXPECT_TRUE(row["rate"].is_null()) << status.out;
    EXPECT_TRUE(row["time_left"].is_null()) << status.out;
}

TEST(Spool, TasksShareTheWorkAndNothingIsComputedTwice) {
    const SpooledCampaign campaign;
    std::vector<std::unique_ptr<Process>> tasks;
    for (const char* share : {"1/3", "2/3", "3/3"})
        tasks.push_back(std::make_unique<Process>(campaign.task(share), campaign.folder().path()));
    for (const auto& task : tasks) EXPECT_EQ(task->wait().code, 0);
    EXPECT_EQ(campaign.answers(), 120U);
    EXPECT_EQ(campaign.collect().code, 0);
    campaign.expect_the_rows_of_a_run();
}

TEST(Spool, TasksKilledAtSeededMomentsLeaveTheirCasesToOthers) {
    const SpooledCampaign campaign;
    const std::vector<std::string> shares = {"1/3", "2/3", "3/3"};
    std::vector<std::unique_ptr<Process>> tasks;
    for (const auto& share : shares)
        tasks.push_back(std::make_unique<Process>(campaign.task(share), campaign.folder().path()));
    int killed = 0;
    for (std::uint64_t moment = 0; moment < 6; ++moment) {
        while (campaign.answers() < 15 * moment && tasks[moment % 3]->running())
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        std::this_thread::sleep_for(std::chrono::milliseconds(static_cast<int>(40 * Stream(31, moment).uniform(0))));
        const std::size_t victim = Stream(32, moment).bits(0) % 3;
        if (!tasks[victim]->running()) continue;
        tasks[victim]->signal(SIGKILL);
        tasks[victim]->wait();
        ++killed;
        if (moment % 2 == 0) (void)campaign.collect();  // at any time
        // as an array task that is requeued, or none
        if (moment % 3 != 2)
            tasks[victim] = std::make_unique<Process>(campaign.task(shares[victim]), campaign.folder().path());
    }
    EXPECT_GE(killed, 3);
    for (const auto& task : tasks) task->wait();
    EXPECT_EQ(campaign.work("1/1").code, 0);  // where all were killed
    const auto collected = campaign.collect();
    EXPECT_EQ(collected.code, 0) << collected.err << collected.out;
    campaign.expect_the_rows_of_a_run();
}

TEST(Spool, WhatAKilledTaskHadIsTakenOverAfterItsLease) {
    const SpooledCampaign campaign({{"fixed", {{"wait_seconds", 0.3}}}, {"design", {{"points", 8}}}});
    {
        Process task(campaign.task("1/1"), campaign.folder().path());
        while (task.running() && campaign.answers() < 2) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        task.signal(SIGKILL);
        task.wait();
    }
    const auto ended = campaign.work("1/1");
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(campaign.collect().code, 0);
    campaign.expect_the_rows_of_a_run();
}

TEST(Spool, CollectingAgainChangesNothing) {
    const SpooledCampaign campaign(json::object({{"design", {{"points", 20}}}}));
    EXPECT_EQ(campaign.work("1/1").code, 0);
    EXPECT_EQ(campaign.collect().code, 0);
    const auto before = campaign.dump("collected.db");
    const auto again = campaign.collect();
    EXPECT_EQ(again.code, 0) << again.err;
    EXPECT_THAT(again.out, HasSubstr("0 cases collected, 20 were collected before"));
    EXPECT_TRUE(campaign.dump("collected.db") == before);
    const auto attempts = run_program({"query", "collected.db", "SELECT count(*) FROM attempt", "--format", "json"},
                                      campaign.folder().path());
    EXPECT_EQ(json::parse(attempts.out).at(0).front(), 20);
}

TEST(Spool, WhatIsAnsweredSoFarIsCollectedAndTheRestLater) {
    const SpooledCampaign campaign({{"fixed", {{"wait_seconds", 0.1}}}, {"design", {{"points", 30}}}});
    {
        Process task(campaign.task("1/1"), campaign.folder().path());
        while (task.running() && campaign.answers() < 8) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        task.signal(SIGTERM);
        EXPECT_EQ(task.wait().code, 75);
    }
    const auto first = campaign.collect();
    EXPECT_EQ(first.code, 1);
    EXPECT_THAT(first.out, HasSubstr("have no result yet"));
    EXPECT_EQ(campaign.work("1/1").code, 0);
    EXPECT_EQ(campaign.collect().code, 0);
    campaign.expect_the_rows_of_a_run();
}

TEST(Spool, DamagedAndForeignFilesAreNamedAndComputedAgain) {
    const SpooledCampaign campaign(json::object({{"design", {{"points", 10}}}}));
    EXPECT_EQ(campaign.work("1/1").code, 0);
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(campaign.folder() / "spool" / "cases")) files.push_back(entry);
    std::ranges::sort(files);
    ASSERT_EQ(files.size(), 10U);
    fs::resize_file(files[0], fs::file_size(files[0]) / 2);
    std::fstream(files[1], std::ios::in | std::ios::out | std::ios::binary).seekp(100).put('\0');
    fs::copy_file(files[2], files[2].parent_path() / (std::string(32, 'a') + ".1"));
    const auto collected = campaign.collect();
    EXPECT_EQ(collected.code, 1);
    EXPECT_THAT(collected.err, HasSubstr(files[0].filename().string()));
    EXPECT_THAT(collected.err, HasSubstr(files[1].filename().string()));
    EXPECT_THAT(collected.err, HasSubstr(std::string(32, 'a')));
    EXPECT_THAT(collected.out, HasSubstr("8 cases collected"));
    EXPECT_EQ(campaign.work("1/1").code, 0);
    EXPECT_THAT(campaign.collect().out, HasSubstr("2 cases collected, 8 were collected before"));
    campaign.expect_the_rows_of_a_run();
}

TEST(Spool, CasesThatFailAreTriedAsOftenAsInARun) {
    const SpooledCampaign campaign({{"factors", {{{"name", "behaviour"}, {"levels", {"normal", "crash", "unstable"}}}}},
                                    {"fixed", nullptr},
                                    {"design", {{"kind", "lattice"}, {"points", nullptr}}},
                                    {"limits", {{"attempts", 2}}}});
    EXPECT_EQ(campaign.work("1/1").code, 1);
    EXPECT_EQ(campaign.collect().code, 1);
    campaign.expect_the_rows_of_a_run("collected.db", 1);
    const auto crashed = run_program(
        {"query", "collected.db", "SELECT attempts FROM spooled WHERE outcome = 'crashed'", "--format", "json"},
        campaign.folder().path());
    EXPECT_EQ(json::parse(crashed.out).at(0).front(), 2);
    EXPECT_THAT(campaign.collect().out, HasSubstr("0 cases collected, 3 were collected before"));
}

TEST(Spool, ACampaignWithAWalltimeGoesOnFromItsCheckpoints) {
    const SpooledCampaign campaign(
        {{"fixed", {{"wait_seconds", 7}}}, {"design", {{"points", 2}}}, {"execution", {{"walltime", 4}}}});
    auto ended = campaign.work("1/1");
    EXPECT_EQ(ended.code, 75) << ended.err;
    for (int runs = 0; runs < 5 && ended.code == 75; ++runs) ended = campaign.work("1/1");
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(campaign.collect().code, 0);
}

TEST(Spool, ConvergenceIsJudgedWhenCollecting) {
    const SpooledCampaign campaign(
        {{"fixed", {{"wait_seconds", 0}}},
         {"design", {{"kind", "halton"}, {"sequences", 8}, {"points", 400}}},
         {"convergence", {{"observable", "y"}, {"tolerance", 0.5}, {"block", 80}, {"stop", false}}}});
    EXPECT_EQ(campaign.work("1/1").code, 0);
    EXPECT_EQ(campaign.collect().code, 0);
    EXPECT_THAT(campaign.dump("collected.db"), HasSubstr("convergence y 80"));
    campaign.expect_the_rows_of_a_run();
}

TEST(Spool, WhatFollowsFromAnswersIsRefused) {
    const SpooledCampaign stops(
        {{"convergence", {{"observable", "y"}, {"block", 60}}}, {"design", {{"sequences", 4}}}});
    auto ended = stops.work("1/1");
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("$.convergence.stop"));
    EXPECT_FALSE(fs::exists(stops.folder() / "spool"));
    const SpooledCampaign other;
    EXPECT_EQ(other.work("4/3").code, 2);
    EXPECT_EQ(other.work("1/3").code, 0);
    EXPECT_EQ(run_program({"collect", "x.db", "nowhere"}, other.folder().path()).code, 2);
}

TEST(Spool, AFolderOfAnotherCampaignIsRefused) {
    const SpooledCampaign campaign(json::object({{"design", {{"points", 3}}}}));
    EXPECT_EQ(campaign.work("1/1").code, 0);
    auto config = json::parse(std::ifstream(campaign.folder() / "c.json"));
    config["design"]["points"] = 4;
    campaign.folder().write("c.json", config.dump());
    const auto ended = campaign.work("1/1");
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("is a spool of other cases"));
}

TEST(Spool, TheArrayOfTheJobGivesTheShare) {
    const SpooledCampaign campaign(json::object({{"design", {{"points", 3}}}}));
    std::vector<std::string> command = {"/usr/bin/env", "SLURM_ARRAY_TASK_ID=14", "SLURM_ARRAY_TASK_MIN=10",
                                        "SLURM_ARRAY_TASK_STEP=2", "SLURM_ARRAY_TASK_COUNT=4"};
    for (const auto& word : program_command({"work", "c.json", "--spool", "spool", "--format", "json"}))
        command.push_back(word);
    const auto ended = Process(command, campaign.folder().path()).wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(json::parse(ended.out).at("share"), "3/4");
}

}  // namespace grainsweep::tests::spooled_tasks_test
