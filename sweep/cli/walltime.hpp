// How long this process may take: what the campaign file says, or the end of the Slurm job it runs in.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/scheduler.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::cli {

/// Seconds, from the start of the process.
struct TimeGiven {
    double left = 0;   ///< now
    double whole = 0;  ///< to a run of full length
};

/// The earlier of the two; nothing where there is no limit. `configured`: execution.walltime. The texts are
/// SLURM_JOB_END_TIME and SLURM_JOB_START_TIME, seconds since 1970 or a local date (2026-11-26T12:00:00); empty: not
/// set. Another text, and a moment more than a year ago, is none.
[[nodiscard]] std::optional<TimeGiven> time_given(std::optional<double> configured, std::string_view job_end,
                                                  std::string_view job_start, double now);
/// The warning where the end of the job is set and is none; empty: it is one, or Slurm names none.
[[nodiscard]] std::string unreadable_end(std::string_view job_end, double now);
/// Of this it keeps back for workers to save what they have and for everything to be written: a tenth, 5 to 30 s, at
/// most half.
[[nodiscard]] double kept_back(double whole);
/// Counts from now.
[[nodiscard]] schedule::Walltime walltime_of(const campaign::Campaign& campaign);

}  // namespace grainsweep::cli
