#include "sweep/workers/hosts.hpp"

#include "sweep/workers/host.hpp"
#include "sweep/workers/host_frame.hpp"
#include "sweep/workers/process_start.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <map>
#include <string_view>
#include <utility>
#include <variant>

namespace grainsweep::workers {

using namespace std::chrono_literals;

class HostedWorker;

/// Host (host.hpp) as the main program sees it: one process, launched once, that runs workers on another node. It
/// passes their messages on through its standard input and output. The pool treats these workers like any other
/// process.
class RemoteHost final : public std::enable_shared_from_this<RemoteHost> {
public:
    struct Listener {
        std::function<void(std::string_view line)> greeting;  ///< called for lines of its launcher, before the host's
                                                              ///< first message
        /// Called when the host and its workers are lost, after each worker has been notified.
        std::function<void(std::string reason)> gone;
    };

    RemoteHost(std::shared_ptr<Child> process, std::size_t number, double now);

    void listen(Listener listener, std::function<double()> clock);
    /// Starts a worker. A host that is not ready yet receives the message when it is.
    [[nodiscard]] std::shared_ptr<HostedWorker> start_worker();
    /// Sends a heartbeat of the main program.
    void lease();
    /// Ignores all further output of the host and counts all its workers as ended.
    void give_up(const std::string& reason);

    [[nodiscard]] const std::shared_ptr<Child>& process() const { return process_; }
    [[nodiscard]] std::size_t number() const { return number_; }
    [[nodiscard]] bool is_ready() const { return ready_; }
    /// Returns whether one of its workers began a case.
    [[nodiscard]] bool was_of_use() const { return of_use_; }
    /// Returns whether it ended because a frame was damaged, in either direction.
    [[nodiscard]] bool was_unsound() const { return unsound_; }
    /// Returns the number of its workers that have not ended.
    [[nodiscard]] std::size_t workers() const { return workers_.size(); }
    [[nodiscard]] double launched() const { return launched_; }
    /// Returns the seconds since its last output.
    [[nodiscard]] double silence(double now) const { return now - heard_; }
    /// Returns the seconds since the oldest request to kill a worker that has not ended yet; 0: there is none.
    [[nodiscard]] double owes_an_end(double now) const;

private:
    friend class HostedWorker;
    void take(const frames::Frame& frame);
    void lose(const std::string& reason);
    void write(std::string frames);

    std::shared_ptr<Child> process_;
    std::size_t number_;
    Listener listener_;
    std::function<double()> clock_;
    frames::Reader reader_{frames::Reader::Side::main_program};
    std::map<frames::WorkerNumber, std::weak_ptr<HostedWorker>> workers_;
    std::map<frames::WorkerNumber, double> killed_;  ///< time of the request, for workers whose end is not reported yet
    frames::WorkerNumber last_ = 0;
    bool ready_ = false, of_use_ = false, unsound_ = false, gone_ = false;
    double launched_, heard_;
};

/// Worker of a host.
class HostedWorker final : public Process {
public:
    HostedWorker(std::shared_ptr<RemoteHost> host, frames::WorkerNumber number)
        : host_(std::move(host)), number_(number) {}

    void listen(Listener listener) override { listener_ = std::move(listener); }
    void write(std::string line) override {
        if (closed_ || !runs_) return;
        std::string frame;
        frames::add_piece(frame, number_, line);
        host_->write(std::move(frame));
    }
    [[nodiscard]] bool everything_is_written() const override { return host_->process_->everything_is_written(); }
    void close() override {
        if (std::exchange(closed_, true) || !runs_) return;
        std::string frame;
        frames::add_close(frame, number_);
        host_->write(std::move(frame));
    }
    void signal(int number) override {
        if (!runs_) return;
        std::string frame;
        frames::add_signal(frame, number_, number);
        if (number == SIGKILL) host_->killed_.emplace(number_, host_->clock_());
        host_->write(std::move(frame));
    }
    [[nodiscard]] bool runs() override { return runs_; }
    void wait(std::chrono::milliseconds) override {}  // the host reports its end
    [[nodiscard]] int status() const override { return status_; }
    [[nodiscard]] std::string end() const override {
        return host_end_.empty() ? describe_end("worker", status_)
                                 : fmt::format("host {} is gone: {}", id(), host_end_);
    }
    [[nodiscard]] bool lost_with_host() const override { return !host_end_.empty(); }
    void was_fruitful() override { host_->of_use_ = true; }
    [[nodiscard]] std::size_t node() const override { return host_->number(); }
    [[nodiscard]] std::string id() const override { return fmt::format("{}.{}", host_->number(), number_); }
    [[nodiscard]] const std::string& log() override { return log_; }

private:
    friend class RemoteHost;
    void ended(int status, std::string_view log, const std::string& host_end) {
        if (!std::exchange(runs_, false)) return;
        status_ = status;
        log_ = log;
        host_end_ = host_end;
        if (!closed_ && listener_.ended) listener_.ended();
    }

