#include "sweep/workers/pool.hpp"

#include "sweep/workers/message.hpp"

#include <utility>  // Boost 1.74's Asio needs it first under C++20

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boost/asio.hpp>
#include <boost/process.hpp>
#include <boost/process/extend.hpp>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <thread>

namespace grainsweep::workers {
namespace {

namespace asio = boost::asio;
namespace bp = boost::process;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

// A case predicted to take less than this waits its turn inside the worker, so that no worker idles while
// the boss is busy.
constexpr double short_case_seconds = 0.05;
constexpr std::size_t queue_of_short_cases = 4;
constexpr std::size_t kept_log_bytes = 4096;
constexpr auto lease_every = 10s;
constexpr auto grace_before_kill = 2s;
constexpr auto time_to_end = 5s;  // of a worker that has nothing left to do, and of what launched it
// So many workers in a row that end before they are ready: the launcher is wrong, not the case. One that somebody
// killed says less about the launcher.
constexpr int unready_limit = 3;
constexpr int killed_unready_limit = 10;

/// Our ends of a pipe must not live on in other workers, or nobody would ever see an end of file.
void close_on_exec(bp::async_pipe& pipe) {
    for (const int fd : {pipe.native_source(), pipe.native_sink()}) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
}

boost::filesystem::path program_of(const std::string& word) {
    if (word.find('/') == std::string::npos) return bp::search_path(word);
    boost::system::error_code error;
    const bool there = boost::filesystem::is_regular_file(word, error) && ::access(word.c_str(), X_OK) == 0;
    return there ? boost::filesystem::path(word) : boost::filesystem::path();
}

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

bool was_killed(int status) {
    return WIFSIGNALED(status) && (WTERMSIG(status) == SIGKILL || WTERMSIG(status) == SIGTERM);
}

std::string describe_end(int status) {
    if (WIFSIGNALED(status)) {
        const int signal = WTERMSIG(status);
        return "worker ended by signal " + std::to_string(signal) + " (" + ::strsignal(signal) + ")";
    }
    return "worker ended with exit code " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

struct Pool::Impl {
    struct Worker {
        explicit Worker(asio::io_context& io) : in(io), out(io), err(io) {}
        bp::child process;
        bp::async_pipe in, out, err;
        asio::streambuf buffer, log_buffer;
        std::string log;
        std::deque<campaign::Attempt> cases;  // the first is being computed
        std::deque<std::string> outgoing;
        Clock::time_point began{};
        std::optional<Clock::time_point> killed_at;
        bool ready = false, timed_out = false, retiring = false, ended = false, kill_sent = false;
        std::string complaint;
    };

    explicit Impl(PoolOptions o) : options(std::move(o)), signals(io, SIGINT, SIGTERM) { await_signal(); }

    // ---- events ------------------------------------------------------------------------------------------

    void await_signal() {
        signals.async_wait([this](const boost::system::error_code& error, int) {
            if (error) return;
            events.emplace_back(Interrupted{interruptions++ > 0});
            await_signal();
        });
    }

    void await_line(const std::shared_ptr<Worker>& worker) {
        asio::async_read_until(worker->out, worker->buffer, '\n',
                               [this, worker](const boost::system::error_code& error, std::size_t length) {
                                   if (error) return lose(worker);
                                   const auto* data = static_cast<const char*>(worker->buffer.data().data());
                                   const std::string line(data, length);
                                   worker->buffer.consume(length);
                                   hear(worker, line);
                                   if (!worker->ended) await_line(worker);
                               });
    }

    void await_log(const std::shared_ptr<Worker>& worker) {
        asio::async_read(worker->err, worker->log_buffer, asio::transfer_at_least(1),
                         [this, worker](const boost::system::error_code& error, std::size_t length) {
                             const auto* data = static_cast<const char*>(worker->log_buffer.data().data());
                             worker->log.append(data, length);
                             worker->log_buffer.consume(length);
                             if (worker->log.size() > kept_log_bytes) {
                                 worker->log.erase(0, worker->log.size() - kept_log_bytes);
                             }
                             if (!error) await_log(worker);
                         });
    }

    void hear(const std::shared_ptr<Worker>& worker, const std::string& line) {
        try {
            ToBoss message = decode_to_boss(line);
            if (auto* done = std::get_if<Done>(&message)) {
                take_off(*worker, done->result.attempt);
                events.emplace_back(Finished{std::move(done->result), done->checkpointed});
            } else if (auto* parked = std::get_if<Parked>(&message)) {
                const bool begun = worker->ready && !worker->cases.empty() && parked->attempt == worker->cases.front();
                const double seconds = begun ? seconds_since(worker->began) : 0;
                take_off(*worker, parked->attempt);
                events.emplace_back(GivenBack{parked->attempt, seconds});
            } else if (auto* alive = std::get_if<Alive>(&message)) {
                events.emplace_back(Heartbeat{alive->attempt, alive->progress});
            } else if (const auto& ready = std::get<Ready>(message); ready.version == options.version) {
                worker->ready = true;
                worker->began = Clock::now();  // what it took to be launched is not the case's
                unready_in_a_row = 0;
            } else {
                complain(*worker,
                         fmt::format("the worker is build {}, the boss is build {}", ready.version, options.version));
            }
        } catch (const std::invalid_argument& error) {
            complain(*worker, fmt::format("the worker wrote something that is no message: {}", error.what()));
        }
    }

    void complain(Worker& worker, std::string complaint) {
        worker.complaint = std::move(complaint);
        kill(worker, SIGKILL);
    }

    static void take_off(Worker& worker, const campaign::Attempt& attempt) {
        const auto found = std::ranges::find(worker.cases, attempt);
        if (found == worker.cases.end()) throw std::invalid_argument("an answer to a case it was not given");
        worker.cases.erase(found);
        worker.began = Clock::now();
    }

    void lose(const std::shared_ptr<Worker>& worker) {
        if (worker->ended) return;
        worker->ended = true;
        kill(*worker, SIGKILL);  // whatever is left of its process group
        std::error_code ignored;
        worker->process.wait(ignored);
        std::erase(workers, worker);
        if (worker->retiring && worker->cases.empty()) return;
        std::vector<campaign::Attempt> queued(worker->cases.begin(), worker->cases.end());
        std::optional<campaign::Attempt> running;
        if (!queued.empty() && worker->ready) {  // a worker that was never ready has begun no case
            running = queued.front();
            queued.erase(queued.begin());
        }
        if (queued.empty() && !running && worker->ready) return;
        std::string reason =
            worker->complaint.empty() ? describe_end(worker->process.native_exit_code()) : worker->complaint;
        if (!worker->log.empty()) reason += "; it wrote: " + worker->log;
        const double seconds = seconds_since(worker->began);
        const bool killed = worker->complaint.empty() && was_killed(worker->process.native_exit_code());
        const int limit = killed ? killed_unready_limit : unready_limit;
        if (!worker->ready && ++unready_in_a_row >= limit) {
            broken = "cannot start workers with '" + joined(options.command) + "': " + reason;
        }
        if (worker->timed_out && running) {
            events.emplace_back(TimedOut{*running, std::move(queued),
                                         fmt::format("no answer within {} s", options.wall_seconds), seconds});
        } else {
            events.emplace_back(Lost{std::move(running), std::move(queued), std::move(reason), seconds});
        }
    }

    // ---- doing -------------------------------------------------------------------------------------------

    std::shared_ptr<Worker> launch() {
        auto worker = std::make_shared<Worker>(io);
        for (auto* pipe : {&worker->in, &worker->out, &worker->err}) close_on_exec(*pipe);
        std::error_code error;
        const auto& command = options.command;
        const auto executable = program_of(command.front());
        if (executable.empty())
            throw std::runtime_error(fmt::format("cannot find '{}' to start a worker", command.front()));
        worker->process = bp::child(
            executable, bp::args(std::vector<std::string>(command.begin() + 1, command.end())),
            bp::std_in<worker->in, bp::std_out> worker->out, bp::std_err > worker->err, error,
            // a process group of its own: the terminal's Ctrl-C reaches only the boss, and a kill reaches all of it
            bp::extend::on_exec_setup = [](auto&) { ::setpgid(0, 0); });
        if (error)
            throw std::runtime_error(
                fmt::format("cannot start a worker with '{}': {}", command.front(), error.message()));
        worker->began = Clock::now();
        workers.push_back(worker);
        await_line(worker);
        await_log(worker);
        return worker;
    }

    static void kill(Worker& worker, int signal) {
        const pid_t pid = worker.process.id();
        if (pid > 0 && ::kill(-pid, signal) != 0) ::kill(pid, signal);  // before it made its own group
    }

    void send(const std::shared_ptr<Worker>& worker, const ToWorker& message) {
        worker->outgoing.push_back(encode(message) + "\n");
        if (worker->outgoing.size() == 1) write_next(worker);
    }

    void write_next(const std::shared_ptr<Worker>& worker) {
        asio::async_write(worker->in, asio::buffer(worker->outgoing.front()),
                          [this, worker](const boost::system::error_code& error, std::size_t) {
                              if (error || worker->ended) return;  // its end of file will be heard
                              worker->outgoing.pop_front();
                              if (!worker->outgoing.empty()) write_next(worker);
                          });
    }

    void keep_time() {
        const auto now = Clock::now();
        if (now - leased > lease_every) {
            leased = now;
            for (const auto& worker : workers) send(worker, Lease{});
        }
        for (const auto& worker : workers) {
            if (options.wall_seconds > 0 && worker->ready && !worker->cases.empty() && !worker->timed_out &&
                now - worker->began > std::chrono::duration<double>(options.wall_seconds)) {
                worker->timed_out = true;
                worker->killed_at = now;
                kill(*worker, SIGTERM);
            }
            if (worker->killed_at && !worker->kill_sent && now - *worker->killed_at > grace_before_kill) {
                worker->kill_sent = true;
                kill(*worker, SIGKILL);
            }
        }
    }

    /// The worker the next case goes to: an idle one, a new one, or for short cases the shortest queue.
    std::shared_ptr<Worker> place_for(double predicted_seconds) const {
        std::shared_ptr<Worker> best;
        for (const auto& worker : workers) {
            if (worker->timed_out || worker->retiring) continue;
            if (!best || worker->cases.size() < best->cases.size()) best = worker;
        }
        if (best && best->cases.empty()) return best;
        if (workers.size() < options.workers) return nullptr;  // launch one
        if (best && predicted_seconds < short_case_seconds && best->cases.size() < queue_of_short_cases) return best;
        return nullptr;
    }

    PoolOptions options;
    asio::io_context io;
    asio::signal_set signals;
    std::vector<std::shared_ptr<Worker>> workers;
    std::deque<PoolEvent> events;
    Clock::time_point leased = Clock::now();
    int interruptions = 0;
    bool retired = false;
    int unready_in_a_row = 0;  // workers lost before they said they were ready
    std::string broken;        // why no worker can be had at all
};

Pool::Pool(PoolOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {
    std::signal(SIGPIPE, SIG_IGN);  // a write to a dead worker is an error code, not our end
}

Pool::~Pool() {
    dismiss();
}

bool Pool::has_room(double predicted_seconds) const {
    return !impl_->retired &&
           (impl_->workers.size() < impl_->options.workers || impl_->place_for(predicted_seconds) != nullptr);
}

void Pool::start(const campaign::Attempt& attempt, const campaign::Case& question) {
    auto worker = impl_->place_for(0);
    if (!worker) worker = impl_->launch();
    if (worker->cases.empty()) worker->began = Clock::now();
    worker->cases.push_back(attempt);
    impl_->send(worker, Run{attempt.number, question});
}

std::optional<PoolEvent> Pool::wait(std::chrono::milliseconds at_most) {
    const auto until = Clock::now() + at_most;
    impl_->io.poll();
    impl_->keep_time();
    while (impl_->events.empty()) {
        if (!impl_->broken.empty()) throw std::runtime_error(impl_->broken);
        const auto left = until - Clock::now();
        if (left <= 0s) return std::nullopt;
        impl_->io.restart();
        impl_->io.run_one_for(std::min<Clock::duration>(left, 100ms));
        impl_->keep_time();
    }
    PoolEvent event = std::move(impl_->events.front());
    impl_->events.pop_front();
    return event;
}

std::size_t Pool::outstanding() const {
    std::size_t count = 0;
    for (const auto& worker : impl_->workers) count += worker->cases.size();
    return count;
}

void Pool::retire() {
    impl_->retired = true;
    for (const auto& worker : impl_->workers) {
        worker->retiring = true;
        impl_->send(worker, Stop{});
    }
}

bool Pool::can_start(const std::string& program) {
    return !program_of(program).empty();
}

// A launcher has things to do after its worker has ended (srun gives its part of the machine back), so both are
// asked, then told, and killed last. Workers that were retired and have nothing left to do end by themselves.
void Pool::dismiss() {
    const auto runs = [](const auto& worker) {
        std::error_code ignored;
        return worker->process.running(ignored);
    };
    const auto running = [&] { return std::ranges::any_of(impl_->workers, runs); };
    const auto wait_for = [&](std::chrono::milliseconds at_most) {
        const auto until = Clock::now() + at_most;
        for (auto pause = 1ms; running() && Clock::now() < until;
             pause = std::min<std::chrono::milliseconds>(2 * pause, 50ms))
            std::this_thread::sleep_for(pause);
    };
    for (const auto& worker : impl_->workers) {
        worker->ended = true;
        if (!worker->retiring || !worker->cases.empty()) Impl::kill(*worker, SIGTERM);
    }
    wait_for(time_to_end);
    for (const auto& worker : impl_->workers)
        if (runs(worker)) Impl::kill(*worker, SIGTERM);
    wait_for(grace_before_kill);
    for (const auto& worker : impl_->workers) {
        if (runs(worker)) Impl::kill(*worker, SIGKILL);
        ::kill(-worker->process.id(), SIGKILL);  // whatever is left of its process group
        std::error_code ignored;
        worker->process.wait(ignored);
    }
    impl_->workers.clear();
}

}  // namespace grainsweep::workers
