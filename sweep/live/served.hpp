// Requests of the page of running campaigns to its server, and events of the server.
//
//   GET  /?token=T                    the page: that of `report`, whose figures grow
//   GET  /data?token=T                {"version", "event", "databases", "campaigns"}: the present page_data
//   GET  /events?token=T&since=E      events: `results` (of Follower, with the database), `now` (state of the run),
//                                     `page` (newer data exists). Their ids increase, and a reader that returns gets
//                                     the events that it missed
//   POST /query?token=T&database=NAME the body is SQL -> {"job": n}
//   POST /film?token=T&database=NAME&case=ID          -> {"job": n}, or {"film": address} where it is there already
//   GET  /job?token=T&number=n        {"running": true} | {"code", "out", "err"}
//   GET  /film?token=T&database=NAME&case=ID          the page of a film
//   POST /stop | /run | /again?... | /more?points=N   as on the command line; only if the user has allowed it;
//                                     with config=NAME if there are several campaign files
//
// Every request needs the printed token, and a Host field of this machine, so that pages of other sites cannot send
// requests, even by DNS rebinding.
#pragma once

#include "sweep/live/follower.hpp"
#include "sweep/live/growing_page.hpp"
#include "sweep/live/http_server.hpp"
#include "sweep/live/jobs.hpp"
#include "sweep/live/now.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::live {

/// Permitted control of the campaign by the reader of the page.
struct Control {
    std::vector<std::filesystem::path> configs;  ///< campaign files, with different names
};

/// Work that a page has started. It continues when a database is added to the server.
struct Work {
    Jobs jobs;
    Runner runner;
};

/// Returns a random word of 128 bits.
[[nodiscard]] std::string new_token();

class Served {
public:
    /// Opens the databases. Throws BrokenWorld, or WrongQuestion for a file that is no database of this program.
    Served(const std::vector<std::filesystem::path>& databases, std::optional<Control> control, std::string token,
           std::shared_ptr<Work> work = std::make_shared<Work>());
    [[nodiscard]] const std::shared_ptr<Work>& work() const { return work_; }

    [[nodiscard]] HttpReply answer(const HttpQuestion& question);
    /// Polls the databases. Returns the events since the last call, to be published.
    [[nodiscard]] std::string look();
    /// Returns the event that makes readers of an earlier object reload all data.
    [[nodiscard]] std::string changed() const;

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] HttpReply page() const;
    [[nodiscard]] HttpReply data() const;
    [[nodiscard]] HttpReply events(const HttpQuestion& question) const;
    [[nodiscard]] HttpReply start_query(const HttpQuestion& question);
    [[nodiscard]] HttpReply start_film(const HttpQuestion& question);
    [[nodiscard]] HttpReply film(const HttpQuestion& question) const;
    [[nodiscard]] HttpReply job(const HttpQuestion& question);
    [[nodiscard]] HttpReply steer(const HttpQuestion& question);
    /// Returns the campaign file that the request names, or the only one.
    [[nodiscard]] const std::filesystem::path* config_of(const HttpQuestion& question) const;
    /// Returns the database that the request names, or the only one.
    [[nodiscard]] const Follower* asked(const HttpQuestion& question) const;
    [[nodiscard]] std::string event(std::string_view kind, std::string_view data, std::int64_t number) const;
    [[nodiscard]] std::string now_event() const;

    std::string token_, run_;  ///< run_: name of this server in the ids of events
    std::vector<Follower> followers_;
    std::optional<Control> control_;
    std::atomic<std::int64_t> told_ = 0;
    GrowingPage page_;
    std::shared_ptr<Work> work_;
    std::deque<std::pair<std::int64_t, std::string>> recent_;  ///< events of results: number of the last result, text
    std::size_t recent_bytes_ = 0;
    std::int64_t version_ = 0;  ///< version of the page last sent to readers
    Clock::time_point said_now_{}, polled_{};
    double poll_seconds_ = 0;
    bool computing_ = false;
};

}  // namespace grainsweep::live
