// A hostile day for the live page, one attack after another until the time is over: slow_served, ten minutes, or
// GRAINSWEEP_SOAK_MINUTES; `./bootstrap.sh soak served [MINUTES]` builds and runs it. GRAINSWEEP_SOAK_SEED (1) draws
// the moments of signals. Prints each attack as a row of Markdown: how often it was tried, and how often the page held.
#include "stats/random.hpp"
#include "tests/support/live_server.hpp"
#include "tests/support/served_rounds.hpp"
#include "tests/support/tried.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <utility>
#include <vector>

using namespace grainsweep::tests;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

namespace {

std::string config_of(const std::string& name, int points, double seconds) {
    return fmt::format(
        R"({{"campaign": "{}", "scene": "rehearsal", "fixed": {{"wait_seconds": {}}}, "design": {{"kind": "halton",
             "points": {}}}, "factors": [{{"name": "x1", "between": [0, 1]}}, {{"name": "x2", "between": [0, 1]}}]}})",
        name, seconds, points);
}

void make_database(const Folder& folder, const std::string& name, int points) {
    folder.write(name + ".json", config_of(name, points, 0));
    const auto ended = run_program({"run", name + ".json", "--quiet", "-j", "1"}, folder.path());
    if (ended.code != 0) throw std::runtime_error(ended.err);
}

bool answers(const LiveServer& server) {
    return server.get("/data").status == 200;
}

bool ends(LiveServer& server) {
    const auto start = Clock::now();
    server.process().signal(SIGINT);
    return server.process().wait().code == 0 && Clock::now() - start < 10s;
}

struct Tally {
    std::int64_t tried = 0, held = 0;
};

/// Stops, kills, resumptions and other programs beside an open page: what it shows is what is stored, within 2 s.
Tally rounds_beside_a_page() {
    const Folder folder;
    folder.write("a.json", config_of("a", 20000, 0.002));
    const auto rounds = served_rounds(folder, 50, 120s);
    EXPECT_EQ(rounds.complaint, "");
    std::fprintf(stderr,
                 "%d rounds: %d kills, %d stops, %d times VACUUM; %lld cases stored; the page follows in %.2f s\n",
                 rounds.done, rounds.kills, rounds.stops, rounds.vacuums, static_cast<long long>(rounds.settled),
                 rounds.slowest);
    return {rounds.done, rounds.prompt};
}

/// One of two databases is cut, emptied, altered or removed: the other stays, and Ctrl-C ends the server.
bool one_bad_database() {
    static int way = 0;
    const Folder folder;
    make_database(folder, "a", 32);
    make_database(folder, "b", 32);
    LiveServer server(folder, ".");
    const auto file = folder / "a.db";
    const auto alter = [&](const char* sql) {
        sqlite3* db = nullptr;
        sqlite3_open(file.c_str(), &db);
        sqlite3_exec(db, sql, nullptr, nullptr, nullptr);
        sqlite3_close(db);
    };
    switch (way++ % 6) {
        case 0:
            fs::resize_file(file, fs::file_size(file) / 2);
            break;
        case 1:
            fs::resize_file(file, 0);
            break;
        case 2:
            alter("PRAGMA journal_mode=DELETE; PRAGMA page_size=512; VACUUM");
            break;
        case 3:
            alter("DROP TABLE sim_case");
            break;
        case 4:
            alter(
                "DROP VIEW a; CREATE VIEW a AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT "
                "i "
                "AS point FROM n");
            break;
        default:
            fs::remove(file);
    }
    bool held = true;
    for (int k = 0; k < 8; ++k) {
        std::this_thread::sleep_for(400ms);
        held = held && answers(server);
    }
    const auto rows = server.work("/query", "database=b.db", "SELECT count(*) AS n FROM b");
    held = held && rows.status == 200 && rows.body.find("32") != std::string::npos;
    return ends(server) && held;
}

/// Returns whether the server answers while 300 connections without the token send a byte every few seconds.
bool slow_sockets() {
    const Folder folder;
    make_database(folder, "a", 8);
    LiveServer server(folder, "a.db");
    std::vector<Connected> slow;
    bool held = true;
    for (int k = 0; k < 300; ++k) {
        slow.emplace_back(server.port());
        if (slow.back().is_open()) slow.back().send("GET / HTTP/1.1\r\nX: ");
    }
    for (int second = 0; second < 6; ++second) {
        std::this_thread::sleep_for(1s);
        for (const auto& one : slow)
            if (one.is_open()) one.send("a");
        held = held && answers(server);
    }
    slow.clear();
    return ends(server) && held;
}

