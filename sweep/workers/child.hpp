// Child processes on this machine with their three pipes, and the event loop that serves them: start, write, read,
// signal, wait. The pool interprets the messages and the ends of the processes.
#pragma once

#include "sweep/workers/process.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace grainsweep::workers {

/// Event loop that calls its handlers in the thread that runs it.
class EventLoop {
public:
    EventLoop();
    EventLoop(const EventLoop&) = delete;
    EventLoop& operator=(const EventLoop&) = delete;
    ~EventLoop();

    /// Waits for an event, for at most this time, and calls its handler.
    void run_one_for(std::chrono::milliseconds at_most);
    /// Calls the handler of one event that is due. Returns false if none is due.
    bool poll_one();
    /// Appends a call to the loop. Any thread may do so.
    void post(std::function<void()> call);
    /// Calls this whenever the descriptor is readable. The descriptor must outlive the loop.
    void on_readable(int descriptor, std::function<void()> call);

    struct Impl;
    [[nodiscard]] Impl& impl() { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

class Child : public Process {
public:
    /// Starts a process. Returns nullptr and sets `error` if no program has that name, or if the system has no
    /// descriptor, memory or process left. Does not wait until the program is loaded: a program that cannot be executed
    /// ends at once and writes the reason to its log. The process leads a process group of its own, so the terminal's
    /// Ctrl-C does not reach it.
    [[nodiscard]] static std::shared_ptr<Child> start(EventLoop& loop, const std::vector<std::string>& argv,
                                                      std::error_code& error);
    [[nodiscard]] virtual int process_group() const = 0;
};

/// Evaluates `condition` with growing pauses until it is false, or for at most this time.
void wait_while(const std::function<bool()>& condition, std::chrono::milliseconds at_most);

}  // namespace grainsweep::workers
