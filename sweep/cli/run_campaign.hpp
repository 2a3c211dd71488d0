// `run`: from a campaign file to an archive, with everything wired together.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

struct RunRequest {
    std::filesystem::path config;
    std::string text;                     ///< in place of the contents of `config`; empty: those
    std::string experiment;               ///< of a calibration over several; empty: the file has one campaign
    bool goes_on = false;                 ///< warnings were printed when this run began
    std::filesystem::path database;       ///< empty: NAME.db in the current folder
    std::filesystem::path artefacts;      ///< folder of checkpoints and starting states; empty: beside the database
    std::optional<std::int64_t> workers;  ///< overrides the file's
    std::optional<std::int64_t> stop_after_failures;  ///< start nothing more after so many
    std::optional<campaign::Outcome> again;           ///< ask again what ended like this
    std::optional<std::int64_t> max_cases;            ///< settle at most so many
    std::optional<std::int64_t> points;               ///< of the design, in place of the file's
    std::string adopt;  ///< campaign whose answers are taken over from an earlier version of the program; empty: none
    /// Not empty: nothing is computed; the folder that tasks of `work` share says what is asked, and their answers are
    /// put into the database.
    std::filesystem::path spool;
    bool network_disk = false;  ///< the database may lie on a network file system
    bool quiet = false;
    bool calibrates = false;  ///< the campaign file must give a calibration
    bool powder = false;      ///< of a calibration: its powder is written beside the database
    std::string path;         ///< instruction path for the workers; empty: each the widest it has
};

/// What became of the run; the database is closed again.
struct RunReport {
    int exit_code = 0;
    std::string campaign;
    std::filesystem::path database;
    std::string ending;             ///< one sentence; where the campaign gives a rule, whether it has converged by it
    std::optional<bool> converged;  ///< by the campaign's rule; none: it gives no rule
    bool finished = false;          ///< no case is left
    std::int64_t settled = 0;       ///< cases in this run
    std::int64_t points = 0;        ///< of the design, as far as answers determine them
};

[[nodiscard]] RunReport run_campaign(const RunRequest& request);

}  // namespace grainsweep::cli
