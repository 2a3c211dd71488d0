#include "tests/support/served_rounds.hpp"

#include "tests/support/driven_browser.hpp"
#include "tests/support/event_reader.hpp"
#include "tests/support/failing_call.hpp"
#include "tests/support/live_server.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

namespace grainsweep::tests {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;
using namespace std::chrono_literals;

/// As another program sees the file; -1 where it cannot be read.
std::int64_t stored(const fs::path& file) {
    sqlite3* db = nullptr;
    sqlite3_stmt* rows = nullptr;
    std::int64_t count = -1;
    if (sqlite3_open_v2(file.c_str(), &db, SQLITE_OPEN_READWRITE, nullptr) == SQLITE_OK &&
        sqlite3_busy_timeout(db, 20000) == SQLITE_OK &&
        sqlite3_prepare_v2(db, "SELECT count(outcome) FROM sim_case WHERE outcome <> 'abandoned'", -1, &rows,
                           nullptr) == SQLITE_OK &&
        sqlite3_step(rows) == SQLITE_ROW)
        count = sqlite3_column_int64(rows, 0);
    sqlite3_finalize(rows);
    sqlite3_close(db);
    return count;
}

/// Returns the cases that are settled by the data of a page; a page adds what its events tell.
std::int64_t settled_in(const Json& data) {
    std::int64_t count = 0;
    for (const auto& campaign : data["campaigns"])
        for (const auto& [outcome, cases] :
             campaign["outcomes"].get<std::vector<std::pair<std::string, std::int64_t>>>())
            if (outcome != "not yet" && outcome != "abandoned") count += cases;
    return count;
}

/// Number of settled cases that a page shows.
constexpr std::string_view settled_tiles = R"([...document.querySelectorAll('.outcomes .tile')]
    .filter((one) => !/not yet|to be resumed/.test(one.textContent))
    .reduce((sum, one) => sum + Number(one.querySelector('b').textContent), 0))";

}  // namespace

ServedRounds served_rounds(const Folder& folder, int most, std::chrono::seconds at_most) {
    ServedRounds rounds;
    const RemovedLogs removed(folder.path());
    const auto file = folder / "a.db";
    const auto begun = Clock::now();
    const auto run_it = program_command({"run", "a.json", "--quiet", "-j", "1"});
    const auto first = run_program({"run", "a.json", "--quiet", "-j", "1", "--max-cases", "2"}, folder.path());
    if (first.code != 1) return rounds.complaint = "the first run: " + first.err, rounds;
    LiveServer server(folder, "a.db");
    const auto data = [&] { return Json::parse(server.get("/data").body); };
    const auto opened = data();
    EventReader page(server.events(opened["event"]));
    const auto shown = [&] { return settled_in(opened) + static_cast<std::int64_t>(page.settled.size()); };
    const auto complain = [&](const std::string& what) {
        if (rounds.complaint.empty()) rounds.complaint = fmt::format("round {}: {}", rounds.done, what);
    };
    while (rounds.done < most && Clock::now() - begun < at_most && rounds.complaint.empty()) {
        const auto before = stored(file);
        {
            Process run(run_it, folder.path());
            for (const auto last = Clock::now() + 20s;
                 run.running() && stored(file) < before + 5 && Clock::now() < last;)
                std::this_thread::sleep_for(5ms);
            const bool kills = rounds.done % 2 == 0;
            run.signal(kills ? SIGKILL : SIGINT);
            ++(kills ? rounds.kills : rounds.stops);
            const auto ended = run.wait();
            if (!kills && ended.code != 130 && ended.code != 0)
                complain(fmt::format("Ctrl-C ended it with {}", ended.code));
        }
        if (run_program({"status", "a.db"}, folder.path()).code != 0) complain("status");
        if (rounds.done % 3 == 0 && run_program({"verify", "a.db"}, folder.path()).code != 0)
            complain("verify finds damage");
        if (rounds.done % 3 == 1) {
            sqlite3* db = nullptr;
            sqlite3_open(file.c_str(), &db);
            sqlite3_busy_timeout(db, 20000);
            if (sqlite3_exec(db, "VACUUM", nullptr, nullptr, nullptr) == SQLITE_OK) ++rounds.vacuums;
            sqlite3_close(db);
        }
        const auto now = stored(file);
        if (now < before + 1) complain(fmt::format("{} cases are stored, {} were", now, before));
        const auto start = Clock::now();
        const bool follows = page.until([&] { return shown() == now; }, 10s);
        const auto seconds = std::chrono::duration<double>(Clock::now() - start).count();
        rounds.slowest = std::max(rounds.slowest, seconds);
        rounds.prompt += seconds < 2 ? 1 : 0;
        if (!follows) complain(fmt::format("the page shows {} cases, {} are stored", shown(), now));
        if (removed.in_use() > 0) complain("a write-ahead log was removed while another process had it open");
        ++rounds.done;
    }
    rounds.settled = stored(file);
    // Results since the last figures are events that a page opened now gets at once.
    {
        DrivenBrowser now_opened(server.address(), folder, {});
        if (!now_opened.until(fmt::format("{} === {}", settled_tiles, rounds.settled)))
            complain("a page opened now shows old counts");
    }
    for (const auto last = Clock::now() + 60s; settled_in(data()) != rounds.settled;) {
        if (Clock::now() > last) return complain("the figures stay old"), rounds;
        std::this_thread::sleep_for(500ms);
    }
    server.process().signal(SIGINT);
    if (server.process().wait().code != 0) complain("the server did not end with 0");
    return rounds;
}

}  // namespace grainsweep::tests
