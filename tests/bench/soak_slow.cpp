// Misfortunes of every kind at random, one run after another, on campaigns of 2,000 cases until the time is over; each
// campaign ends with the undisturbed dump, nothing lost, nothing doubled: slow_soak, an hour, or
// GRAINSWEEP_SOAK_MINUTES. Which misfortunes come in which order is drawn by GRAINSWEEP_SOAK_SEED (1). Prints rows of
// the table in docs/reliability.md.
#include "stats/random.hpp"
#include "tests/support/failing_call.hpp"
#include "tests/support/tried.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

using namespace grainsweep::tests;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using grainsweep::stats::Generator;
namespace fs = std::filesystem;

namespace {

constexpr int cases = 2000, killed = 128 + SIGKILL, interrupted = 130, asked_to_end = 75, broken = 3;

// Most take milliseconds and wait for their turn inside a worker, some several checkpoints.
const char* config = R"({"campaign": "soak", "scene": "rehearsal",
  "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]},
              {"name": "wait_seconds", "between": [0.0001, 0.3], "scale": "log"}],
  "fixed": {"response": "ishigami", "noise": 0.1}, "design": {"kind": "halton", "points": 2000},
  "limits": {"attempts": 1000},
  "execution": {"workers": 8, "silence_seconds": 3,
                "launcher": ["/bin/sh", "-c", "exec \"$@\" --checkpoint-seconds 0.05", "sh"]}})";

const std::vector<std::string> command = {"run", "c.json", "--db", "c.db"};

struct Tally {
    std::int64_t tried = 0, held = 0;
};
using Tallies = std::map<std::string, Tally>;

