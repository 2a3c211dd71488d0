// Host (host.hpp) as the main program sees it: one process, launched once, that runs workers on another node. It passes
// their messages on through its standard input and output. The pool treats these workers like any other process.
#pragma once

#include "sweep/workers/child.hpp"
#include "sweep/workers/host_frame.hpp"
#include "sweep/workers/process.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace grainsweep::workers {

class HostedWorker;

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

class HostedWorker final : public Process {
public:
    HostedWorker(std::shared_ptr<RemoteHost> host, frames::WorkerNumber number);

    void listen(Listener listener) override { listener_ = std::move(listener); }
    void write(std::string line) override;
    [[nodiscard]] bool everything_is_written() const override { return host_->process_->everything_is_written(); }
    void close() override;
    void signal(int number) override;
    [[nodiscard]] bool runs() override { return runs_; }
    void wait(std::chrono::milliseconds) override {}  // the host reports its end
    [[nodiscard]] int status() const override { return status_; }
    [[nodiscard]] std::string end() const override;
    [[nodiscard]] bool lost_with_host() const override { return !host_end_.empty(); }
    void was_fruitful() override { host_->of_use_ = true; }
    [[nodiscard]] std::size_t node() const override { return host_->number(); }
    [[nodiscard]] std::string id() const override;
    [[nodiscard]] const std::string& log() override { return log_; }

private:
    friend class RemoteHost;
    void ended(int status, std::string_view log, const std::string& host_end);

    std::shared_ptr<RemoteHost> host_;
    frames::WorkerNumber number_;
    Listener listener_;
    bool runs_ = true, closed_ = false;
    int status_ = 0;
    std::string log_;
    std::string host_end_;  ///< why its host was lost
};

}  // namespace grainsweep::workers
