#include "sweep/cli/run_summary.hpp"

#include "sweep/report/result.hpp"
#include "sweep/report/results/runs.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/store/store.hpp"

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>

namespace grainsweep::cli {

void show_run(const RunReport& run, report::Format format, bool all) {
    if (format == report::Format::text) {
        const store::Store archive(run.database, store::Store::Mode::read);
        auto summary = report::closing_summary(archive, run.campaign, run.database, all);
        return report::write(std::cout, summary.say().say(run.ending), format);
    }
    std::error_code none;
    const auto bytes = static_cast<std::int64_t>(std::filesystem::file_size(run.database, none));
    std::optional<std::int64_t> converged;
    if (run.converged) converged = std::int64_t{*run.converged};
    const report::Document shown{.rows = {{"campaign", "database", "bytes", "ending", "exit_code", "converged"},
                                          {{run.campaign, run.database.string(), bytes, run.ending,
                                            std::int64_t{run.exit_code}, report::to_cell(converged)}}},
                                 .value = report::Result<report::results::run>{{"campaign", run.campaign},
                                                                               {"database", run.database.string()},
                                                                               {"bytes", bytes},
                                                                               {"ending", run.ending},
                                                                               {"converged", run.converged},
                                                                               {"exit_code", run.exit_code}}};
    report::write(std::cout, shown, format);
}

}  // namespace grainsweep::cli
