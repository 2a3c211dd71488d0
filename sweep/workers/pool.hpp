// Worker processes of this same executable, kept for the whole campaign: when one is started, given up and replaced.
// How a process is started, read and ended is child.hpp's, what a worker may write when worker_state.hpp's.
#pragma once

#include "sweep/workers/crew.hpp"
#include "sweep/workers/worker_state.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::workers {

struct PoolOptions {
    std::vector<std::string> launcher;  ///< argv prefix; empty: the workers are children of this process
    std::vector<std::string> command;   ///< executable, "worker", its arguments
    std::size_t workers = 1;
    /// Where given, the launcher starts so many hosts instead, and each runs an equal part of the workers. `{host}` in
    /// a word of the launcher is the host's number, from 1 on.
    std::optional<std::int64_t> hosts;
    std::vector<std::string> host_command;  ///< executable, "host", its arguments
    /// Threads of every case; none: one, and the cores of a node that no case needs go to those that run there. A node
    /// has as many cores for the campaign as workers.
    std::optional<std::int64_t> threads = 1;
    TimeLimits limits;  ///< in this process's running time
    Expected expected;
};

class Pool final : public Crew {
public:
    /// Launches lazily: as many workers as cases wait, again after one was lost, and after a pause where several could
    /// not be started in a row while others work. expect() and wait() throw std::runtime_error where no worker can be
    /// had at all.
    explicit Pool(PoolOptions options);
    ~Pool() override;

    void expect(std::size_t cases) override;
    void share_cores(std::size_t waiting, const SecondsLeft& left) override;
    [[nodiscard]] std::optional<Place> place_for(double predicted_seconds) override;
    void give(const Place& place, const campaign::Attempt& attempt, const campaign::Case& question) override;
    [[nodiscard]] std::optional<PoolEvent> wait(std::chrono::milliseconds at_most) override;
    void retire() override;
    void dismiss() override;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainsweep::workers
