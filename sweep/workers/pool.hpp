// Pool of worker processes of this executable, which live for the whole campaign. It decides when a worker is started,
// given up and replaced. child.hpp starts, reads and ends the processes; worker_state.hpp has the protocol.
#pragma once

#include "sweep/workers/worker_pool.hpp"
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
    /// Number of hosts. If given, the launcher starts hosts instead of workers, and each host runs an equal part of the
    /// workers. `{host}` in the launcher's command is replaced by the number of the host, from 1.
    std::optional<std::int64_t> hosts;
    std::vector<std::string> host_command;  ///< executable, "host", its arguments
    /// Threads of every case. Empty: one, and idle cores of a node go to the cases that run there. The campaign may use
    /// as many cores of a node as it has workers there.
    std::optional<std::int64_t> threads = 1;
    TimeLimits limits;  ///< in this process's running time
    Expected expected;
};

class Pool final : public WorkerPool {
public:
    /// Starts workers only as cases need them, and replaces lost ones. If several launches in a row fail while other
    /// workers run, the next launch is delayed. expect() and wait() throw std::runtime_error if no worker can be
    /// started.
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
