// Counter of workers that end before they begin a case. Several in a row mean that the launcher fails, not the case.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace grainsweep::workers {

class FruitlessLaunches {
public:
    explicit FruitlessLaunches(const std::vector<std::string>& argv);

    /// Resets the counter: a worker began its first case.
    void fruitful();
    /// Counts a worker that ended before it began a case. A killed worker counts less. If other workers run, the next
    /// launch is delayed, longer each time; returns a message about it, once. If there are no others, no worker can be
    /// started and why() gives the reason.
    [[nodiscard]] std::optional<std::string> ended(const std::string& reason, bool killed, std::size_t others,
                                                   double now);
    /// Counts a worker that could not be launched at all. An immediate retry would fail in the same way.
    [[nodiscard]] std::optional<std::string> not_launched(const std::string& reason, std::size_t others, double now);
    /// Stops all launches.
    void give_up(const std::string& reason);
    [[nodiscard]] bool waits(double now) const { return now < not_before_; }
    /// Returns the reason why no worker can be started; empty: workers can be started.
    [[nodiscard]] const std::string& why() const { return why_; }
    [[nodiscard]] const std::string& command() const { return command_; }

private:
    std::string command_, why_;
    int in_a_row_ = 0;
    double not_before_ = 0, pause_;
};

}  // namespace grainsweep::workers
