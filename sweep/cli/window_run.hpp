// `window --run`: batches of the cases that promise most are run into the database until the best setting is known well
// enough.
//
// Every batch is a campaign of its own, NAME_next, NAME_next2, ..., a list with a seed of its own (the campaign's, plus
// its number), so that a setting that is asked again is a new run. The same command again goes on: batches that were
// interrupted are finished first, and their cases come into the models.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/process_window.hpp"
#include "sweep/study/response_models.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

/// The name of the next batch of a campaign and its number, from 1: the first that no campaign of the database has.
struct BatchName {
    std::string name;
    std::uint64_t number = 1;
};
[[nodiscard]] BatchName name_of_next(const store::Store& store, const std::string& campaign);

struct WindowRun {
    std::filesystem::path database;
    std::string campaign;
    double width = 0;  ///< wanted 95 % half-width of the objective's mean at the best setting, in its unit
    std::int64_t batch = 8, max_cases = 100;
    std::optional<std::int64_t> workers;
    bool quiet = false;  ///< no line per batch
};

struct WindowRunEnd {
    std::int64_t cases = 0;  ///< that were to be run
    std::int64_t batches = 0;
    bool reached = false;
    std::string says;   ///< why it ended, one sentence without a full stop
    int exit_code = 0;  ///< 0: the width is reached, 1: it is not, 130: interrupted
};

/// Throws as window_of and run_campaign do. The database must not be open for writing.
[[nodiscard]] WindowRunEnd run_towards_window(const WindowRun& run, const study::WindowRequest& request);

}  // namespace grainsweep::cli
