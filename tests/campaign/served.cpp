// `grainsweep serve` beside a run: what a reader of its events gets, and what the reader may do.
#include "tests/support/event_reader.hpp"
#include "tests/support/failing_call.hpp"
#include "tests/support/live_server.hpp"
#include "tests/support/progress.hpp"
#include "tests/support/served_rounds.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <list>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace grainsweep::tests::served_test {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;
using namespace std::chrono_literals;

/// Cases of so many seconds over the unit square.
std::string config_of(const std::string& name, int points, double seconds) {
    return fmt::format(
        R"({{"campaign": "{}", "scene": "rehearsal", "fixed": {{"wait_seconds": {}}}, "design": {{"kind": "halton",
             "points": {}}}, "factors": [{{"name": "x1", "between": [0, 1]}}, {{"name": "x2", "between": [0, 1]}}]}})",
        name, seconds, points);
}

/// Another program alters the database.
void change(const fs::path& file, const std::string& sql) {
    sqlite3* db = nullptr;
    EXPECT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(db, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
    sqlite3_close(db);
}

struct ServedCampaign : testing::Test {
    Folder folder;

    [[nodiscard]] std::vector<std::string> command_of(const std::string& name) const {
        return program_command({"run", name + ".json", "--quiet", "-j", "1"});
    }
    void write(const std::string& name, int points, double seconds) const {
        folder.write(name + ".json", config_of(name, points, seconds));
    }
    /// A database with its first case.
    void begin(const std::string& name, int points, double seconds) const {
        write(name, points, seconds);
        const auto ended =
            run_program({"run", name + ".json", "--quiet", "--max-cases", "1", "-j", "1"}, folder.path());
        ASSERT_EQ(ended.code, points > 1 ? 1 : 0) << ended.err;
    }
    [[nodiscard]] std::int64_t settled(const std::string& name) const {
        return number_in(folder / (name + ".db"), "SELECT count(outcome) FROM sim_case");
    }
};

TEST_F(ServedCampaign, ResultsReachAReaderWithinTwoSeconds) {
    begin("a", 300, 0.02);
    const auto before = settled("a");
    const LiveServer server(folder, "a.db");
    EventReader reader(server.events());
    Process run(command_of("a"), folder.path());
    std::vector<double> seconds;
    while (run.running() && seconds.size() < 5) {
        const auto stored = settled("a") - before;
        const auto start = Clock::now();
        if (!reader.until([&] { return static_cast<std::int64_t>(reader.cases.size()) > stored; })) break;
        seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
    }
    ASSERT_FALSE(seconds.empty());
    std::ranges::sort(seconds);
    EXPECT_LT(seconds[seconds.size() / 2], 2) << "a result that is on disk is on the page";
    EXPECT_TRUE(reader.until([&] { return reader.now.dump().find("\"running\":[{") != std::string::npos; }))
        << reader.now.dump();
    EXPECT_EQ(run.wait().code, 0);
    EXPECT_TRUE(reader.until([&] { return std::cmp_equal(reader.cases.size(), 300 - before); }));
    EXPECT_EQ(std::set(reader.cases.begin(), reader.cases.end()).size(), reader.cases.size()) << "each once";
    EXPECT_FALSE(fs::exists(folder / "a.now")) << "the run took its file away";
}

TEST_F(ServedCampaign, AReaderStaysWhileTheRunIsKilledAndResumed) {
    begin("a", 150, 0.02);
    const auto before = settled("a");
    const LiveServer server(folder, "a.db");
    EventReader reader(server.events());
    {
        Process run(command_of("a"), folder.path());
        await_settled(run, folder / "a.db", 30);
        run.signal(SIGKILL);
    }
    Process resumed(command_of("a"), folder.path());
    EXPECT_EQ(resumed.wait().code, 0);
    EXPECT_TRUE(reader.until(
        [&] { return std::cmp_equal(std::set(reader.cases.begin(), reader.cases.end()).size(), 150 - before); }));
    EXPECT_TRUE(reader.until([&] { return reader.now["databases"][0]["run"].is_null(); }));
    EXPECT_GT(reader.pages, 0) << "moments and figures follow";
}

TEST_F(ServedCampaign, AFolderIsServedAndADatabaseThatAppears) {
    for (const auto* name : {"a", "b"}) begin(name, 3, 0);
    folder.write("notes.db", "no database");
    const LiveServer server(folder, ".");
    const auto databases = [&] { return Json::parse(server.get("/data").body)["databases"]; };
    EXPECT_EQ(databases(), Json({"a.db", "b.db"}));
    EventReader reader(server.events());
    EXPECT_TRUE(reader.until([&] { return reader.now.is_object(); }));
    const int before = reader.pages;
    const auto asked = Json::parse(server.post("/query", "database=a.db", "SELECT 1 AS one").body);
    begin("c", 3, 0);
    EXPECT_TRUE(reader.until([&] { return reader.pages > before; }));
    const auto job = server.get("/job", fmt::format("number={}", asked["job"].get<int>()));
    EXPECT_EQ(job.status, 200) << "what was asked before goes on: " << job.body;
    EXPECT_EQ(databases(), Json({"a.db", "b.db", "c.db"}));
    EXPECT_TRUE(reader.until([&] { return reader.now["databases"].size() == 3; }));
    EXPECT_EQ(server.work("/query", "database=c.db", "SELECT count(*) AS n FROM c").status, 200);
}

TEST_F(ServedCampaign, ADatabaseThatIsMovedAwayIsReported) {
    begin("a", 3, 0);
    const LiveServer server(folder, "a.db");
    EventReader reader(server.events());
    EXPECT_TRUE(reader.until([&] { return reader.now.is_object() && reader.now["databases"][0]["in_place"] == true; }));
    fs::rename(folder / "a.db", folder / "kept.db");
    EXPECT_TRUE(reader.until([&] { return reader.now["databases"][0]["in_place"] == false; }));
    EXPECT_EQ(server.get("/").status, 200) << "what it held is still shown";
}

TEST_F(ServedCampaign, AnEndedReaderAndCtrlCLeaveNothing) {
    begin("a", 3, 0);
    LiveServer server(folder, "a.db");
    std::list<EventReader> readers;
    for (int k = 0; k < 20; ++k) readers.emplace_back(server.events());
    for (auto& reader : readers) EXPECT_TRUE(reader.until([&] { return reader.now.is_object(); }));
    for (int k = 0; k < 10; ++k) readers.pop_front();
    const auto start = Clock::now();
    server.process().signal(SIGINT);
    EXPECT_EQ(server.process().wait().code, 0);
    EXPECT_LT(Clock::now() - start, 5s);
}

TEST_F(ServedCampaign, APortThatIsTakenGetsOneSentence) {
    begin("a", 3, 0);
    const LiveServer server(folder, "a.db");
    const auto port = std::to_string(server.port());
    const auto ended = run_program({"serve", "a.db", "--port", port}, folder.path());
    EXPECT_EQ(ended.code, 3);
    EXPECT_EQ(ended.err, fmt::format("grainsweep: port {} of this machine cannot be opened: Address already in use; "
                                     "--port names another\n",
                                     port));
    EXPECT_EQ(ended.out, "");
    EXPECT_EQ(run_program({"serve", "none.db"}, folder.path()).code, 2);
    EXPECT_EQ(run_program({"serve", "a.json"}, folder.path()).code, 2);
    EXPECT_EQ(run_program({"serve", "a.db", "--port", "70000"}, folder.path()).code, 2);
    EXPECT_EQ(run_program({"serve", "a.db", "--control", "none.json"}, folder.path()).code, 2);
}

TEST_F(ServedCampaign, WithControlTheReaderStopsAndStartsTheRun) {
    begin("a", 100, 0.05);
    const LiveServer server(folder, "a.db", {"--control", "a.json"});
    EventReader reader(server.events());
    const auto runs = [&] { return reader.now.is_object() && reader.now["databases"][0]["run"].is_object(); };
    Process run(command_of("a"), folder.path());
    EXPECT_TRUE(reader.until(runs));
    EXPECT_EQ(server.post("/run", "").status, 409) << "one is under way";
    EXPECT_EQ(server.post("/stop", "").status, 200);
    EXPECT_EQ(run.wait().code, 130) << "as Ctrl-C would end it";
    EXPECT_LT(settled("a"), 100);
    EXPECT_TRUE(reader.until([&] { return !runs(); }));
    EXPECT_EQ(server.post("/again", "outcome=never").status, 400);
    const auto accepts = [&](const char* path, const char* query) {  // once the run has closed the database
        return reader.until([&] { return server.post(path, query).status == 200; });
    };
    EXPECT_TRUE(accepts("/run", ""));
    EXPECT_TRUE(reader.until([&] { return settled("a") == 100; }));
    EXPECT_TRUE(fs::exists(folder / "a.run.log"));
    EXPECT_TRUE(reader.until([&] { return !runs(); }));
    EXPECT_EQ(server.post("/more", "points=many").status, 400);
    EXPECT_TRUE(accepts("/more", "points=130"));
    EXPECT_TRUE(reader.until([&] { return settled("a") == 130; }));
}

TEST_F(ServedCampaign, OfAFolderEveryCampaignFileCanBeStarted) {
    begin("a", 3, 0);
    begin("b", 4, 0);
    folder.write("notes.json", R"({"no": "campaign"})");
    const LiveServer server(folder, ".", {"--control", "."});
    EventReader reader(server.events());
    EXPECT_EQ(server.post("/run", "database=b.db").status, 404) << "which file?";
    EXPECT_EQ(server.post("/run", "database=b.db&config=notes.json").status, 404) << "no campaign";
    EXPECT_EQ(server.post("/run", "database=b.db&config=b.json").status, 200);
    EXPECT_TRUE(reader.until([&] { return settled("b") == 4; }));
    EXPECT_EQ(settled("a"), 1);
}

TEST_F(ServedCampaign, AFilmIsComputedOnceAndShownWithoutOriginAndToken) {
    folder.write("a.json", R"({"campaign": "a", "scene": "powder_spreading", "fixed": {"diameter": 0.003},
        "factors": [{"name": "gap", "levels": [0.004]}], "design": {"kind": "lattice"}})");
    ASSERT_EQ(run_program({"run", "a.json", "--quiet", "-j", "1"}, folder.path()).code, 0);
    const LiveServer server(folder, "a.db");
    const auto answer = Json::parse(server.work("/query", "", "SELECT case_id FROM a").body);
    const auto id = Json::parse(answer["out"].get<std::string>())[0]["case_id"].get<std::string>();
    EXPECT_EQ(server.get("/film", "case=" + id).status, 404) << "not yet";
    const auto seen = Json::parse(server.work("/film", "case=" + id).body);
    EXPECT_EQ(seen["code"], 0) << seen;
    EXPECT_FALSE(fs::exists(folder / "a.films")) << "nothing is written beside a database";
    const auto film = server.get("/film", "case=" + id);
    EXPECT_EQ(film.status, 200);
    EXPECT_NE(film.body.find("watch-film"), std::string::npos);
    EXPECT_NE(film.head.find("Content-Security-Policy: sandbox allow-scripts"), std::string::npos) << film.head;
    EXPECT_EQ(film.head.find("allow-same-origin"), std::string::npos);
    const auto again = Json::parse(server.post("/film", "case=" + id).body);
    EXPECT_FALSE(again.contains("job")) << "not computed twice";
    const auto address = again["film"].get<std::string>();
    EXPECT_EQ(address.find(server.token()), std::string::npos);
    const Connected stranger(server.port());
    stranger.send(fmt::format("GET /{} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n\r\n", address, server.port()));
    EXPECT_EQ(stranger.answer().status, 200) << "its ticket opens this film and nothing else";
    const auto strange = Json::parse(server.work("/film", "case=" + std::string(32, '0')).body);
    EXPECT_EQ(strange["code"], 2) << "no such case";
    EXPECT_EQ(server.get("/film", "case=" + std::string(32, '0')).status, 404);
}

