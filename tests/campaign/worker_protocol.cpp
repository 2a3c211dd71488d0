// Workers that break the protocol: nothing wrong is let in, nothing grows without bound, and the campaign ends.
#include "tests/support/scripted_worker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

namespace grainsweep::tests::worker_protocol_test {

using nlohmann::json;
using testing::HasSubstr;

const char* completed = "SELECT count(*) FROM scripted WHERE outcome = 'completed'";

TEST(WorkerProtocol, AScriptThatKeepsToItIsAWorker) {
    const ScriptedCampaign campaign(R"(say "$ready"; while next; do begun; done_with completed '"y":2'; done)");
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM scripted WHERE y = 2"), 3);
}

TEST(WorkerProtocol, AnswersOfAnotherBuildAreNotStored) {
    for (const char* part : {"version", "commit", "build"}) {
        const ScriptedCampaign campaign("say \"${ready/\\\"" + std::string(part) + "\\\":\\\"/\\\"" + part +
                                        R"(\":\"other}"; while next; do begun; done_with completed '"y":2'; done)");
        const auto run = campaign.run();
        EXPECT_EQ(run.code, 3) << run.err;
        EXPECT_THAT(run.err, HasSubstr("the main program is"));
        EXPECT_EQ(campaign.ask(completed), 0) << part;
        EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt"), 0) << "it was given no case";
    }
}

TEST(WorkerProtocol, AnswersWithoutReadyAreNotStored) {
    const ScriptedCampaign campaign(R"(read -t 0.3 -r line
[[ $line =~ \"id\":\"([0-9a-f]+)\" ]] && id=${BASH_REMATCH[1]}
number=1; attempt="\"attempt\":1,\"id\":\"$id\""
begun; done_with completed '"y":2'; sleep 100)");
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr("the worker answered before it was ready"));
    EXPECT_EQ(campaign.ask(completed), 0);
}

// The answer behind the nonsense is well formed, and to a case that was begun.
TEST(WorkerProtocol, NothingCountsAfterNonsense) {
    const ScriptedCampaign campaign(
        R"(say "$ready"; while next; do begun; say nonsense; done_with completed '"y":2'; done)", 3,
        {{"limits", {{"attempts", 2}}}});
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM scripted WHERE outcome = 'crashed' AND y IS NULL AND attempts = 2"),
              3);
    EXPECT_THAT(campaign.ask("SELECT message FROM attempt LIMIT 1").get<std::string>(),
                HasSubstr("the worker wrote something that is no message: nonsense"));
}

TEST(WorkerProtocol, AnAnswerToWhatWasNotBegunIsNotStored) {
    const ScriptedCampaign campaign(R"(say "$ready"; while next; do done_with completed '"y":2'; done)");
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr("the worker answered a case it had not begun"));
    EXPECT_EQ(campaign.ask(completed), 0);
    EXPECT_EQ(campaign.ask("SELECT sum(failures) FROM sim_case"), 0) << "no case was begun, none has failed";
}

TEST(WorkerProtocol, ACrashThatIsToldKeepsNoNumbers) {
    const ScriptedCampaign campaign(R"(say "$ready"; while next; do begun; done_with crashed '"y":2'; done)", 2);
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM scripted WHERE outcome = 'crashed' AND attempts = 3"), 2);
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM observation"), 0);
}

TEST(WorkerProtocol, WhatTheSceneDoesNotMeasureIsRefused) {
    const ScriptedCampaign campaign(R"(say "$ready"; while next; do begun; done_with completed '"y":2,"z":3'; done)",
                                    1);
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM observable WHERE name = 'z'"), 0);
    EXPECT_THAT(campaign.ask("SELECT message FROM attempt LIMIT 1").get<std::string>(), HasSubstr("'z'"));
}

TEST(WorkerProtocol, ALauncherMayGreet) {
    const ScriptedCampaign campaign("echo Welcome to node 3; exec \"$@\"");
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("'Welcome to node 3'"));
    EXPECT_EQ(campaign.ask(completed), 3);
}

// ---- what computed --------------------------------------------------------------------------------------------------

TEST(WorkerProtocol, AnAttemptCarriesWhatComputedIt) {
    const ScriptedCampaign campaign(
        R"X("$@" | sed -u -e 's/"host":"[^"]*"/"host":"node7"/' -e 's/"path":"[^"]*"/"path":"avx2"/')X");
    ASSERT_EQ(campaign.run().code, 0);
    const std::string id = campaign.query("SELECT case_id FROM scripted LIMIT 1")[0]["case_id"];
    const auto explained = run_program({"explain", "scripted.db", id, "--format", "json"}, campaign.folder().path());
    const auto attempt = json::parse(explained.out)["attempts"][0];
    EXPECT_EQ(attempt["host"], "node7");
    EXPECT_EQ(attempt["instruction_path"], "avx2");
    EXPECT_FALSE(attempt["processor"].get<std::string>().empty());
    EXPECT_FALSE(attempt["build"].get<std::string>().empty());
    // A replay takes the path from the attempt, not from the run.
    const auto replayed = run_program({"replay", "scripted.db", id, "--format", "json"}, campaign.folder().path());
    EXPECT_EQ(json::parse(replayed.out)["same_path"], true) << replayed.out;
    EXPECT_EQ(campaign.ask("SELECT instruction_path <> 'avx2' OR host <> 'node7' FROM provenance"), 1);
}

// ---- bounds --------------------------------------------------------------------------------------------------------

