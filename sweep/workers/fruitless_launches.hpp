// Workers that end before they begin a case: after several in a row the launcher is wrong, not the case.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace grainsweep::workers {

class FruitlessLaunches {
public:
    explicit FruitlessLaunches(const std::vector<std::string>& argv);

    /// A worker began its first case.
    void fruitful();
    /// A worker ended before it began a case. One that was killed says less about the launcher. Where others work on,
    /// the next launch waits for a while, longer each time; returns what is to be said about it, once. Without others
    /// no worker can be had: why().
    [[nodiscard]] std::optional<std::string> ended(const std::string& reason, bool killed, std::size_t others,
                                                   double now);
    /// The same of one that could not even be launched: another try at once would end alike.
    [[nodiscard]] std::optional<std::string> not_launched(const std::string& reason, std::size_t others, double now);
    /// No other launch can do better.
    void give_up(const std::string& reason);
    [[nodiscard]] bool waits(double now) const { return now < not_before_; }
    /// Why no worker can be had at all; empty: one can.
    [[nodiscard]] const std::string& why() const { return why_; }
    [[nodiscard]] const std::string& command() const { return command_; }

private:
    std::string command_, why_;
    int in_a_row_ = 0;
    double not_before_ = 0, pause_;
};

}  // namespace grainsweep::workers
