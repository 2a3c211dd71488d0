#include "sweep/cli/run_ending.hpp"

#include "sweep/report/result.hpp"
#include "sweep/report/results/runs.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/store/store.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>

namespace grainsweep::cli {

using schedule::Ending;

std::string standing(const schedule::Judge* judge) {
    if (judge == nullptr) return {};
    if (const auto points = judge->converged_at()) return fmt::format("; converged at {} points", *points);
    return "; not converged: " + judge->verdict();
}

std::string summary_of(Ending ending, const schedule::Plan::Tally& tally, const schedule::Judge* judge) {
    const auto left = [&](std::string_view how, std::string_view then = "; run again to resume") {
        return fmt::format("{} with {} cases left{}{}", how, tally.questions - tally.decided, then, standing(judge));
    };
    switch (ending) {
        case Ending::finished:
            return (tally.failed == 0 ? "all cases are settled"
                                      : fmt::format("all cases are finished, {} of them failed", tally.failed)) +
                   standing(judge);
        case Ending::converged:
            return fmt::format("converged after {} points: {}", *judge->converged_at(), judge->verdict());
        case Ending::limited:
            return left("stopped");
        case Ending::too_many_failures:
            return fmt::format("stopped after {} failed cases{}", tally.failed_now, standing(judge));
        case Ending::failed_alike:
            return fmt::format(
                "stopped, because the first {} cases all failed for one reason ({}), with {} cases left; run again to "
                "try all of them, --keep-going computes the others, too{}",
                tally.failed_now, tally.failed_alike, tally.questions - tally.decided, standing(judge));
        case Ending::out_of_time:
            return left("out of time");
        case Ending::asked_to_end:
            return left("ended by a signal");
        case Ending::too_long:
            return left("stopped",
                        ", each predicted to exceed the time limit; extend it (execution.walltime, or the job's time "
                        "limit)");
        case Ending::interrupted:
            return left("interrupted");
    }
    return {};
}

int exit_code(Ending ending, const schedule::Plan::Tally& tally) {
    if (ending == Ending::interrupted) return interrupted_code;
    if (ending == Ending::out_of_time || ending == Ending::asked_to_end) return ended_code;
    if (ending == Ending::converged) return 0;
    return tally.failed == 0 && tally.decided == tally.questions ? 0 : 1;
}

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
