// Time limit of this process, from the campaign file or the end of its Slurm job.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/scheduler.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::cli {

/// Available time, in seconds from the start of the process.
struct TimeGiven {
    double left = 0;   ///< now
    double whole = 0;  ///< for a run of full length
};

/// Returns the time until the earlier of the two limits; empty if there is none. `configured`: execution.walltime. The
/// texts are SLURM_JOB_END_TIME and SLURM_JOB_START_TIME, in seconds since 1970 or as a local date
/// (2026-11-26T12:00:00); empty: not set. Other texts, and moments more than a year ago, are ignored.
[[nodiscard]] std::optional<TimeGiven> time_given(std::optional<double> configured, std::string_view job_end,
                                                  std::string_view job_start, double now);
/// Returns a warning if the end of the job is set but invalid; empty otherwise.
[[nodiscard]] std::string unreadable_end(std::string_view job_end, double now);
/// Returns the part of the time reserved for checkpoints of workers and writing of results: a tenth, 5 to 30 s, at most
/// half.
[[nodiscard]] double kept_back(double whole);
/// Returns the limit, counted from now.
[[nodiscard]] schedule::Walltime walltime_of(const campaign::Campaign& campaign);

}  // namespace grainsweep::cli