// Others may have made, cut, altered or removed the other databases of a folder.
TEST_F(ServedCampaign, ADatabaseThatCannotBeReadIsNamedAndTheOthersStay) {
    for (const auto* name : {"a", "b"}) begin(name, 3, 0);
    LiveServer server(folder, ".");
    EventReader reader(server.events());
    const auto state = [&](std::size_t k) { return reader.now.is_object() ? reader.now["databases"].at(k) : Json(); };
    const auto broken = [&] { return state(0).is_object() && !state(0)["error"].get<std::string>().empty(); };
    EXPECT_TRUE(reader.until([&] { return state(1).is_object() && state(1)["error"] == ""; }));
    fs::copy_file(folder / "a.db", folder / "kept");
    fs::resize_file(folder / "a.db", fs::file_size(folder / "a.db") / 2);
    EXPECT_TRUE(reader.until(broken));
    EXPECT_NE(state(0)["error"].get<std::string>().find("a.db"), std::string::npos);
    EXPECT_EQ(state(1)["error"], "");
    EXPECT_EQ(server.work("/query", "database=b.db", "SELECT 1 AS one").status, 200);
    EXPECT_EQ(server.get("/data").status, 200);
    fs::rename(folder / "kept", folder / "a.db");
    EXPECT_TRUE(reader.until([&] { return !broken(); })) << "and shown again once it is mended";
    change(folder / "a.db", "DROP TABLE sim_case");
    EXPECT_TRUE(reader.until(broken));
    EXPECT_EQ(server.get("/").status, 200);
    server.process().signal(SIGINT);
    EXPECT_EQ(server.process().wait().code, 0);
}

