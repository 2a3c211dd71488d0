// Messages between a worker and its main program. Cases come in; heartbeats, answers and returned cases go out.
// Reading, signals and the clock have threads of their own, so that they are served while a case is computed.
#pragma once

#include "sweep/workers/message.hpp"

#include <atomic>
#include <condition_variable>
#include <ctime>
#include <deque>
#include <mutex>
#include <optional>
#include <string>

namespace grainsweep::workers {

/// Reason why a worker must end.
enum class Ending {
    none,
    asked,    ///< the main program wrote stop
    signal,   ///< a signal that requests the end of a process
    silence,  ///< no message from the main program for too long
};

/// Desk of the thread that computes, which makes it. It blocks the signals that it waits for, so make it before any
/// other thread starts.
class Desk {
public:
    struct Limits {
        double lease_seconds = 600;
        double give_back_seconds = 20;
    };
    explicit Desk(const Limits& limits);
    Desk(const Desk&) = delete;
    Desk& operator=(const Desk&) = delete;

    /// Sends that the worker is ready, and starts to read.
    void open(const campaign::Computer& computer);
    /// Returns the next case; empty once the worker must end.
    [[nodiscard]] std::optional<Run> next();
    void begin(const campaign::Attempt& attempt, bool resumed);
    /// Stores the progress of the running case, for the heartbeats.
    void advanced(double progress);
    [[nodiscard]] Ending ending() const { return ending_; }
    /// Sends the answer of the running case.
    void answer(Done done);
    void give_back();
    /// Gives back all cases because a file could not be written, and ends the process.
    [[noreturn]] void break_off(std::string reason);
    /// Gives back the cases that were never begun, and ends the process.
    [[noreturn]] void close();

private:
    void read();
    void take(std::string_view line);
    void tick();
    void end(Ending why, std::string reason);
    [[noreturn]] void leave();  // with mutex_ held
    void write(const ToBoss& message);
    void flush();
    [[nodiscard]] bool makes_headway();

    Limits limits_;
    clockid_t computing_{};  ///< processor time of the thread that computes
    std::mutex mutex_;       ///< guards all members below except the atomics
    std::condition_variable changed_;
    std::deque<Run> questions_;
    std::optional<campaign::Attempt> running_;
    std::string outgoing_;
    std::string reason_;  ///< of the ending
    std::atomic<Ending> ending_ = Ending::none;
    std::atomic<double> progress_;
    std::atomic<unsigned> looks_ = 0;  ///< calls of advanced()
    std::atomic<int> silence_ = 0;     ///< seconds since the main program wrote
    unsigned looks_seen_ = 0;          // of the thread that ticks
    timespec computed_seen_{};
    int ending_for_ = 0;  // seconds
};

}  // namespace grainsweep::workers
