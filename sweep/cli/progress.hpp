// Progress on standard error: a bar with rate and time left on a terminal, plain lines elsewhere.
#pragma once

#include "sweep/schedule/scheduler.hpp"

#include <chrono>
#include <string>

namespace grainsweep::cli {

class ProgressLine {
public:
    /// quiet: notes only. `cores` divide the predicted time left. `end`: what that time ends, where it is not the run:
    /// "in this wave".
    ProgressLine(bool quiet, std::size_t cores, std::string end = {});
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void update(const schedule::Progress& progress);
    /// One line above the bar. The first few are shown, the rest is counted: `explain` knows them all.
    void note(const std::string& text);

private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] std::string describe(const schedule::Progress& progress) const;
    /// Fits the text to the terminal, with a bar where there is room, and colours it.
    [[nodiscard]] std::string on_terminal(const std::string& text, const schedule::Plan::Tally& tally) const;
    void erase();

    bool quiet_, terminal_, coloured_;
    std::size_t cores_;
    std::string end_;
    Clock::time_point shown_{};
    bool line_open_ = false;
    std::size_t notes_ = 0;
    std::string last_;
};

/// Seconds until the run ends: predicted cost of what it will still compute, at the pace of what it has done so far;
/// until that is 2 % of the whole, as predicted on so many cores.
[[nodiscard]] double seconds_left(const schedule::Progress& progress, std::size_t cores);

/// 75 -> "1 min 15 s".
[[nodiscard]] std::string duration(double seconds);

}  // namespace grainsweep::cli
