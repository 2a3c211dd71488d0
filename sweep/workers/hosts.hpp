// Hosts of a pool: decides when a host is launched, given up and replaced, and which host starts a worker.
#pragma once

#include "sweep/workers/child.hpp"
#include "sweep/workers/departures.hpp"
#include "sweep/workers/fruitless_launches.hpp"
#include "sweep/workers/worker_state.hpp"

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace grainsweep::workers {

struct HostPlan {
    std::vector<std::string> argv;  ///< launcher, executable, "host", its arguments; {host}: its number, from 1 on
    std::size_t hosts = 0;
    std::size_t workers_each = 1;
    TimeLimits limits;
};

class RemoteHost;

class Hosts {
public:
    struct Listener {
        std::function<double()> clock;
        std::function<void(const std::string& line)> greeting;
        std::function<void(std::string remark)> say;
    };

    Hosts(EventLoop& loop, HostPlan plan, Listener listener);

    /// Starts a worker on the host with the fewest workers, or on a new host if more are allowed. Returns nullptr if
    /// there is none now.
    [[nodiscard]] std::shared_ptr<Process> start_worker();
    void lease();
    /// Gives up hosts that are not ready in time or are silent for too long.
    void keep_time();
    /// Stops replacing hosts: a host that ends from now on needs no replacement and no message.
    void retire() { retired_ = true; }
    /// Waits a moment for these workers, then ends all hosts. The hosts end their remaining workers.
    void end_all(std::vector<std::shared_ptr<Process>> workers);
    /// Returns the reason why no host can be started; empty: hosts can be started.
    [[nodiscard]] const std::string& why() const { return fruitless_.why(); }

private:
    [[nodiscard]] bool launch();
    void gone(const std::shared_ptr<RemoteHost>& host, const std::string& reason);
    [[nodiscard]] std::size_t free_number() const;

    EventLoop& loop_;
    HostPlan plan_;
    Listener listener_;
    std::vector<std::shared_ptr<RemoteHost>> hosts_;
    FruitlessLaunches fruitless_;
    int unsound_ = 0;  ///< hosts lost because of a damaged frame
    Departures leaving_;
    bool retired_ = false;
};

}  // namespace grainsweep::workers
