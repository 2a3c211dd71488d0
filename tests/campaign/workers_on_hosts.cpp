// Workers on hosts: whatever is killed, the answers are those of a local run, and a host that breaks the protocol does
// no harm.
#include "stats/random.hpp"
#include "tests/support/progress.hpp"
#include "tests/support/scripted_worker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::workers_on_hosts_test {

using nlohmann::json;
using stats::Stream;
using testing::HasSubstr;

json hosted_config(int points, double seconds) {
    return {{"campaign", "hosted"},
            {"scene", "rehearsal"},
            {"factors", {{{"name", "x1"}, {"between", {0, 1}}}, {{"name", "x2"}, {"between", {0, 1}}}}},
            {"fixed", {{"response", "ishigami"}, {"noise", 0.1}, {"wait_seconds", seconds}}},
            {"design", {{"kind", "halton"}, {"points", points}}}};
}

/// The campaign run locally, and on two hosts of two workers each.
class HostedCampaign {
public:
    HostedCampaign(int points, double seconds, const json& execution = json::object()) {
        json config = hosted_config(points, seconds);
        folder_.write("local.json", config.dump());
        config["execution"] = {{"hosts", 2}, {"workers_per_host", 2}};
        config["execution"].merge_patch(execution);
        folder_.write("hosted.json", config.dump());
        const auto ended = run_program({"run", "local.json", "--db", "local.db", "-j", "2", "--quiet"}, folder_.path());
        EXPECT_EQ(ended.code, 0) << ended.err;
    }
    [[nodiscard]] std::vector<std::string> command() const {
        return program_command({"run", "hosted.json", "--db", (folder_ / "hosted.db").string(), "--quiet"});
    }
    void expect_equal_dumps() const {
        EXPECT_TRUE(dump("local.db") == dump("hosted.db"));
        EXPECT_GT(dump("local.db").size(), 1000U);
    }
    [[nodiscard]] std::int64_t ask(const std::string& sql) const { return number_in(folder_ / "hosted.db", sql); }
    void await(Process& run, std::int64_t cases) const { await_settled(run, folder_ / "hosted.db", cases); }
    void expect_no_orphans() const {
        const std::string mark = (folder_ / "hosted.artefacts").string();
        for (int tries = 0; tries < 400 && !processes_with(mark).empty(); ++tries)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        EXPECT_TRUE(processes_with(mark).empty());
    }
    [[nodiscard]] const Folder& folder() const { return folder_; }

private:
    [[nodiscard]] std::string dump(const std::string& database) const {
        return run_program({"dump", database}, folder_.path()).out;
    }
    Folder folder_;
};

/// Children of a process.
std::vector<pid_t> children_of(pid_t parent) {
    std::vector<pid_t> found;
    for (const pid_t child : processes_with(" worker ")) {
        std::string all;
        std::getline(std::ifstream("/proc/" + std::to_string(child) + "/stat"), all);  // nothing, if it ends meanwhile
        const auto after = all.rfind(") ");
        if (after != std::string::npos && std::atoi(all.c_str() + after + 4) == parent) found.push_back(child);
    }
    return found;
}

TEST(Hosts, TheDumpIsThatOfALocalRun) {
    const HostedCampaign campaign(400, 0);
    const auto ended = Process(campaign.command(), campaign.folder().path()).wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    campaign.expect_equal_dumps();
    campaign.expect_no_orphans();
}

TEST(Hosts, WorkersAreTheHostsChildrenAndHostsAreLaunchedWithTheirNumber) {
    const HostedCampaign campaign(400, 0.02,
                                  {{"launcher", {"/bin/sh", "-c", "echo started >> host.{host}; exec \"$@\"", "sh"}}});
    Process run(campaign.command(), campaign.folder().path());
    campaign.await(run, 50);
    const auto hosts = run.children();
    ASSERT_EQ(hosts.size(), 2U);
    for (const pid_t host : hosts) EXPECT_EQ(children_of(host).size(), 2U);
    EXPECT_TRUE(std::filesystem::exists(campaign.folder() / "host.1"));
    EXPECT_TRUE(std::filesystem::exists(campaign.folder() / "host.2"));
    EXPECT_EQ(run.wait().code, 0);
    campaign.expect_equal_dumps();
}

