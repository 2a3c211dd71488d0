#include "sweep/workers/fruitless_launches.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grainsweep::workers {

namespace {

constexpr int most_in_a_row = 3, most_killed_in_a_row = 10;
constexpr double shortest_pause = 1, longest_pause = 60;  // s, between attempts to start a worker where it fails

std::string joined(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

}  // namespace

FruitlessLaunches::FruitlessLaunches(const std::vector<std::string>& argv)
    : command_(joined(argv)), pause_(shortest_pause) {}

void FruitlessLaunches::fruitful() {
    in_a_row_ = 0;
    pause_ = shortest_pause;
}

std::optional<std::string> FruitlessLaunches::ended(const std::string& reason, bool killed, std::size_t others,
                                                    double now) {
    if (++in_a_row_ < (killed ? most_killed_in_a_row : most_in_a_row)) return std::nullopt;
    if (others == 0) {
        give_up(reason);
        return std::nullopt;
    }
    not_before_ = now + pause_;
    const bool first = pause_ == shortest_pause;
    pause_ = std::min(2 * pause_, longest_pause);
    if (!first) return std::nullopt;
    return fmt::format("cannot start another worker with '{}': {}; going on with {}, and trying again now and then",
                       command_, reason, others);
}

void FruitlessLaunches::give_up(const std::string& reason) {
    why_ = fmt::format("cannot start workers with '{}': {}", command_, reason);
}

std::optional<std::string> FruitlessLaunches::not_launched(const std::string& reason, std::size_t others, double now) {
    in_a_row_ = most_in_a_row;
    return ended(reason, false, others, now);
}

}  // namespace grainsweep::workers