std::string contents(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

/// One campaign from its first run to its last.
class Round {
public:
    Round(std::uint64_t seed, const std::string& undisturbed, Tallies& tallies)
        : chance_(seed), undisturbed_(undisturbed), tallies_(tallies), folder_(seed % 2 == 0 ? in_memory() : "/tmp") {
        folder_.write("c.json", config);
    }
    /// How many runs it took.
    int finish() {
        int runs = 1;
        while (!one_run()) {
            EXPECT_LT(++runs, 300) << "no headway";
            if (testing::Test::HasFailure()) break;
        }
        return runs;
    }

private:
    struct Run {
        Process process;
        std::set<int> codes;  // it may end with
        std::vector<std::string> met;
        std::optional<std::string> moved;  // where its database is
    };

    std::size_t below(std::size_t n) { return static_cast<std::size_t>(chance_.below(n)); }
    template <class T>
    T one_of(const std::vector<T>& list) {
        return list[below(list.size())];
    }

    // ---- what a run begins with ------------------------------------------------------------------------------------

    struct Start {
        std::vector<std::string> argv;
        std::string name;  // empty: nothing
        std::set<int> codes = {0};
        bool calls = false;  // it has happened where its token is gone
    };

    static std::vector<std::string> in_shell(const std::string& script, bool quiet = true) {
        std::vector<std::string> argv = {"/bin/bash", "-c", script, "bash"};
        for (auto& word : program_command(command)) argv.push_back(std::move(word));
        if (quiet) argv.emplace_back("--quiet");
        return argv;
    }

    Start call(const std::string& name, FailingCall call, std::set<int> codes) {
        auto arguments = command;
        arguments.emplace_back("--quiet");
        return {command_with(call, folder_ / "token", arguments), name, std::move(codes), true};
    }

    Start start() {
        const auto number = static_cast<int>(1 + below(60));
        const std::string error = std::to_string(-one_of<int>({EIO, ENOSPC}));
        const std::string when = one_of<std::string>({"before", "after"});
        switch (below(12)) {
            case 0:
                return {in_shell(R"(exec "$@" 2>/dev/full)", false), "progress to a full disk (/dev/full)"};
            case 1:
                return {in_shell("ulimit -f " + std::to_string(50 + below(2000)) + R"(; exec "$@")"),
                        "database or checkpoint reaches a quota",
                        {0, broken}};
            case 2:
                return call("a call of the main program to its database fails",
                            {"main", one_of<std::string>({"write", "sync"}), one_of<std::string>({"c.db", "c.db-wal"}),
                             "before", number, error},
                            {0, broken});
            case 3:
                return call("a call of a worker to its folder fails",
                            {"worker", one_of<std::string>({"open", "write", "sync", "rename"}), ".aside", "before",
                             number, error},
                            {0, broken});
            case 4:
                return call("SIGKILL of the main program at a call",
                            {"main", one_of<std::string>({"write", "sync"}), one_of<std::string>({"c.db-wal", "pipe"}),
                             when, 5 * number},
                            {0, killed});
            case 5:
                return call("SIGKILL of a worker at a call",
                            {"worker", one_of<std::string>({"open", "write", "sync", "rename"}),
                             one_of<std::string>({".aside", "pipe"}), when, number},
                            {0});
            case 6:
                return call("a worker's call hangs (a dead file server)",
                            {"worker", "sync", ".aside", when, number, "1000"}, {0});
            case 7:
                return call("the main program's disk hangs for 3 s", {"main", "sync", "c.db-wal", when, number, "3"},
                            {0});
            default:
                return {in_shell(R"(exec "$@")"), {}};
        }
    }

    // ---- what happens on the way -----------------------------------------------------------------------------------

    pid_t worker_of(const Run& run) {
        const auto workers = run.process.children();
        return workers.empty() ? 0 : workers[below(workers.size())];
    }

    static bool send(pid_t process, int signal) { return process > 0 && ::kill(process, signal) == 0; }

    void happen(Run& run) {
        const auto met = [&](const char* name, bool so = true) {
            if (so) run.met.emplace_back(name);
        };
        switch (below(11)) {
            case 0:
                run.codes.insert(killed);
                return met("SIGKILL to the main program", send(run.process.pid(), SIGKILL));
            case 1:
                return met("SIGKILL to a worker", send(worker_of(run), SIGKILL));
            case 2: {
                const int signal = one_of<int>({SIGTERM, SIGINT, SIGUSR1});
                // The second before it is prepared for signals.
                run.codes.insert({signal == SIGINT ? interrupted : asked_to_end, 128 + signal});
                met("TERM, INT or USR1 to the main program", send(run.process.pid(), signal));
                if (below(3) == 0) met("and once more, to end at once", send(run.process.pid(), signal));
                return;
            }
            case 3:
                return met("TERM, INT or USR1 to a worker",
                           send(worker_of(run), one_of<int>({SIGTERM, SIGINT, SIGUSR1})));
            case 4: {
                met("the main program stopped (SIGSTOP) for up to 5 s", send(run.process.pid(), SIGSTOP));
                std::this_thread::sleep_for(5s * chance_.uniform());
                return run.process.signal(SIGCONT);
            }
            case 5: {
                const pid_t worker = worker_of(run);
                met("a worker stopped for up to 2 s", send(worker, SIGSTOP));
                std::this_thread::sleep_for(2s * chance_.uniform());
                send(worker, SIGCONT);
                return;
            }
            case 6:
                return met("a worker frozen for good (SIGSTOP)", send(worker_of(run), SIGSTOP));
            case 7:
                return move_database(run);
            case 8:
                return met("a second run of the same database", second_run_is_refused());
            case 9:
                return met("readers beside the run", readers_are_answered());
            default:
                return;
        }
    }

    void move_database(Run& run) {
        std::error_code none;
        if (fs::file_size(folder_ / "c.db", none) == 0 || none) return;
        fs::rename(folder_ / "c.db", folder_ / "away.db");
        run.moved = "away.db";
        run.codes.insert(broken);
        run.met.emplace_back("the database moved away, and put back after the run");
    }

    bool second_run_is_refused() {
        if (!fs::exists(folder_ / "c.db")) return false;
        const auto second = ask({"run", "c.json", "--db", "c.db", "--quiet", "--max-cases", "1"});
        EXPECT_TRUE(second.code == broken || second.code <= 1) << second.err;  // the first one may have ended
        return second.code == broken;
    }

    bool readers_are_answered() {
        const auto status = ask({"status", "c.db"}), dump = ask({"dump", "c.db"});
        if (status.code == 2) return false;  // nothing there yet
        EXPECT_EQ(status.code, 0) << status.err;
        EXPECT_EQ(dump.code, 0) << dump.err;
        return true;
    }

    // ---- what must hold --------------------------------------------------------------------------------------------

    [[nodiscard]] Ended ask(const std::vector<std::string>& arguments) const {
        return run_program(arguments, folder_.path());
    }
    [[nodiscard]] int count(const std::string& sql) const {
        const auto ended = ask({"query", "c.db", sql, "--format", "csv"});
        const auto line = ended.out.find('\n');
        return ended.code == 0 && line != std::string::npos ? std::stoi(ended.out.substr(line + 1)) : -1;
    }

    /// After any run: whole, and nothing that was there is gone.
    void expect_sound() {
        for (int tries = 0; tries < 500 && !processes_with(folder_.path().string()).empty(); ++tries)
            std::this_thread::sleep_for(10ms);
        EXPECT_TRUE(processes_with(folder_.path().string()).empty()) << "a process outlived its main program";
        const auto verified = ask({"verify", "c.db"});
        const int completed = count("SELECT count(*) FROM sim_case WHERE outcome = 'completed'");
        EXPECT_TRUE(verified.code == 0 || (verified.code == 2 && completed_ == 0)) << verified.out << verified.err;
        EXPECT_GE(completed, completed_ == 0 ? -1 : completed_) << "what was stored is gone";
        completed_ = std::max(completed, 0);
    }

    void expect_finished() const {
        EXPECT_TRUE(ask({"dump", "c.db"}).out == undisturbed_) << "another dump";
        EXPECT_EQ(completed_, cases);
        EXPECT_EQ(count("SELECT count(*) FROM attempt WHERE outcome = 'completed'"), cases) << "doubled";
        EXPECT_EQ(count("SELECT count(*) FROM sim_case AS c WHERE attempts <> (SELECT count(*) FROM attempt AS a WHERE "
                        "a.case_key = c.case_key) OR failures <> (SELECT count(*) FROM attempt AS a WHERE a.case_key = "
                        "c.case_key AND a.outcome = 'crashed')"),
                  0);
        std::error_code none;
        for (const auto& entry : fs::directory_iterator(folder_ / "c.artefacts", none))
            ADD_FAILURE() << "left behind: " << entry.path();
    }

    /// One bit of a copy: found, harmless, or refused.
    void flip_a_bit_of_a_copy() {
        if (completed_ == 0 || below(3) != 0) return;
        std::string text = contents(folder_ / "c.db");
        const auto at = below(text.size());
        text[at] = static_cast<char>(text[at] ^ (1 << below(8)));
        folder_.write("copy.db", text);
        const auto sound = ask({"dump", "c.db"}), dump = ask({"dump", "copy.db"}),
                   verified = ask({"verify", "copy.db"});
        const bool refused = dump.code == broken || dump.code == 2;
        EXPECT_TRUE(refused || (dump.code == 0 && dump.out == sound.out)) << "a wrong answer: bit of byte " << at;
        EXPECT_TRUE(!refused || verified.code != 0) << "refused, and verify finds nothing: bit of byte " << at;
        note("one bit of a copy flipped");
    }

    void note(const std::string& name) {
        ++tallies_[name].tried;
        if (!testing::Test::HasFailure()) ++tallies_[name].held;
    }

    /// True once the campaign is finished.
    bool one_run() {
        const Start how = start();
        Run run{Process(how.argv, folder_.path()), how.codes, {}, {}};
        for (auto events = below(4); events > 0 && run.process.running() && !run.moved; --events) {
            std::this_thread::sleep_for(1500ms * chance_.uniform());
            if (run.process.running()) happen(run);
        }
        const auto until = Clock::now() + 5min;
        while (run.process.running() && Clock::now() < until) std::this_thread::sleep_for(1ms);
        EXPECT_FALSE(run.process.running()) << "the run does not end";
        run.process.signal(SIGKILL);
        const auto ended = run.process.wait();
        EXPECT_TRUE(run.codes.contains(ended.code)) << "ended with " << ended.code << ": " << ended.err;
        if (run.moved) fs::rename(folder_ / *run.moved, folder_ / "c.db");
        const bool happened =
            how.calls ? has_happened(folder_ / "token") : how.codes.size() == 1 || ended.code == broken;
        if (!how.name.empty() && happened) run.met.push_back(how.name);
        expect_sound();
        if (ended.code == 0) expect_finished();
        for (const auto& name : run.met) note(name);
        flip_a_bit_of_a_copy();
        if (testing::Test::HasFailure()) keep(run.met);
        return ended.code == 0;
    }

    /// What a failure is to be understood from.
    void keep(const std::vector<std::string>& met) const {
        for (const auto& name : met) std::printf("met: %s\n", name.c_str());
        const auto kept = fs::temp_directory_path() / ("soak_" + std::to_string(::getpid()));
        std::error_code error;
        fs::copy(folder_.path(), kept, fs::copy_options::recursive, error);
        std::printf("kept: %s\n", kept.c_str());
    }

    Generator chance_;
    const std::string& undisturbed_;
    Tallies& tallies_;
    Folder folder_;
    int completed_ = 0;
};

double number_from(const char* name, double otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::atof(text);
}

TEST(Soak, NothingIsLostAndNothingIsDoubled) {
    const Folder folder;
    folder.write("c.json", config);
    ASSERT_EQ(run_program({"run", "c.json", "--db", "c.db", "--quiet"}, folder.path()).code, 0);
    const std::string undisturbed = run_program({"dump", "c.db"}, folder.path()).out;
    const auto end = Clock::now() + std::chrono::duration<double>(60 * number_from("GRAINSWEEP_SOAK_MINUTES", 60));
    auto seed = static_cast<std::uint64_t>(number_from("GRAINSWEEP_SOAK_SEED", 1)) << 32U;
    Tallies tallies;
    std::int64_t campaigns = 0, runs = 0;
    while (Clock::now() < end && !HasFailure()) {
        runs += Round(seed++, undisturbed, tallies).finish();
        ++campaigns;
        std::fprintf(stderr, "campaign %lld finished after %lld runs in all\n", static_cast<long long>(campaigns),
                     static_cast<long long>(runs));
    }
    for (const auto& [name, tally] : tallies) grainsweep::tests::tried(name, tally.tried, tally.held);
    grainsweep::tests::tried("campaigns of 2,000 cases, in " + std::to_string(runs) + " runs", campaigns,
                             HasFailure() ? campaigns - 1 : campaigns);
}

}  // namespace