// The stored view of a campaign may be endless. Only the user's own SQL reads it.
TEST_F(ServedCampaign, AnEndlessViewStopsNothing) {
    begin("a", 3, 0);
    change(folder / "a.db",
           "DROP VIEW a; CREATE VIEW a AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 "
           "FROM n) SELECT i AS point FROM n");
    LiveServer server(folder, "a.db");
    EventReader reader(server.events());
    EXPECT_TRUE(reader.until([&] { return Json::parse(server.get("/data").body)["campaigns"][0]["rows"] == 3; }));
    for (const auto* command : {"converge", "sensitivity", "status"})
        EXPECT_EQ(run_program({command, "a.db"}, folder.path()).code, 0) << command;
    EXPECT_EQ(run_program({"report", "a.db", "-o", "a.html"}, folder.path()).code, 0);
    server.process().signal(SIGINT);
    EXPECT_EQ(server.process().wait().code, 0);
}

TEST_F(ServedCampaign, ADatabaseThatIsMadeAnewIsFollowed) {
    begin("a", 3, 0);
    const LiveServer server(folder, "a.db");
    EventReader reader(server.events());
    EXPECT_TRUE(reader.until([&] { return reader.now.is_object(); }));
    fs::remove(folder / "a.db");
    begin("a", 7, 0);
    EXPECT_TRUE(reader.until([&] { return Json::parse(server.get("/data").body)["campaigns"][0]["rows"] == 7; }));
    EXPECT_EQ(run_program({"run", "a.json", "--quiet", "-j", "1"}, folder.path()).code, 0);
    EXPECT_TRUE(reader.until([&] { return Json::parse(server.get("/data").body)["campaigns"][0]["settled"] == 7; }));
}

