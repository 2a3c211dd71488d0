// Interface of a worker process: write, read, signal, wait. It is a child of this process (child.hpp), or a worker on a
// host that passes its messages on (hosts.cpp).
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace grainsweep::workers {

class Process {
public:
    /// Listener to a process. `read` receives the standard output in pieces; `ended` is called once, at its end of
    /// file. Neither is called after close().
    struct Listener {
        std::function<void(std::string_view piece)> read;
        std::function<void()> ended;
    };

    Process() = default;
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    virtual ~Process() = default;

    virtual void listen(Listener listener) = 0;
    /// Writes a line as soon as the pipe accepts it.
    virtual void write(std::string line) = 0;
    [[nodiscard]] virtual bool everything_is_written() const = 0;
    /// Stops waiting for the process and its output.
    virtual void close() = 0;

    virtual void signal(int number) = 0;  ///< sends a signal to its process group
    [[nodiscard]] virtual bool runs() = 0;
    /// Waits until the process has ended, for at most this time.
    virtual void wait(std::chrono::milliseconds at_most) = 0;
    /// Returns its status as of waitpid(2), once it has ended.
    [[nodiscard]] virtual int status() const = 0;
    /// Returns how it ended, as a text, once it has.
    [[nodiscard]] virtual std::string end() const = 0;
    /// Returns whether the process ended because its host was lost; its case is not the cause.
    [[nodiscard]] virtual bool lost_with_host() const { return false; }
    /// Reports that the process began a case, so its launcher works.
    virtual void was_fruitful() {}
    /// Returns the number of its node. Processes of one node share cores. 0: the node of this process.
    [[nodiscard]] virtual std::size_t node() const { return 0; }
    /// Returns its identifier.
    [[nodiscard]] virtual std::string id() const = 0;
    /// Returns the end of its standard error, as far as received.
    [[nodiscard]] virtual const std::string& log() = 0;
};

}  // namespace grainsweep::workers
