// Writer of the file with the present state of a run (live/now.hpp), once a second.
#pragma once

#include "sweep/live/now.hpp"
#include "sweep/schedule/scheduler.hpp"

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>

namespace grainsweep::cli {

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
