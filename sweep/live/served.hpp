// Requests of the page of running campaigns to its server, and events of the server.
//
//   GET  /?token=T                    the page: that of `report`, whose figures grow
//   GET  /data?token=T                {"version", "event", "databases", "campaigns"}: the present page_data
//   GET  /events?token=T&since=E      events: `results` (of Follower, with the database), `now` (state of the run),
//                                     `page` (newer data exists). Their ids increase, and a reader that returns gets
//                                     the events that it missed. With once=1 it gets them and no stream: tabs of one
//                                     browser, which opens six connections to a server, share the stream of one of them
//   POST /query?token=T&database=NAME the body is SQL -> {"job": n}
//   POST /film?token=T&database=NAME&case=ID          -> {"film": address, "job": n}, without a job where it is there
//   GET  /job?token=T&number=n        {"running": true} | {"code", "out", "err"}
//   GET  /film?token=T&database=NAME&case=ID          the page of a film that this server has made, in a sandbox: it
//   GET  /film?ticket=W               has no origin. The address with a ticket (see POST) does not hold the token
//   POST /stop | /run | /again?... | /more?points=N   as on the command line; only if the user has allowed it;
//                                     with config=NAME if there are several campaign files
//
// Every request needs the printed token, and a Host field of this machine or of the proxy that the user names, so that
// pages of other sites cannot send requests, even by DNS rebinding. A page without a token gets the one that its tab
// has kept: the token leaves the address after the first load.
#pragma once

#include "sweep/live/follower.hpp"
#include "sweep/live/growing_page.hpp"
#include "sweep/live/http_server.hpp"
#include "sweep/live/jobs.hpp"
#include "sweep/live/now.hpp"

#include <chrono>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <map>
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

/// Addresses under which a proxy (of a notebook or a cluster) shows this server.
struct Proxy {
    std::string base_path = "/";     ///< begins and ends with a slash
    std::vector<std::string> hosts;  ///< further names in the Host field, without a port
};

/// Returns a random word of 128 bits.
[[nodiscard]] std::string new_token();

class Served {
public:
    /// Databases that cannot be read are named on the page. `ended` is asked often and stops reading.
    Served(const std::vector<std::filesystem::path>& databases, std::optional<Control> control, std::string token,
           Proxy proxy = {}, std::function<bool()> ended = {});
    /// Replaces the list of databases. Those that stay are followed on.
    void follow(const std::vector<std::filesystem::path>& databases);
    /// Returns whether figures are computed, which lasts.
    [[nodiscard]] bool busy() const { return page_.busy(); }

    /// Ends jobs and removes their files. For a process that ends without its destructors.
    void end_work();

    [[nodiscard]] HttpReply answer(const HttpQuestion& question);
    /// Polls the databases. Returns the events since the last call, to be published.
    [[nodiscard]] std::string look();

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] HttpReply page() const;
    [[nodiscard]] HttpReply data() const;
    [[nodiscard]] HttpReply events(const HttpQuestion& question) const;
    [[nodiscard]] HttpReply start_query(const HttpQuestion& question);
    /// Film of a case, made by this server.
    struct Film {
        std::string ticket;
        bool whole = false;  ///< false: a picture of an unfinished case, which is soon out of date
        std::int64_t job = 0;
    };
    [[nodiscard]] HttpReply start_film(const HttpQuestion& question);
    [[nodiscard]] HttpReply film(const HttpQuestion& question) const;
    [[nodiscard]] HttpReply film_of(const std::string& ticket) const;
    [[nodiscard]] std::filesystem::path film_file(const std::string& ticket) const;
    [[nodiscard]] bool is_own_name(std::string_view host) const;
    [[nodiscard]] bool is_own_origin(const HttpQuestion& question) const;
    [[nodiscard]] HttpReply job(const HttpQuestion& question);
    [[nodiscard]] HttpReply steer(const HttpQuestion& question, std::string_view path);
    /// Returns the campaign file that the request names, or the only one.
    [[nodiscard]] const std::filesystem::path* config_of(const HttpQuestion& question) const;
    /// Returns the database that the request names, or the only one.
    [[nodiscard]] Follower* asked(const HttpQuestion& question);
    [[nodiscard]] const Follower* asked(const HttpQuestion& question) const;
    [[nodiscard]] std::string event(std::string_view kind, std::string_view data, std::int64_t number) const;
    [[nodiscard]] std::string now_event() const;

    std::string token_, run_;  ///< run_: name of this server in the ids of events
    std::function<bool()> ended_;
    std::vector<Follower> followers_;
    std::optional<Control> control_;
    Proxy proxy_;
    std::int64_t told_ = 0;
    GrowingPage page_;
    PrivateFolder films_folder_;
    std::map<std::pair<std::string, std::string>, Film> films_;  ///< by database and case
    Jobs jobs_;
    Runner runner_;
    std::deque<std::pair<std::int64_t, std::string>> recent_;  ///< events of results: number of the last result, text
    std::size_t recent_bytes_ = 0;
    std::int64_t version_ = 0;  ///< version of the page last sent to readers
    Clock::time_point said_now_{}, polled_{};
    double poll_seconds_ = 0;
    bool computing_ = false;
};

}  // namespace grainsweep::live