TEST(WorkerProtocol, OutputWithoutANewlineIsCutOff) {
    const ScriptedCampaign campaign(R"(say "$ready"; next; begun; exec cat /dev/zero)", 1,
                                    {{"limits", {{"attempts", 1}}}});
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_THAT(campaign.ask("SELECT message FROM attempt").get<std::string>(), HasSubstr("a line of more than 16 MB"));
    EXPECT_LT(run.most_memory, 200);
}

TEST(WorkerProtocol, AFloodBeforeReadyIsCutOff) {
    const ScriptedCampaign campaign(R"(exec yes welcome)");
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr("before a worker was ready: welcome"));
    EXPECT_LT(run.most_memory, 200);
}

TEST(WorkerProtocol, AFloodOfHeartbeatsIsCutOff) {
    const ScriptedCampaign campaign(R"(say "$ready"; next; begun; exec yes "{\"alive\":{$attempt,\"progress\":0.5}}")",
                                    1, {{"limits", {{"attempts", 1}}}});
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_THAT(campaign.ask("SELECT message FROM attempt").get<std::string>(),
                HasSubstr("signs of life within a second"));
    EXPECT_LT(run.most_memory, 200);
}

TEST(WorkerProtocol, AFloodOfComplaintsIsKeptShort) {
    const ScriptedCampaign campaign(R"(say "$ready"; next; begun; yes complaint | head -c 20000000 >&2; exit 1)", 1,
                                    {{"limits", {{"attempts", 1}}}});
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_LT(run.err.size(), 5000U);
    EXPECT_LT(campaign.ask("SELECT length(message) FROM attempt").get<int>(), 9000);
    EXPECT_LT(run.most_memory, 200);
}

TEST(WorkerProtocol, AWorkerThatAlwaysGivesBackIsNotAskedForEver) {
    const ScriptedCampaign campaign(R"(say "$ready"; while next; do begun; give_back; done)", 2);
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_EQ(campaign.ask("SELECT max(attempts) FROM scripted WHERE outcome = 'abandoned'"), 10);
    EXPECT_EQ(campaign.ask("SELECT sum(failures) FROM sim_case"), 0);
    EXPECT_THAT(
        campaign.query("SELECT message FROM attempt ORDER BY number DESC LIMIT 1")[0]["message"].get<std::string>(),
        HasSubstr("by the script; given back too often"));
    EXPECT_EQ(run_program({"run", "c.json", "--quiet", "--max-cases", "1"}, campaign.folder().path()).code, 1);
    EXPECT_EQ(campaign.ask("SELECT max(attempts) FROM scripted"), 20) << "the next run tries again";
}

TEST(WorkerProtocol, AWorkerThatGivesBackAndStaysIsReplaced) {
    const ScriptedCampaign campaign(R"(mkdir first 2>/dev/null || exec "$@"
say "$ready"; next; begun; give_back; trap '' TERM; while true; do sleep 1000; done)",
                                    2);
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(campaign.ask("SELECT max(attempts) FROM scripted WHERE outcome = 'completed'"), 2);
}

TEST(WorkerProtocol, AWorkerThatBeginsNothingIsABrokenWorld) {
    const ScriptedCampaign campaign(R"(say "$ready"; while next; do give_back; done)", 100);
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr("cannot start workers with"));
    EXPECT_LT(campaign.ask("SELECT count(*) FROM attempt").get<int>(), 20);
}

// Little address space, no threads left: whether it ends before or after its first case is written to it is chance.
TEST(WorkerProtocol, AWorkerThatEndsOnceItIsReadyIsABrokenWorld) {
    for (const char* workers : {"1", "2", "3"}) {
        const ScriptedCampaign campaign(R"(echo >> launches; say "$ready"; echo no threads left >&2; exit 1)");
        const auto run = campaign.run({"-j", workers});
        EXPECT_EQ(run.code, 3) << run.err;
        EXPECT_THAT(run.err, HasSubstr("cannot start workers with"));
        EXPECT_THAT(run.err, HasSubstr("no threads left"));
        EXPECT_LT(std::filesystem::file_size(campaign.folder() / "launches"), 20U) << "launches";
    }
}

TEST(WorkerProtocol, MoreWorkersThanDescriptorsAreAsManyAsCanBe) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "many", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "fixed": {"wait_seconds": 0.3}, "design": {"kind": "random", "points": 60}})");
    std::vector<std::string> argv = {"/bin/bash", "-c", "ulimit -n 96; \"$@\"", "bash"};
    const auto command = program_command({"run", "c.json", "--quiet", "-j", "60"});
    argv.insert(argv.end(), command.begin(), command.end());
    const auto run = Process(argv, folder.path()).wait();
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("cannot start another worker"));
    EXPECT_THAT(run.err, HasSubstr("Too many open files"));
}

// ---- the worker's side ---------------------------------------------------------------------------------------------

TEST(WorkerProtocol, GarbageOnAWorkersInputEndsItWithASentence) {
    const Folder folder;
    for (const char* garbage : {"echo garbage", "echo '{\"run\": {\"id\": 3}}'", "cat /dev/zero"}) {
        const std::string script = std::string(garbage) + R"( | "$0" worker; exit ${PIPESTATUS[1]})";
        const auto ended = Process({"/bin/bash", "-c", script, program_command({}).front()}, folder.path()).wait();
        EXPECT_EQ(ended.code, 2) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr("grainsweep worker: standard input is not the main program's: "));
        EXPECT_LT(ended.err.size(), 1000U);
        EXPECT_LT(ended.most_memory, 200);
    }
}

}  // namespace grainsweep::tests::worker_protocol_test