TEST(Hosts, AHostThatIsKilledCostsNoCaseATry) {
    const HostedCampaign campaign(300, 0.02);  // long enough to look and kill six times on a busy machine
    Process run(campaign.command(), campaign.folder().path());
    int killed = 0;
    for (std::uint64_t moment = 0; moment < 6; ++moment) {
        campaign.await(run, 30 * static_cast<std::int64_t>(moment));
        const auto hosts = run.children();
        if (hosts.empty()) continue;
        ::kill(hosts[Stream(21, moment).bits(0) % hosts.size()], SIGKILL);
        ++killed;
    }
    EXPECT_GE(killed, 4);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome NOT IN ('completed', 'abandoned')"), 0);
    campaign.expect_equal_dumps();
    campaign.expect_no_orphans();
}

TEST(Hosts, AWorkerOfAHostThatIsKilledIsReplaced) {
    const HostedCampaign campaign(300, 0.02);  // long enough to look and kill six times on a busy machine
    Process run(campaign.command(), campaign.folder().path());
    int killed = 0;
    for (std::uint64_t moment = 0; moment < 6; ++moment) {
        campaign.await(run, 30 * static_cast<std::int64_t>(moment));
        for (const pid_t host : run.children()) {
            const auto workers = children_of(host);
            if (workers.empty()) continue;
            ::kill(workers[Stream(22, moment).bits(0) % workers.size()], SIGKILL);
            ++killed;
        }
    }
    EXPECT_GE(killed, 6);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    campaign.expect_equal_dumps();
    campaign.expect_no_orphans();
}

TEST(Hosts, TheyEndWithTheMainProgram) {
    const HostedCampaign campaign(300, 0.01);
    {
        Process run(campaign.command(), campaign.folder().path());
        campaign.await(run, 100);
        run.signal(SIGKILL);
        run.wait();
    }
    campaign.expect_no_orphans();
    EXPECT_EQ(Process(campaign.command(), campaign.folder().path()).wait().code, 0);
    campaign.expect_equal_dumps();
}

TEST(Hosts, AHostThatIsAskedToEndSavesWhatItsWorkersHave) {
    const HostedCampaign campaign(8, 1.5);
    Process run(campaign.command(), campaign.folder().path());
    await_number(run, campaign.folder() / "hosted.db", "SELECT count(*) FROM attempt", 4);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    const auto hosts = run.children();
    ASSERT_EQ(hosts.size(), 2U);
    ::kill(hosts[0], SIGTERM);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'abandoned' AND message LIKE "
                           "'%signal 15%'"),
              2);
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'crashed'"), 0);
    campaign.expect_equal_dumps();
}

TEST(Hosts, AHostThatFallsSilentIsReplaced) {
    const HostedCampaign campaign(60, 0.05, {{"silence_seconds", 3}});
    Process run(campaign.command(), campaign.folder().path());
    campaign.await(run, 8);
    const auto hosts = run.children();
    ASSERT_EQ(hosts.size(), 2U);
    for (const pid_t worker : children_of(hosts[0])) ::kill(worker, SIGSTOP);
    ::kill(hosts[0], SIGSTOP);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("it gave no sign of life for 3 s"));
    campaign.expect_equal_dumps();
}

/// A script in the place of a host with one worker: `say` writes as its worker, which is number 1.
const char* as_host = R"sh(ready=$("$1" worker "${@:3}" </dev/null | head -n1)
printf 'grainsweep host 2\n'
sum() { printf '%s\n%s' "$1" "$2" | cksum | cut -d' ' -f1; }
say() { local head="1 $(( ${#1} + 1 ))"; printf '%s %s\n%s\n\n' "$head" "$(sum "$head" "$1"$'\n')" "$1"; }
)sh";

ScriptedCampaign scripted_host(const std::string& script) {
    return ScriptedCampaign(as_host + script, 3,
                            {{"execution", {{"hosts", 1}, {"workers_per_host", 1}, {"workers", nullptr}}}});
}

