// The hosts of a pool: when one is launched, given up and replaced, and on which a worker is started.
#pragma once

#include "sweep/workers/departures.hpp"
#include "sweep/workers/fruitless_launches.hpp"
#include "sweep/workers/remote_host.hpp"
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

class Hosts {
public:
    struct Listener {
        std::function<double()> clock;
        std::function<void(const std::string& line)> greeting;
        std::function<void(std::string remark)> say;
    };

    Hosts(EventLoop& loop, HostPlan plan, Listener listener);

    /// On the host with the fewest, a new one where there may be more; nullptr: none can be had now.
    [[nodiscard]] std::shared_ptr<Process> start_worker();
    void lease();
    /// Gives up hosts that are not ready or not heard of in time.
    void keep_time();
    /// Asks for no more workers: a host that ends now needs no replacement and no remark.
    void retire() { retired_ = true; }
    /// Waits for these workers a moment, then ends all hosts; they end what is left of their workers.
    void end_all(std::vector<std::shared_ptr<Process>> workers);
    /// Why no host can be had at all; empty: one can.
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
    int unsound_ = 0;  ///< hosts lost because a frame was not as it was written
    Departures leaving_;
    bool retired_ = false;
};

}  // namespace grainsweep::workers
