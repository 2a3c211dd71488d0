// `import`: stores results of cases that were computed elsewhere, with their origin.
#pragma once

#include "sweep/campaign/old_results.hpp"

#include <cstddef>
#include <filesystem>
#include <string>

namespace grainsweep::cli {

struct ImportRequest {
    campaign::OldResultsRequest results;
    std::filesystem::path config;
    std::filesystem::path database;  ///< empty: NAME.db in the current folder
    std::string experiment;          ///< of a calibration with several
    std::string accuracy;            ///< setting of the numerics, for a campaign with an error goal
    bool network_disk = false;       ///< the database may lie on a network file system
};

struct ImportReport {
    std::string campaign;  ///< NAME; of an experiment or a setting of the numerics NAME_EXPERIMENT or NAME_SETTING
    std::string beside;    ///< campaign of the cases that the design does not place
    std::filesystem::path database;
    std::size_t placed = 0;      ///< imported cases of the design
    std::size_t others = 0;      ///< imported cases beside it
    std::size_t known = 0;       ///< cases that the database had with these values
    std::size_t unanswered = 0;  ///< lines without an answer, which are left out
};

/// Stores the lines of a file as answers of the campaign. A case that the design places is settled by its line. The
/// others become the campaign NAME_imported beside it, whose cases models use and statistics do not. Nothing is stored
/// if a line contradicts another line, or an answer in the database: throws InputError with line and both values.
[[nodiscard]] ImportReport import_results(const ImportRequest& request);

}  // namespace grainsweep::cli
