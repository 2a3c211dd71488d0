// A worker's dealings with its main program: questions come in, signs of life, answers and what is given back go out.
// Reading, signals and the clock have threads of their own, so that they are attended to in the middle of a case.
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

/// Why a worker is to end.
enum class Ending {
    none,
    asked,    ///< the main program wrote stop
    signal,   ///< a signal that asks a process to end
    silence,  ///< no message from the main program for too long
};

/// Belongs to the thread that computes, which makes it. Blocks the signals it waits for: make it before any thread.
class Desk {
public:
    struct Limits {
        double lease_seconds = 600;
        double give_back_seconds = 20;
    };
    explicit Desk(const Limits& limits);
    Desk(const Desk&) = delete;
    Desk& operator=(const Desk&) = delete;

    /// Says that the worker is ready, and starts to listen.
    void open(const campaign::Computer& computer);
    /// The next question; nothing once the worker is to end.
    [[nodiscard]] std::optional<Run> next();
    void begin(const campaign::Attempt& attempt, bool resumed);
    /// The case under way makes headway.
    void advanced(double progress);
    [[nodiscard]] Ending ending() const { return ending_; }
    /// Ends the case under way.
    void answer(Done done);
    void give_back();
    /// Gives back everything, for the reason that a file could not be written, and ends the process.
    [[noreturn]] void break_off(std::string reason);
    /// Gives back what was never begun and ends the process.
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
    std::mutex mutex_;       ///< of all that follows but the atomics
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
