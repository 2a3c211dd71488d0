// Questions of the page of running campaigns to its server, and events that the server sends.
//
//   GET  /?token=T                    the page: that of `report`, whose figures grow
//   GET  /data?token=T                {"version", "event", "databases", "campaigns"}: page_data of now
//   GET  /events?token=T&since=E      events: `results` (as Follower tells them, with their database), `now` (what
//   runs),
//                                     `page` (newer data is there); their ids go up, and a reader that was away gets
//                                     what it missed
//   POST /query?token=T&database=NAME the body is SQL -> {"job": n}
//   POST /film?token=T&database=NAME&case=ID          -> {"job": n}, or {"film": address} where it is there already
//   GET  /job?token=T&number=n        {"running": true} | {"code", "out", "err"}
//   GET  /film?token=T&database=NAME&case=ID          the page of a film
//   POST /stop | /run | /again?... | /more?points=N   only where the user allowed it: what the command line would do;
//                                     with config=NAME where there are several campaign files
//
// Every question needs the token that was printed, and a Host field of this machine: a page of another site cannot ask
// even where it makes its own name point here (DNS rebinding).
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

/// What the reader of the page may run.
struct Control {
    std::vector<std::filesystem::path> configs;  ///< campaign files, with different names
};

/// What a page has started. It goes on where a database is added to those that are served.
struct Work {
    Jobs jobs;
    Runner runner;
};

/// Draws a random word of 128 bits.
[[nodiscard]] std::string new_token();

class Served {
public:
    /// Throws BrokenWorld, or WrongQuestion for a file that is no database of this program.
    Served(const std::vector<std::filesystem::path>& databases, std::optional<Control> control, std::string token,
           std::shared_ptr<Work> work = std::make_shared<Work>());
    [[nodiscard]] const std::shared_ptr<Work>& work() const { return work_; }

    [[nodiscard]] HttpReply answer(const HttpQuestion& question);
    /// Looks at the databases; the events since the last look, to be published.
    [[nodiscard]] std::string look();
    /// Tells readers of an earlier object that everything is to be asked anew.
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
    /// The campaign file that the question names, or the only one.
    [[nodiscard]] const std::filesystem::path* config_of(const HttpQuestion& question) const;
    /// The database that the question names, or the only one.
    [[nodiscard]] const Follower* asked(const HttpQuestion& question) const;
    [[nodiscard]] std::string event(std::string_view kind, std::string_view data, std::int64_t number) const;
    [[nodiscard]] std::string now_event() const;

    std::string token_, run_;  ///< run_: names this server in the ids of events
    std::vector<Follower> followers_;
    std::optional<Control> control_;
    std::atomic<std::int64_t> told_ = 0;
    GrowingPage page_;
    std::shared_ptr<Work> work_;
    std::deque<std::pair<std::int64_t, std::string>> recent_;  ///< events of results: number of the last result, text
    std::size_t recent_bytes_ = 0;
    std::int64_t version_ = 0;  ///< of the page that readers were told of
    Clock::time_point said_now_{}, polled_{};
    double poll_seconds_ = 0;
    bool computing_ = false;
};

}  // namespace grainsweep::live
