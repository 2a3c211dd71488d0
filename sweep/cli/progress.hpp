// Progress of a run: on standard error, a bar with rate and time left on a terminal and plain lines elsewhere; and in a
// file, for other commands.
#pragma once

#include "sweep/live/now.hpp"
#include "sweep/schedule/scheduler.hpp"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

namespace grainsweep::cli {

class ProgressLine {
public:
    /// quiet: only notes. The predicted time left is divided by `cores`. `end`: the part of the run to which this time
    /// refers, such as "in this wave"; empty: the run.
    ProgressLine(bool quiet, std::size_t cores, std::string end = {});
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    void update(const schedule::Progress& progress);
    /// Prints a line above the bar. Of notes that differ in words with digits only, such as one remark on many cases,
    /// the first two are printed, of all notes the first few; the others are counted, and `explain` shows all.
    void note(const std::string& text);

private:
    using Clock = std::chrono::steady_clock;
    [[nodiscard]] std::string describe(const schedule::Progress& progress) const;
    /// Returns the text fitted to the terminal, with a bar if there is room, and with colours.
    [[nodiscard]] std::string on_terminal(const std::string& text, const schedule::Plan::Tally& tally) const;
    void erase();

    bool quiet_, terminal_, coloured_;
    std::size_t cores_;
    std::string end_;
    Clock::time_point shown_{};
    bool line_open_ = false;
    std::map<std::string, std::size_t> notes_;  ///< by their words without digits
    std::size_t shown_notes_ = 0, unshown_notes_ = 0;
    std::string last_;
};

/// Returns the seconds until the end of the run: the predicted cost of the remaining cases, scaled by the measured
/// speed so far. Before 2 % of the whole are done, the prediction for this number of cores.
[[nodiscard]] double seconds_left(const schedule::Progress& progress, std::size_t cores);

/// Returns a duration as text: 75 -> "1 min 15 s".
[[nodiscard]] std::string duration(double seconds);

/// Writer of the file with the present state of a run (live/now.hpp), once a second.
class NowWriter {
public:
    NowWriter(const std::filesystem::path& database, std::string campaign, std::size_t cores);
    NowWriter(const NowWriter&) = delete;
    NowWriter& operator=(const NowWriter&) = delete;
    /// Removes the file.
    ~NowWriter();

    void update(const schedule::Progress& progress);

private:
    using Clock = std::chrono::steady_clock;

    std::filesystem::path file_;
    live::Now now_;
    std::size_t cores_;
    Clock::time_point written_{};
};

}  // namespace grainsweep::cli
