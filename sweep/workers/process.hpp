// A process that computes, as the pool sees it: written to, read from, signalled, waited for. A child of this process
// (child.hpp), or a worker on a host that passes its messages on (remote_host.hpp).
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

namespace grainsweep::workers {

class Process {
public:
    /// `read` gets what comes through standard output, piece by piece; `ended` is called once, at its end of file.
    /// Neither is called after close().
    struct Listener {
        std::function<void(std::string_view piece)> read;
        std::function<void()> ended;
    };

    Process() = default;
    Process(const Process&) = delete;
    Process& operator=(const Process&) = delete;
    virtual ~Process() = default;

    virtual void listen(Listener listener) = 0;
    /// Written as soon as the pipe takes it.
    virtual void write(std::string line) = 0;
    [[nodiscard]] virtual bool everything_is_written() const = 0;
    /// Its end is no longer waited for, nor anything it writes.
    virtual void close() = 0;

    virtual void signal(int number) = 0;  ///< to all of its process group
    [[nodiscard]] virtual bool runs() = 0;
    /// Waits until it has ended, or for so long.
    virtual void wait(std::chrono::milliseconds at_most) = 0;
    /// As of waitpid(2), once it has ended.
    [[nodiscard]] virtual int status() const = 0;
    /// How it ended, in words, once it has.
    [[nodiscard]] virtual std::string end() const = 0;
    /// Whether the host that ran it is gone, and it with it: no matter of what it computed.
    [[nodiscard]] virtual bool lost_with_host() const { return false; }
    /// It began a case: what started it works.
    virtual void was_fruitful() {}
    /// Processes of one node have cores in common; 0: the node of this one.
    [[nodiscard]] virtual std::size_t node() const { return 0; }
    /// Tells it from others.
    [[nodiscard]] virtual std::string id() const = 0;
    /// The last it wrote to standard error, as far as known.
    [[nodiscard]] virtual const std::string& log() = 0;
};

}  // namespace grainsweep::workers