// Links and named pipes beside a database are not followed, and no file of the folder says that a run is under way.
TEST_F(ServedCampaign, FilesOfOthersBesideADatabaseStopNothing) {
    begin("a", 3, 0);
    folder.write("precious", "keep");
    fs::create_symlink(folder / "precious", folder / "a.run.log");
    LiveServer server(folder, "a.db", {"--control", "a.json"});
    ASSERT_EQ(::mkfifo((folder / "a.now").c_str(), 0600), 0);
    EXPECT_EQ(server.get("/data").status, 200);
    fs::remove(folder / "a.now");
    fs::create_directory(folder / "a.films");
    ASSERT_EQ(::mkfifo((folder / ("a.films/" + std::string(32, '0') + ".html")).c_str(), 0600), 0);
    EXPECT_EQ(server.get("/film", "case=" + std::string(32, '0')).status, 404);
    std::string claims = "grainsweep now 1\ncampaign a\nhost elsewhere\nprocess 1\n";
    folder.write("a.now", claims + std::string(2U << 20U, '\n'));
    EXPECT_EQ(server.post("/stop", "").status, 409);
    folder.write("a.now", claims);
    fs::last_write_time(folder / "a.now", fs::file_time_type::clock::now() + 1h);
    EXPECT_EQ(server.post("/stop", "").status, 409);
    EXPECT_EQ(server.post("/run", "").status, 200) << "no run has the database";
    EventReader reader(server.events());
    EXPECT_TRUE(reader.until([&] { return settled("a") == 3; }));
    EXPECT_FALSE(fs::is_symlink(folder / "a.run.log"));
    std::ifstream precious(folder / "precious");
    std::string word;
    precious >> word;
    EXPECT_EQ(word, "keep");
}

