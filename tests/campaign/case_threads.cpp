// One case on several threads within a campaign: the answers are those of one thread, whatever the number is and
// however it changes on the way.
#include "tests/support/process.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>

namespace grainsweep::tests::case_threads_test {

using nlohmann::json;
using testing::HasSubstr;

// Particles enough for three threads; the last case takes several times as long as the others.
json drum(const json& execution) {
    return {{"campaign", "drum"},
            {"scene", "rotating_drum"},
            {"factors", {{{"name", "turning_time"}, {"levels", {0.002, 0.004, 0.2}}}}},
            {"fixed",
             {{"particles", 3000},
              {"drum_diameter", 0.12},
              {"length", 0.08},
              {"measured_time", 0.002},
              {"frame_interval", 0.002}}},
            {"design", {{"kind", "lattice"}}},
            {"execution", execution}};
}

class Drum : public testing::Test {
protected:
    void run(const std::string& name, const json& execution, const std::vector<std::string>& more = {}) {
        folder.write(name + ".json", drum(execution).dump());
        std::vector<std::string> command = {"run", name + ".json", "--db", name + ".db", "--quiet"};
        command.insert(command.end(), more.begin(), more.end());
        const auto ended = run_program(command, folder.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
    }
    [[nodiscard]] std::string dump(const std::string& name) const {
        return run_program({"dump", name + ".db"}, folder.path()).out;
    }
    [[nodiscard]] json ask(const std::string& name, const std::string& sql) const {
        const auto ended = run_program({"query", name + ".db", sql, "--format", "json"}, folder.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
        return json::parse(ended.out).at(0).front();
    }

    Folder folder;
};

TEST_F(Drum, TheAnswersAreThoseOfOneThread) {
    run("one", {{"threads", 1}}, {"-j", "2"});
    const auto expected = dump("one");
    EXPECT_GT(expected.size(), 1000U);
    EXPECT_EQ(ask("one", "SELECT max(threads) FROM attempt"), 1);
    run("auto_1", {{"threads", "auto"}}, {"-j", "1"});
    EXPECT_TRUE(dump("auto_1") == expected);
    EXPECT_EQ(ask("auto_1", "SELECT max(threads) FROM attempt"), 1) << "-j 1 is one core";
    run("auto_2", json::object(), {"-j", "2"});
    EXPECT_TRUE(dump("auto_2") == expected);
    if (std::thread::hardware_concurrency() > 1) {
        EXPECT_GT(ask("auto_2", "SELECT max(threads) FROM attempt"), 1) << "the last case had a core to spare";
    }
    run("three", {{"threads", 3}}, {"-j", "1"});
    EXPECT_TRUE(dump("three") == expected);
    EXPECT_GT(ask("three", "SELECT min(threads) FROM attempt"), 1);
    run("hosted", {{"hosts", 1}, {"workers_per_host", 2}});
    EXPECT_TRUE(dump("hosted") == expected);
    EXPECT_GT(ask("hosted", "SELECT max(threads) FROM attempt"), 1) << "a host has a core for each of its workers";
    const auto worked = run_program({"work", "three.json", "--spool", "spool", "--quiet"}, folder.path());
    EXPECT_EQ(worked.code, 0) << worked.err;
    EXPECT_EQ(run_program({"collect", "spooled.db", "spool", "--quiet"}, folder.path()).code, 0);
    EXPECT_TRUE(dump("spooled") == expected);
    EXPECT_GT(ask("spooled", "SELECT max(threads) FROM attempt"), 1);
}

/// Lets a run come to its first checkpoint and kills its main program.
void run_and_kill(const Folder& folder, const std::string& config) {
    Process run(program_command({"run", config, "--db", "hit.db", "--quiet", "-j", "1"}), folder.path());
    const auto saved = [&] {
        std::error_code absent;
        for (const auto& entry : std::filesystem::directory_iterator(folder / "hit.artefacts", absent))
            if (entry.path().extension() == ".artefact") return true;
        return false;
    };
    while (run.running() && !saved()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    run.signal(SIGKILL);
    run.wait();
}

TEST_F(Drum, ACaseGoesOnWithAnotherNumberOfThreads) {
    run("calm", {{"threads", 1}});
    const json launcher = {"/bin/sh", "-c", "exec \"$@\" --checkpoint-seconds 0.01", "sh"};
    folder.write("two.json", drum({{"threads", 2}, {"launcher", launcher}}).dump());
    folder.write("three.json", drum({{"threads", 3}, {"launcher", launcher}}).dump());
    run_and_kill(folder, "two.json");
    run_and_kill(folder, "three.json");
    run("hit", {{"threads", 1}});
    EXPECT_TRUE(dump("hit") == dump("calm"));
}

TEST_F(Drum, ExplainAndPlanSayHowManyThreadsACaseHas) {
    run("two", {{"threads", 2}});
    const std::string id = ask("two", "SELECT case_id FROM drum WHERE point = 2");
    const auto explained = run_program({"explain", "two.db", id, "--format", "json"}, folder.path());
    EXPECT_GT(json::parse(explained.out).at("attempts").at(0).at("threads"), 1);
    EXPECT_EQ(json::parse(run_program({"plan", "two.json", "--format", "json"}, folder.path()).out).at("threads"), 2);
    EXPECT_THAT(run_program({"plan", "two.json"}, folder.path()).out, HasSubstr("threads    2 per case"));
}

// A stack of a gigabyte for each thread, as far as that may be asked for, and less memory than that.
TEST_F(Drum, WhereTheSystemGivesNoMoreThreadsACaseIsComputedAllTheSame) {
    folder.write("two.json", drum({{"threads", 2}}).dump());
    std::vector<std::string> argv = {
        "/bin/sh", "-c", "(ulimit -s 1000000) 2>/dev/null && ulimit -s 1000000; ulimit -v 900000; exec \"$@\"", "sh"};
    const auto solve = program_command({"solve", "two.json", "--threads", "2", "--format", "json"});
    argv.insert(argv.end(), solve.begin(), solve.end());
    const auto limited = Process(argv, folder.path()).wait();
    const auto free = run_program({"solve", "two.json", "--threads", "1", "--format", "json"}, folder.path());
    EXPECT_EQ(limited.code, 0) << limited.err;
    EXPECT_EQ(json::parse(limited.out).at("scalars"), json::parse(free.out).at("scalars"));
}

// Spheres glued onto a wide base: more than a process may have here.
TEST_F(Drum, WhatFitsNoMemoryIsRefusedBeforeItIsLaidOut) {
    const json config = {{"campaign", "wide"},
                         {"scene", "powder_spreading"},
                         {"factors", {{{"name", "friction"}, {"levels", {0.3}}}}},
                         {"fixed",
                          {{"diameter", 1e-6},
                           {"gap", 1e-5},
                           {"travel", 0.002},
                           {"width", 300},
                           {"layer_area", 1e-9},
                           {"blade_thickness", 1e-4},
                           {"base", "rough"}}},
                         {"design", {{"kind", "lattice"}}}};
    folder.write("wide.json", config.dump());
    for (const auto& command : {std::vector<std::string>{"plan", "wide.json"},
                                {"solve", "wide.json"},
                                {"run", "wide.json", "--db", "wide.db", "--quiet"}}) {
        std::vector<std::string> argv = {"/bin/sh", "-c", "ulimit -v 900000; exec \"$@\"", "sh"};
        const auto words = program_command(command);
        argv.insert(argv.end(), words.begin(), words.end());
        const auto refused = Process(argv, folder.path()).wait();
        EXPECT_EQ(refused.code, 2) << command.front();
        EXPECT_THAT(refused.err, HasSubstr("GB of memory, and this machine gives a process")) << command.front();
    }
}

// Sums over the section grow with the drum, whatever the number of particles.
TEST_F(Drum, ASectionOfTooManyCellsIsRefused) {
    json config = drum({{"threads", 1}});
    config["fixed"].merge_patch(
        {{"particles", 50}, {"diameter", 1e-6}, {"drum_diameter", 10}, {"occupancy_cell", 0.05}});
    folder.write("wide.json", config.dump());
    for (const auto& command :
         {std::vector<std::string>{"plan", "wide.json"}, {"run", "wide.json", "--db", "wide.db", "--quiet"}}) {
        const auto refused = run_program(command, folder.path());
        EXPECT_EQ(refused.code, 2) << command.front();
        EXPECT_THAT(refused.err, HasSubstr("\"radius\" is at most 316 times \"diameter\"")) << command.front();
    }
    const auto rejected = run_program({"solve", "wide.json"}, folder.path());
    EXPECT_EQ(rejected.code, 1);
}

TEST_F(Drum, ACaseInDoublePrecisionHasOne) {
    json config = drum({{"threads", 2}});
    config["fixed"].merge_patch({{"particles", 50}, {"precision", "double"}});
    folder.write("double.json", config.dump());
    EXPECT_EQ(run_program({"run", "double.json", "--db", "double.db", "--quiet"}, folder.path()).code, 0);
    EXPECT_EQ(ask("double", "SELECT max(threads) FROM attempt"), 1);
}

}  // namespace grainsweep::tests::case_threads_test
