// `run`: computes a campaign file into a database, with all parts connected.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

struct RunRequest {
    std::filesystem::path config;
    std::string text;                     ///< replaces the contents of `config`; empty: the contents
    std::string experiment;               ///< experiment of a calibration with several; empty: the file has one
                                          ///< campaign
    bool goes_on = false;                 ///< the warnings have already been printed
    std::filesystem::path database;       ///< empty: NAME.db in the current folder
    std::filesystem::path artefacts;      ///< folder of checkpoints and shared starting states; empty: beside the
                                          ///< database
    std::optional<std::int64_t> workers;  ///< overrides the campaign file
    std::optional<std::int64_t> stop_after_failures;  ///< start no case after so many failed cases
    bool keep_going = false;                          ///< go on although the first cases all fail for one reason
    std::optional<campaign::Outcome> again;           ///< rerun cases with this outcome
    std::optional<std::int64_t> max_cases;            ///< settle at most so many cases
    std::optional<std::int64_t> points;               ///< points of the design, instead of the number in the file
    std::string adopt;  ///< campaign of an earlier version of the program whose answers are taken over; empty: none
    std::string adopt_where;  ///< SQL condition over the inputs of the cases that are taken over; empty: all
    /// Folder shared by the tasks of `work`. If not empty, no case is computed: the folder defines the campaign, and
    /// its answers are imported into the database.
    std::filesystem::path spool;
    bool network_disk = false;  ///< the database may lie on a network file system
    bool quiet = false;
    bool all = false;         ///< the summary shows every observable and moment
    bool calibrates = false;  ///< the campaign file must give a calibration
    bool powder = false;      ///< for a calibration: its powder is written beside the database
    std::string path;         ///< instruction path of the workers; empty: the widest of each
};

/// Result of a run, after the database is closed.
struct RunReport {
    int exit_code = 0;
    std::string campaign;
    std::filesystem::path database;
    std::string ending;             ///< one sentence; with a convergence rule it says whether the campaign has
                                    ///< converged
    std::optional<bool> converged;  ///< by the campaign's rule; empty: no rule
    bool finished = false;          ///< no case is left, and no signal asked for the end
    std::int64_t settled = 0;       ///< cases settled in this run
    std::int64_t points = 0;        ///< points of the design, as far as answers determine them
};

/// Points of each sequence in the pilot of a campaign with an error goal.
inline constexpr std::int64_t pilot_rounds = 2;

[[nodiscard]] RunReport run_campaign(const RunRequest& request);
/// Does the same for one of several campaigns: a signal that came after its last case is an end, too, because others
/// would follow.
[[nodiscard]] RunReport run_part(const RunRequest& request);

}  // namespace grainsweep::cli