TEST(Hosts, AScriptThatKeepsToTheFramesIsAHost) {
    const auto campaign = scripted_host(R"(say "$ready"; while next; do begun; done_with completed '"y":2'; done)");
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM scripted WHERE y = 2"), 3);
}

TEST(Hosts, NothingCountsAfterWhatIsNoFrame) {
    const auto campaign = scripted_host(R"(echo nonsense; say "$ready"; while next; do begun; done; sleep 100)");
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 3) << run.err;
    EXPECT_THAT(run.err, HasSubstr("it wrote something that no host writes"));
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt"), 0);
}

// What lies between a host and the main program changes a digit of an answer.
TEST(Hosts, AnAnswerThatWasChangedOnItsWayIsNotBelieved) {
    const auto once = scripted_host(R"(say "$ready"; while next; do begun
if mkdir flipped 2>/dev/null; then done_with completed '"y":2' | sed 's/"y":2/"y":3/'; else done_with completed '"y":2'; fi
done)");
    const auto run = once.run();
    EXPECT_EQ(run.code, 0) << run.err;
    EXPECT_THAT(run.err, HasSubstr("was changed on its way"));
    EXPECT_EQ(once.ask("SELECT count(*) FROM scripted WHERE y = 2"), 3);
    const auto always = scripted_host(
        R"(say "$ready"; while next; do begun; done_with completed '"y":2' | sed 's/"y":2/"y":3/'; done)");
    const auto ended = always.run();
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("was changed on its way"));
    EXPECT_EQ(always.ask("SELECT count(*) FROM scripted WHERE y IS NOT NULL"), 0);
}

TEST(Hosts, AHostThatFloodsEndsTheRun) {
    for (const char* flood : {"yes | tr -d '\\n'", "while :; do printf '1 99999999\\n'; done", "exec yes"}) {
        const auto campaign = scripted_host(flood);
        const auto run = campaign.run();
        EXPECT_EQ(run.code, 3) << run.err;
        EXPECT_LT(run.most_memory, 300);
    }
}

// What its worker may write is judged by the same rules as of one without a host.
TEST(Hosts, AWorkerThatFloodsThroughAHostIsDismissed) {
    const auto campaign = scripted_host(
        R"(say "$ready"; next; begun; long=$(printf '%060000d' 0); sum=$(sum '1 60000' "$long"); for k in $(seq 300); do printf '1 60000 %s\n%s\n' "$sum" "$long"; done
while read -r line; do [[ $line == signal* ]] && exit 0; done)");
    const auto run = campaign.run();
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr("the worker wrote a line of more than 16 MB"));
}

TEST(Hosts, HalfAnAnswerIsNone) {
    const auto campaign = scripted_host(R"(say "$ready"; next; begun
printf '1 500 1\n{"done":{%s,"outcome":"completed","mess' "$attempt")");
    const auto run = campaign.run({"--max-cases", "1"});
    EXPECT_NE(run.code, 0) << run.err;
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM scripted WHERE outcome = 'completed'"), 0);
    EXPECT_EQ(campaign.ask("SELECT count(*) FROM attempt WHERE outcome = 'crashed'"), 0);
}

TEST(Hosts, ALauncherThatCannotStartOneIsNamed) {
    const HostedCampaign campaign(4, 0, {{"launcher", {"/bin/sh", "-c", "echo no such node >&2; exit 7"}}});
    const auto ended = Process(campaign.command(), campaign.folder().path()).wait();
    EXPECT_EQ(ended.code, 3) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("no such node"));
}

TEST(Hosts, WhatHasNoEffectIsRefused) {
    const Folder folder;
    json config = hosted_config(4, 0);
    config["execution"] = {{"hosts", 2}, {"workers", 2}};
    folder.write("c.json", config.dump());
    auto ended = run_program({"plan", "c.json"}, folder.path());
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("$.execution.workers"));
    config["execution"] = {{"workers_per_host", 2}};
    folder.write("c.json", config.dump());
    ended = run_program({"plan", "c.json"}, folder.path());
    EXPECT_EQ(ended.code, 2);
    EXPECT_THAT(ended.err, HasSubstr("$.execution.workers_per_host"));
}

}  // namespace grainsweep::tests::workers_on_hosts_test