TEST_F(ServedCampaign, ASecondRunIsRefusedWhateverStandsBesideTheDatabase) {
    begin("a", 200, 0.02);
    const LiveServer server(folder, "a.db", {"--control", "a.json"});
    Process run(command_of("a"), folder.path());
    await_settled(run, folder / "a.db", 5);
    fs::remove(folder / "a.now");
    EXPECT_EQ(server.post("/run", "").status, 409) << "the run has the lock";
    run.signal(SIGINT);
    EXPECT_EQ(run.wait().code, 130);
}

TEST_F(ServedCampaign, TheEndOfAKilledRunIsKnownAtOnce) {
    begin("a", 200, 0.02);
    Process run(command_of("a"), folder.path());
    await_settled(run, folder / "a.db", 5);
    EXPECT_TRUE(fs::exists(folder / "a.now"));
    run.signal(SIGKILL);
    EXPECT_EQ(run.wait().code, 128 + SIGKILL);
    EXPECT_TRUE(fs::exists(folder / "a.now"));
    const auto ended = run_program({"status", "a.db"}, folder.path());
    EXPECT_EQ(ended.out.find("under way"), std::string::npos) << ended.out;
}

TEST_F(ServedCampaign, NoProgramRemovesTheLogOfADatabaseThatTheServerHasOpen) {
    begin("a", 200, 0.01);
    const RemovedLogs removed(folder.path());
    LiveServer server(folder, "a.db");
    EventReader reader(server.events());
    for (const int ended_by : {SIGKILL, SIGINT}) {
        Process run(command_of("a"), folder.path());
        await_settled(run, folder / "a.db", settled("a") + 20);
        run.signal(ended_by);
        (void)run.wait();
        for (const auto* command : {"status", "verify", "dump"})
            EXPECT_EQ(run_program({command, "a.db"}, folder.path()).code, 0) << command;
        EXPECT_EQ(run_program({"run", "a.json", "--quiet", "--max-cases", "10", "-j", "1"}, folder.path()).code, 1);
    }
    const auto told = [&] { return std::set(reader.cases.begin(), reader.cases.end()).size(); };
    EXPECT_TRUE(reader.until([&] { return std::cmp_equal(told() + 1, settled("a")); }));
    EXPECT_EQ(removed.in_use(), 0);
    server.process().signal(SIGINT);
    EXPECT_EQ(server.process().wait().code, 0);
    EXPECT_EQ(run_program({"status", "a.db"}, folder.path()).code, 0);
    EXPECT_GT(removed.free(), 0) << "removals are seen";
}

// A process that closes another descriptor of the file loses its locks: the log must show what follows.
TEST_F(ServedCampaign, ARemovalUnderAProcessWithoutLocksIsSeen) {
    begin("a", 3, 0);
    const RemovedLogs removed(folder.path());
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open((folder / "a.db").c_str(), &db), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(db, "SELECT count(*) FROM sim_case", nullptr, nullptr, nullptr), SQLITE_OK);
    std::ifstream(folder / "a.db").get();
    EXPECT_EQ(run_program({"status", "a.db"}, folder.path()).code, 0);
    EXPECT_GT(removed.in_use(), 0);
    sqlite3_close(db);
}

// Rounds of stop, kill, resume, status, verify and VACUUM beside an open page, from tests/bench/served_slow.cpp.
TEST_F(ServedCampaign, RoundsOfStopKillAndResumeLoseNothing) {
    write("a", 4000, 0.002);
    const auto rounds = served_rounds(folder, 4, 20s);
    EXPECT_EQ(rounds.complaint, "");
    EXPECT_EQ(rounds.done, 4);
}

}  // namespace grainsweep::tests::served_test
