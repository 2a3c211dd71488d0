#include "sweep/workers/hosts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

namespace grainsweep::workers {
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
