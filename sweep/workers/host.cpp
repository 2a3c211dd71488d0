#include "sweep/workers/host.hpp"

#include "sweep/files/descriptor.hpp"
#include "sweep/workers/asking_signals.hpp"
#include "sweep/workers/child.hpp"
#include "sweep/workers/host_frame.hpp"
#include "sweep/workers/worker_state.hpp"

#include <fmt/format.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <future>
#include <map>
#include <mutex>
#include <system_error>
#include <thread>

namespace grainsweep::workers {
namespace {

using namespace std::chrono_literals;
using frames::WorkerNumber;

constexpr int no_main_program = 3;
constexpr std::size_t most_unwritten = std::size_t{1} << 20U;  // before workers are no longer read from
constexpr auto look_at_ends_every = 50ms;
constexpr auto grace_of_orphans = 2s;

/// The process groups of the workers that run, for the thread that passes signals on.
class ProcessGroups {
public:
    void add(int group) {
        const std::lock_guard lock(mutex_);
        groups_.push_back(group);
    }
    void remove(int group) {
        const std::lock_guard lock(mutex_);
        std::erase(groups_, group);
    }
    void signal(int number) {
        const std::lock_guard lock(mutex_);
        for (const int group : groups_) ::kill(-group, number);
    }

private:
    std::mutex mutex_;
    std::vector<int> groups_;
};

/// The loop is the main thread's, and all workers are its children. Reading standard input, signals and the lease have
/// threads of their own: writing to a main program that does not read may take for ever.
class Relay {
public:
    explicit Relay(const HostOptions& options) : options_(options) {}

    int run() {
        hold_asking_signals();
        std::signal(SIGPIPE, SIG_IGN);
        frames::add_hello(outgoing_);
        flush();
        std::thread([this] { read(); }).detach();
        std::thread([this] { attend([this](int signal) { pass_on(signal); }, [this] { tick(); }); }).detach();
        while (!gone_ && !(asked_ && workers_.empty())) {
            loop_.run_one_for(look_at_ends_every);
            while (!gone_ && outgoing_.size() < most_unwritten && loop_.poll_one()) {
            }
            look_at_ends();
            if (beat_.exchange(false)) outgoing_ += frames::alive_frame;
            flush();
        }
        end_workers();
        return code_;
    }

private:
    // ---- threads beside the loop -----------------------------------------------------------------------------

    /// A piece is processed before the next is read, so that the unprocessed data are limited.
    void read() {
        std::array<char, 65536> piece{};
        while (true) {
            const auto length = ::read(STDIN_FILENO, piece.data(), piece.size());
            if (length < 0 && errno == EINTR) continue;
            silence_ = 0;
            std::promise<void> taken;
            loop_.post([&] {
                if (length <= 0) {
                    gone_ = true;
                } else {
                    take({piece.data(), static_cast<std::size_t>(length)});
                }
                taken.set_value();
            });
            taken.get_future().wait();
            if (length <= 0) return;
        }
    }

    void tick() {
        beat_ = true;
        // Its workers had no word either, and end by themselves; a write that hangs must not keep this process.
        if (++silence_ <= options_.lease_seconds) return;
        groups_.signal(SIGKILL);
        std::_Exit(no_main_program);
    }

    void pass_on(int signal) {
        asked_ = signal;
        groups_.signal(signal);
    }

    // ---- the main program's frames ---------------------------------------------------------------------------

    void take(std::string_view piece) {
        if (gone_) return;
        const bool sound = reader_.feed(piece, [this](const frames::Frame& frame) {
            if (!gone_) obey(frame);
        });
        if (sound || gone_) return;
        const auto sentence =
            fmt::format("grainsweep host: standard input is not the main program's: {}\n", shortened(piece, 200));
        (void)std::fwrite(sentence.data(), 1, sentence.size(), stderr);
        code_ = no_frames;
        gone_ = true;
    }