    std::shared_ptr<RemoteHost> host_;
    frames::WorkerNumber number_;
    Listener listener_;
    bool runs_ = true, closed_ = false;
    int status_ = 0;
    std::string log_;
    std::string host_end_;  ///< why its host was lost
};

RemoteHost::RemoteHost(std::shared_ptr<Child> process, std::size_t number, double now)
    : process_(std::move(process)), number_(number), launched_(now), heard_(now) {}

void RemoteHost::listen(Listener listener, std::function<double()> clock) {
    listener_ = std::move(listener);
    clock_ = std::move(clock);
    process_->listen({[this, known = weak_from_this()](std::string_view piece) {
                          const auto self = known.lock();
                          if (!self || gone_) return;
                          heard_ = clock_();
                          const bool sound = reader_.feed(piece, [this](const frames::Frame& frame) {
                              if (!gone_) take(frame);
                          });
                          if (sound || gone_) return;
                          unsound_ = true;
                          lose("it wrote something that no host writes, or it was changed on its way");
                      },
                      [this, known = weak_from_this()] {
                          const auto self = known.lock();
                          if (!self || gone_) return;
                          process_->signal(SIGKILL);  // whatever is left of its process group
                          process_->wait(2s);
                          const int status = process_->status();
                          unsound_ = WIFEXITED(status) && WEXITSTATUS(status) == no_frames;
                          lose(describe_end("it", status));
                      }});
}

void RemoteHost::take(const frames::Frame& frame) {
    const auto worker = [&](frames::WorkerNumber number) {
        const auto found = workers_.find(number);
        return found == workers_.end() ? nullptr : found->second.lock();
    };
    if (const auto* piece = std::get_if<frames::Piece>(&frame)) {
        const auto by = worker(piece->worker);
        if (by && !by->closed_ && by->listener_.read) by->listener_.read(piece->bytes);
    } else if (const auto* ended = std::get_if<frames::Ended>(&frame)) {
        const auto by = worker(ended->worker);
        workers_.erase(ended->worker);
        killed_.erase(ended->worker);
        if (by) by->ended(ended->status, ended->log, {});
    } else if (const auto* hello = std::get_if<frames::Hello>(&frame)) {
        if (ready_ || hello->protocol != frames::host_protocol)
            return lose(fmt::format("it is a host of protocol {}, the main program has {}", hello->protocol,
                                    frames::host_protocol));
        ready_ = true;
    } else if (const auto* greeting = std::get_if<frames::Greeting>(&frame)) {
        listener_.greeting(greeting->line);
    } else if (!std::holds_alternative<frames::Beat>(frame)) {
        lose("it wrote what only a main program writes");
    }
}

void RemoteHost::lose(const std::string& reason) {
    std::string all = reason;
    if (const auto& log = process_->log(); !log.empty()) all += "; it wrote: " + log;
    give_up(all);
    listener_.gone(all);
}

void RemoteHost::give_up(const std::string& reason) {
    gone_ = true;
    process_->close();
    for (const auto& [number, known] : std::exchange(workers_, {})) {
        if (const auto worker = known.lock()) worker->ended(SIGKILL, {}, reason);
    }
}

void RemoteHost::write(std::string frames) {
    if (!gone_) process_->write(std::move(frames));
}

std::shared_ptr<HostedWorker> RemoteHost::start_worker() {
    auto worker = std::make_shared<HostedWorker>(shared_from_this(), ++last_);
    workers_.emplace(last_, worker);
    std::string frame;
    frames::add_start(frame, last_);
    write(std::move(frame));
    return worker;
}

void RemoteHost::lease() {
    if (process_->everything_is_written()) write(std::string(frames::lease_frame));
}

double RemoteHost::owes_an_end(double now) const {
    double longest = 0;
    for (const auto& [number, when] : killed_) longest = std::max(longest, now - when);
    return longest;
}

namespace {

constexpr auto time_to_end_workers = std::chrono::seconds(5);
constexpr int most_unsound = 10;     // hosts lost to changed frames; beyond this the connection itself changes data
constexpr double time_to_kill = 10;  // s; a worker that cannot be ended would keep its place for ever

std::vector<std::string> with_host_number(std::vector<std::string> argv, std::size_t number) {
    constexpr std::string_view mark = "{host}";
    for (auto& word : argv) {
        for (auto at = word.find(mark); at != std::string::npos; at = word.find(mark, at))
            word.replace(at, mark.size(), std::to_string(number));
    }
    return argv;
}

}  // namespace

Hosts::Hosts(EventLoop& loop, HostPlan plan, Listener listener)
    : loop_(loop), plan_(std::move(plan)), listener_(std::move(listener)), fruitless_(plan_.argv) {}

std::shared_ptr<Process> Hosts::start_worker() {
    const bool more = hosts_.size() < plan_.hosts && !fruitless_.waits(listener_.clock());
    if (more && launch()) return hosts_.back()->start_worker();
    const auto fewest = std::ranges::min_element(hosts_, {}, [](const auto& host) { return host->workers(); });
    if (fewest == hosts_.end() || (*fewest)->workers() >= plan_.workers_each) return nullptr;
    return (*fewest)->start_worker();
}

bool Hosts::launch() {
    const std::size_t number = free_number();
    std::error_code error;
    auto child = Child::start(loop_, with_host_number(plan_.argv, number), error);
    const double now = listener_.clock();
    if (child == nullptr) {
        if (auto remark = fruitless_.not_launched(error.message(), hosts_.size(), now))
            listener_.say(std::move(*remark));
        return false;
    }
    const auto host = std::make_shared<RemoteHost>(std::move(child), number, now);
    hosts_.push_back(host);
    host->listen({[this](std::string_view line) { listener_.greeting(std::string(line)); },
                  [this, known = std::weak_ptr(host)](const std::string& reason) {
                      if (const auto found = known.lock()) gone(found, reason);
                  }},
                 listener_.clock);
    return true;
}

std::size_t Hosts::free_number() const {
    std::size_t number = 1;
    while (std::ranges::any_of(hosts_, [&](const auto& host) { return host->number() == number; })) ++number;
    return number;
}

void Hosts::gone(const std::shared_ptr<RemoteHost>& host, const std::string& reason) {
    const double now = listener_.clock();
    std::erase(hosts_, host);
    leaving_.hurry(host->process(), true, now);
    if (retired_) return;
    if (host->was_unsound() && ++unsound_ == most_unsound) {
        fruitless_.give_up(reason);
    } else if (host->was_of_use()) {
        fruitless_.fruitful();
        listener_.say(fmt::format("host {} is gone: {}", host->number(), reason));
    } else if (auto remark = fruitless_.ended(reason, host->is_ready(), hosts_.size(), now)) {
        listener_.say(std::move(*remark));
    }
}

void Hosts::lease() {
    for (const auto& host : hosts_) host->lease();
}

void Hosts::keep_time() {
    const double now = listener_.clock();
    const auto& limits = plan_.limits;
    const auto watched = hosts_;
    for (const auto& host : watched) {
        std::string reason;
        if (!host->is_ready()) {
            if (limits.start && now - host->launched() > *limits.start)
                reason = fmt::format("it was not ready within {} s", *limits.start);
        } else if (limits.silence && host->silence(now) > *limits.silence) {
            reason = fmt::format("it gave no sign of life for {} s", *limits.silence);
        } else if (host->owes_an_end(now) > time_to_kill) {
            reason = fmt::format("it could not end a worker within {} s", time_to_kill);
        }
        if (reason.empty()) continue;
        host->give_up(reason);
        gone(host, reason);
    }
    leaving_.keep_time(now);
}

void Hosts::end_all(std::vector<std::shared_ptr<Process>> workers) {
    retired_ = true;
    using Clock = std::chrono::steady_clock;
    for (const auto until = Clock::now() + time_to_end_workers; Clock::now() < until;) {  // their ends are read
        std::erase_if(workers, [](const auto& worker) { return !worker->runs(); });
        if (workers.empty()) break;
        loop_.run_one_for(std::chrono::milliseconds(50));
    }
    std::vector<std::shared_ptr<Process>> processes;
    for (const auto& host : hosts_) {
        processes.push_back(host->process());
        host->give_up("the main program ends");
    }
    hosts_.clear();
    leaving_.end_all(std::move(processes));
}

}  // namespace grainsweep::workers