/// Named pipes, links and claims of others beside the database.
bool files_of_others() {
    const Folder folder;
    make_database(folder, "a", 8);
    folder.write("precious", "keep");
    LiveServer server(folder, "a.db", {"--control", "a.json"});
    const auto id = std::string(32, '0');
    fs::create_directory(folder / "a.films");
    fs::create_symlink("/etc/passwd", folder / ("a.films/" + id + ".html"));
    fs::create_symlink(folder / "precious", folder / "a.run.log");
    ::mkfifo((folder / "a.now").c_str(), 0600);
    bool held = server.get("/film", "case=" + id).status == 404 && answers(server);
    fs::remove(folder / "a.now");
    folder.write("a.now", "grainsweep now 1\ncampaign a\nhost elsewhere\nprocess 1\n");
    held = held && server.post("/stop", "").status == 409 && server.post("/run", "").status == 200;
    for (int k = 0; k < 200 && !fs::exists(folder / "a.run.log"); ++k) std::this_thread::sleep_for(10ms);
    std::ifstream stream(folder / "precious");
    std::string word;
    stream >> word;
    return ends(server) && held && word == "keep";
}

/// TERM or Ctrl-C at any moment of a calibration: 75 or 130, and the next run continues.
bool signals_between_waves(double seconds) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "cal", "scene": "rehearsal",
 "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
 "fixed": {"response": "spreading_a", "x4": 0.5, "noise": 0.02, "wait_seconds": 0.01},
 "calibration": {"targets": [{"observable": "y", "value": 0.2370, "error": 0.003, "inputs": {"x3": 0.5}},
                             {"observable": "y", "value": 0.4949, "error": 0.003, "inputs": {"x3": 0.95}}],
                 "discrepancy": {"y": 0.001}, "waves": 3, "points_per_wave": 12}, "execution": {"workers": 2}})");
    static int count = 0;
    const bool terminates = ++count % 2 == 0;
    Process run(program_command({"calibrate", "c.json", "--db", "c.db", "--quiet"}), folder.path());
    std::this_thread::sleep_for(std::chrono::duration<double>(0.05 + seconds));
    const bool ran = run.running();
    run.signal(terminates ? SIGTERM : SIGINT);
    const auto ended = run.wait();
    const bool documented = !ran || ended.code == (terminates ? 75 : 130) || ended.code == 0 || ended.code == 1;
    EXPECT_TRUE(documented) << ended.code;
    const auto resumed = run_program({"calibrate", "c.json", "--db", "c.db", "--quiet"}, folder.path());
    return documented && resumed.code <= 1 && run_program({"verify", "c.db"}, folder.path()).code == 0;
}

TEST(SoakServed, EveryAttackIsHeld) {
    const char* given = std::getenv("GRAINSWEEP_SOAK_MINUTES");
    const char* seed = std::getenv("GRAINSWEEP_SOAK_SEED");
    const auto until = Clock::now() + std::chrono::duration<double>(60 * (given == nullptr ? 10 : std::atof(given)));
    grainsweep::stats::Generator draws(seed == nullptr ? 1 : std::strtoull(seed, nullptr, 10));
    const auto once = [](bool held) { return Tally{1, held ? 1 : 0}; };
    const std::vector<std::pair<std::string, std::function<Tally()>>> attacks = {
        {"a run stopped or killed and resumed, `status`, `verify` and `VACUUM` beside an open page",
         rounds_beside_a_page},
        {"one database of a served folder cut, emptied, altered, endless or removed",
         [&] { return once(one_bad_database()); }},
        {"300 slow connections without the token", [&] { return once(slow_sockets()); }},
        {"named pipes, links and claims of others beside a served database", [&] { return once(files_of_others()); }},
        {"TERM or Ctrl-C at any moment of a calibration",
         [&] { return once(signals_between_waves(3 * draws.uniform())); }}};
    std::map<std::string, Tally> counts;
    for (std::size_t k = 0; Clock::now() < until || k < attacks.size(); ++k) {
        const auto& [name, attack] = attacks[k % attacks.size()];
        const auto [now, held] = attack();
        EXPECT_EQ(held, now) << name;
        counts[name].tried += now;
        counts[name].held += held;
    }
    for (const auto& [name, attack] : attacks) tried(name, counts[name].tried, counts[name].held);
}

}  // namespace
