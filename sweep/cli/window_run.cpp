#include "sweep/cli/window_run.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/cli/run_campaign.hpp"
#include "sweep/cli/run_ending.hpp"
#include "sweep/cli/written_campaign.hpp"
#include "sweep/report/window_tables.hpp"
#include "sweep/store/campaign_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iostream>
#include <limits>
#include <utility>

namespace grainsweep::cli {
namespace {

using store::Store;

struct Batch {
    std::string name, text;
    std::int64_t cases = 0;
};

/// Returns whether a campaign has a name of `name_of_next`.
bool is_next(std::string_view name, const std::string& campaign) {
    const auto stem = campaign + "_next";
    return name.starts_with(stem) &&
           std::ranges::all_of(name.substr(stem.size()), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// A batch that was begun and has cases that are not settled.
std::optional<Batch> unfinished_batch(const Store& store, const std::string& campaign) {
    for (const auto& record : store.campaigns()) {
        if (!is_next(record.name, campaign)) continue;
        const auto responses = study::read_responses(store, record);
        const auto open = responses.rows() - responses.finished();
        if (open > 0) return Batch{record.name, record.text, static_cast<std::int64_t>(open)};
    }
    return std::nullopt;
}

/// State of the window in the database.
struct Standing {
    std::string campaign;                                   ///< the name of the campaign that is asked about
    double wanted = 0;                                      ///< width or tolerance
    double left = std::numeric_limits<double>::infinity();  ///< half-width, or part of the hypervolume
    std::string text;                                       ///< one sentence without a full stop
    std::size_t cases = 0;                                  ///< in the objective's model
    std::optional<Batch> next;
};

Standing standing_of(const WindowRun& run, study::WindowRequest request, std::int64_t most) {
    const Store store(run.database, Store::Mode::read);
    const auto cases = study::read_model_cases(store, run.campaign, request.left_out);
    request.next = static_cast<std::size_t>(std::max<std::int64_t>(0, std::min(run.batch, most)));
    const auto window = study::window_of(store, cases, request);
    const bool pair = window.goals.size() == 2;
    if (!pair && window.goals.front().factor)
        throw campaign::input_error(
            "--run", request.objectives.front().name,
            "is a factor, whose value is chosen, not measured: --width needs an observable as objective");
    Standing standing;
    standing.campaign = cases.campaign.name;
    standing.cases = window.models.front().cases();
    standing.wanted = pair ? run.tolerance : run.width;
    if (pair && window.volume->value > 0) {
        standing.left = window.volume->further / window.volume->value;
        standing.text = fmt::format("{}, wanted {:.3g} %", report::volume_text(*window.volume), 100 * run.tolerance);
    } else if (!pair && window.best) {
        const auto& best = window.best->objectives.front();
        standing.left = best.mean_half_width();
        standing.text = fmt::format("best {} {:.6g} +- {:.3g} (95 %), wanted +- {:.3g}",
                                    request.objectives.front().name, best.mean, standing.left, run.width);
    } else {
        standing.text = fmt::format("no {}setting meets the condition with probability {} yet", pair ? "computed " : "",
                                    1 - request.risk);
    }
    if (auto open = unfinished_batch(store, cases.campaign.name)) {
        standing.next = std::move(open);
    } else if (!window.next.empty()) {
        const auto [name, number] = name_of_next(store, cases.campaign.name);
        store::check_campaign_name(name);
        standing.next = Batch{name, study::next_campaign(cases, window, name, number),
                              static_cast<std::int64_t>(window.next.size())};
    }
    return standing;
}

}  // namespace

BatchName name_of_next(const Store& store, const std::string& campaign) {
    const auto records = store.campaigns();
    for (std::uint64_t number = 1;; ++number) {
        std::string name = campaign + "_next" + (number == 1 ? "" : std::to_string(number));
        if (std::ranges::find(records, name, &store::CampaignRecord::name) == records.end()) return {name, number};
    }
}

WindowRunEnd run_towards_window(const WindowRun& run, const study::WindowRequest& request) {
    WindowRunEnd end;
    while (true) {
        const auto left = run.max_cases - end.cases;
        const auto standing = standing_of(run, request, left);
        const auto& text = standing.text;
        if (!run.quiet) std::cerr << fmt::format("{} cases: {}\n", standing.cases, text);
        end.reached = standing.left <= standing.wanted;
        end.exit_code = end.reached ? 0 : 1;
        end.says = text;
        if (end.reached) return end;
        if (left <= 0) {
            end.says = fmt::format("{}; --max-cases {} reached", text, run.max_cases);
            return end;
        }
        if (!standing.next) {
            end.says = fmt::format("{}; no further case promises an improvement", text);
            return end;
        }
        const WrittenCampaign file("", standing.next->name, standing.next->text, "--run");
        RunRequest batch;
        batch.config = file.path();
        batch.database = run.database;
        batch.workers = run.workers;
        batch.max_cases = left;
        batch.quiet = true;
        const auto report = run_part(batch);
        end.cases += std::min(standing.next->cases, left);
        ++end.batches;
        if (is_end_of_all(report.exit_code)) {
            end.exit_code = report.exit_code;
            end.says = report.exit_code == interrupted_code
                           ? "interrupted; run it again to resume"
                           : "ended by a signal or a time limit; run it again to resume";
            return end;
        }
    }
}

}  // namespace grainsweep::cli
