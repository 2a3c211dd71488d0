#include "sweep/workers/remote_host.hpp"

#include "sweep/workers/host.hpp"
#include "sweep/workers/process_start.hpp"

#include <fmt/format.h>
#include <sys/wait.h>

#include <algorithm>
#include <csignal>
#include <utility>
#include <variant>

namespace grainsweep::workers {

using namespace std::chrono_literals;

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

HostedWorker::HostedWorker(std::shared_ptr<RemoteHost> host, frames::WorkerNumber number)
    : host_(std::move(host)), number_(number) {}

void HostedWorker::write(std::string line) {
    if (closed_ || !runs_) return;
    std::string frame;
    frames::add_piece(frame, number_, line);
    host_->write(std::move(frame));
}

void HostedWorker::close() {
    if (std::exchange(closed_, true) || !runs_) return;
    std::string frame;
    frames::add_close(frame, number_);
    host_->write(std::move(frame));
}

void HostedWorker::signal(int number) {
    if (!runs_) return;
    std::string frame;
    frames::add_signal(frame, number_, number);
    if (number == SIGKILL) host_->killed_.emplace(number_, host_->clock_());
    host_->write(std::move(frame));
}

std::string HostedWorker::end() const {
    return host_end_.empty() ? describe_end("worker", status_) : fmt::format("host {} is gone: {}", id(), host_end_);
}

std::string HostedWorker::id() const {
    return fmt::format("{}.{}", host_->number(), number_);
}

void HostedWorker::ended(int status, std::string_view log, const std::string& host_end) {
    if (!std::exchange(runs_, false)) return;
    status_ = status;
    log_ = log;
    host_end_ = host_end;
    if (!closed_ && listener_.ended) listener_.ended();
}

}  // namespace grainsweep::workers
