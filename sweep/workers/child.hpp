// Processes of this machine and their three pipes: started, written to, read from, signalled, waited for; and the loop
// in which that happens. Nothing here knows what is written or why a process ends; the pool does.
#pragma once

#include "sweep/workers/process.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

namespace grainsweep::workers {

/// Calls what is due in the thread that runs it.
class EventLoop {
public:
    EventLoop();
    EventLoop(const EventLoop&) = delete;
    EventLoop& operator=(const EventLoop&) = delete;
    ~EventLoop();

    /// Waits until something is due, or for so long, and calls it.
    void run_one_for(std::chrono::milliseconds at_most);
    /// Calls what is due, one thing; false: nothing is.
    bool poll_one();
    /// To be called soon. From any thread.
    void post(std::function<void()> call);
    /// From now on these signals do nothing but this.
    void on_signals(const std::vector<int>& numbers, std::function<void(int number)> call);

    struct Impl;
    [[nodiscard]] Impl& impl() { return *impl_; }

private:
    std::unique_ptr<Impl> impl_;
};

class Child : public Process {
public:
    /// nullptr, and why in `error`, where there is no program of that name, or no descriptor, memory or process to be
    /// had. Does not wait until the program is loaded: one that cannot be executed ends at once and says so in its log.
    /// The process is the head of a group of its own: the terminal's Ctrl-C does not reach it.
    [[nodiscard]] static std::shared_ptr<Child> start(EventLoop& loop, const std::vector<std::string>& argv,
                                                      std::error_code& error);
    [[nodiscard]] virtual int process_group() const = 0;
};

/// Calls until `condition` no longer holds, or for so long, with growing pauses.
void wait_while(const std::function<bool()>& condition, std::chrono::milliseconds at_most);

}  // namespace grainsweep::workers
