// Summary of a run on standard output, its last line and its exit code.
#pragma once

#include "sweep/cli/run_campaign.hpp"
#include "sweep/report/table.hpp"
#include "sweep/schedule/judge.hpp"
#include "sweep/schedule/plan.hpp"
#include "sweep/schedule/scheduler.hpp"

#include <string>

namespace grainsweep::cli {

// Exit codes.
inline constexpr int interrupted_code = 130;  ///< after Ctrl-C
inline constexpr int ended_code = 75;         ///< out of time, or after another signal
/// Returns whether a command of several runs ends with this one.
[[nodiscard]] constexpr bool is_end_of_all(int exit_code) {
    return exit_code == interrupted_code || exit_code == ended_code;
}

/// Returns the part of the last line on convergence; empty without a rule.
[[nodiscard]] std::string standing(const schedule::Judge* judge);
/// Returns the last sentence of a run.
[[nodiscard]] std::string summary_of(schedule::Ending ending, const schedule::Plan::Tally& tally,
                                     const schedule::Judge* judge);
/// Returns 0: every case is settled, or the campaign converged; 1: some are not; 75: out of time; 130: interrupted.
[[nodiscard]] int exit_code(schedule::Ending ending, const schedule::Plan::Tally& tally);

/// Prints the data of a finished run that a calling program needs; the results are in the database. `all`: the text has
/// every observable and moment.
void show_run(const RunReport& run, report::Format format, bool all);

}  // namespace grainsweep::cli
