// Rounds of a campaign beside an open page: it is stopped, killed, resumed, looked at by other programs and vacuumed,
// and the page shows what is stored.
#pragma once

#include "tests/support/process.hpp"

#include <chrono>
#include <filesystem>
#include <string>

namespace grainsweep::tests {

struct ServedRounds {
    int done = 0;    ///< rounds
    int prompt = 0;  ///< of these, after which the page had what was stored within 2 s
    int stops = 0, kills = 0, vacuums = 0;
    std::int64_t settled = 0;  ///< cases stored at the end
    double slowest = 0;        ///< s, until the page had what was stored
    std::string complaint;     ///< of what did not hold; empty: all held
};

/// Runs the campaign a.json into a.db of the folder, at most so many rounds or so long.
[[nodiscard]] ServedRounds served_rounds(const Folder& folder, int most, std::chrono::seconds at_most);

}  // namespace grainsweep::tests
