// `window --run`: runs batches of the most promising cases until the best setting, or the front of two objectives, is
// known with the wanted accuracy.
//
// Every batch is a campaign, NAME_next, NAME_next2, ..., with a list of settings. Its seed is the campaign's seed plus
// its number, so that a repeated setting is a new run. The same command continues after an interruption: unfinished
// batches are completed first, and their cases are used in the models.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/process_window.hpp"
#include "sweep/study/response_models.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

/// Name of the next batch of a campaign and its number, from 1: the first name that no campaign of the database has.
struct BatchName {
    std::string name;
    std::uint64_t number = 1;
};
[[nodiscard]] BatchName name_of_next(const store::Store& store, const std::string& campaign);

struct WindowRun {
    std::filesystem::path database;
    std::string campaign;
    double width = 0;      ///< wanted 95 % half-width of the objective's mean at the best setting, in its unit
    double tolerance = 0;  ///< of two objectives: part of its hypervolume that the computed front may lack (95 %)
    std::int64_t batch = 8, max_cases = 100;
    std::optional<std::int64_t> workers;
    bool quiet = false;  ///< no line per batch
};

struct WindowRunEnd {
    std::int64_t cases = 0;  ///< requested cases
    std::int64_t batches = 0;
    bool reached = false;
    std::string says;   ///< reason of the end, one sentence without a full stop
    int exit_code = 0;  ///< 0: the accuracy is reached, 1: it is not, 130: interrupted
};

/// Runs batches. Throws like window_of and run_campaign. The database must not be open for writing.
[[nodiscard]] WindowRunEnd run_towards_window(const WindowRun& run, const study::WindowRequest& request);

}  // namespace grainsweep::cli