    void obey(const frames::Frame& frame) {
        const auto child = [&](WorkerNumber number) {
            const auto found = workers_.find(number);
            return found == workers_.end() ? nullptr : found->second;
        };
        if (const auto* piece = std::get_if<frames::Piece>(&frame)) {
            if (const auto to = child(piece->worker)) to->write(std::string(piece->bytes));
        } else if (const auto* start = std::get_if<frames::Start>(&frame)) {
            start_worker(start->worker);
        } else if (const auto* signal = std::get_if<frames::Signal>(&frame)) {
            if (const auto to = child(signal->worker)) to->signal(signal->number);
        } else if (const auto* close = std::get_if<frames::Close>(&frame)) {
            if (const auto to = child(close->worker)) {
                to->close();
                closed_.push_back(close->worker);
            }
        }
    }

    void start_worker(WorkerNumber number) {
        if (asked_) return frames::add_ended(outgoing_, number, asked_, "its host was asked to end");
        std::error_code error;
        const auto child = Child::start(loop_, options_.command, error);
        if (child == nullptr)
            return frames::add_ended(outgoing_, number, 127 << 8, "it cannot be started: " + error.message());
        workers_.emplace(number, child);
        groups_.add(child->process_group());
        child->listen({[this, number](std::string_view piece) { frames::add_piece(outgoing_, number, piece); },
                       [this, number] {
                           const auto ended = workers_.at(number);
                           ended->signal(SIGKILL);  // whatever is left of its process group
                           ended->wait(grace_of_orphans);
                           tell_end(number);
                       }});
    }

    // ---- ends ------------------------------------------------------------------------------------------------

    void tell_end(WorkerNumber number) {
        const auto found = workers_.find(number);
        const auto child = found->second;
        workers_.erase(found);
        groups_.remove(child->process_group());
        frames::add_ended(outgoing_, number, child->status(), child->log());
        child->close();
    }

    /// Of workers whose pipes are closed the end is not read.
    void look_at_ends() {
        std::erase_if(closed_, [this](WorkerNumber number) {
            const auto found = workers_.find(number);
            if (found == workers_.end()) return true;
            if (found->second->runs()) return false;
            tell_end(number);
            return true;
        });
    }

    /// Ends the remaining workers: first by closing their standard input, then by SIGKILL.
    void end_workers() {
        for (const auto& [number, child] : workers_) child->close();
        wait_while([this] { return std::ranges::any_of(workers_, [](auto& one) { return one.second->runs(); }); },
                   grace_of_orphans);
        for (const auto& [number, child] : workers_) child->signal(SIGKILL);
        wait_while([this] { return std::ranges::any_of(workers_, [](auto& one) { return one.second->runs(); }); },
                   grace_of_orphans);
    }

    // ---- writing ---------------------------------------------------------------------------------------------

    /// Blocks while the main program does not read: workers are then not read from either.
    void flush() {
        if (!files::write_all(STDOUT_FILENO, outgoing_)) {
            gone_ = true;
            code_ = no_main_program;
        }
        outgoing_.clear();
    }

    const HostOptions& options_;
    EventLoop loop_;
    frames::Reader reader_{frames::Reader::Side::host};
    std::map<WorkerNumber, std::shared_ptr<Child>> workers_;
    std::vector<WorkerNumber> closed_;
    ProcessGroups groups_;
    std::string outgoing_;
    std::atomic<int> asked_ = 0;      ///< the signal by which it was asked to end
    std::atomic<int> silence_ = 0;    ///< seconds since the main program wrote
    std::atomic<bool> beat_ = false;  ///< a sign of life is due
    bool gone_ = false;               ///< the main program
    int code_ = 0;
};

}  // namespace

int host(const HostOptions& options) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);        // a local main program; a remote one is noticed by end of file and lease
    static Relay* relay = new Relay(options);  // outlives main: its threads are never joined
    const int code = relay->run();
    std::fflush(stderr);
    std::_Exit(code);
}

}  // namespace grainsweep::workers
