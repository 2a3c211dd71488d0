#include "sweep/study/history.hpp"

#include "stats/confidence.hpp"
#include "stats/spread.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/schedule/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>

namespace grainsweep::study {
namespace {

using stats::ConvergenceRule;
using stats::Statistic;

/// Where no rule was given: blocks to look at, the campaign in about eight where it is small.
stats::ConvergenceSettings settings_for_looking(const Responses& responses) {
    stats::ConvergenceSettings settings;
    settings.sequences = static_cast<std::int64_t>(schedule::independent_sequences(
        responses.campaign.design, static_cast<std::size_t>(responses.campaign.sequences)));
    if (settings.sequences < 4) settings.rule = ConvergenceRule::all_change;
    settings.block = campaign::default_block(responses.candidates, settings.sequences, settings.sequences);
    return settings;
}

stats::ConvergenceSettings settings_for(const Responses& responses, const ResponseColumn& response) {
    const auto& record = responses.campaign;
    if (!record.convergence) return settings_for_looking(responses);
    auto settings = schedule::settings_of(
        *record.convergence,
        schedule::independent_sequences(record.design, static_cast<std::size_t>(record.sequences)));
    // Other observables than the judged one have no model: their plain errors are shown.
    if (settings.traits().of_model && response.name != record.convergence->observable)
        settings.rule = ConvergenceRule::replicates;
    return settings;
}

/// What a rule with models is shown with beside them.
stats::ConvergenceSettings plain(stats::ConvergenceSettings settings) {
    if (settings.traits().of_model) settings.rule = ConvergenceRule::replicates;
    return settings;
}

/// The checks of a run under the rule `assisted`, from what it stored of them.
std::vector<stats::Checkpoint> judged_in_the_run(const Responses& responses,
                                                 const stats::ConvergenceSettings& settings) {
    std::vector<stats::Checkpoint> checks;
    for (const auto& row : responses.judged_checks) {
        if (row.points > responses.settled_points) break;
        stats::Checkpoint check;
        check.points = row.points;
        check.excluded = row.excluded;
        check.zero_share = row.zero_share;
        const std::array values = {row.mean, row.sd, row.skewness, row.g1, row.kurtosis};
        const std::array errors = {row.mean_error, row.sd_error, row.skewness_error, row.g1_error, row.kurtosis_error};
        for (std::size_t s = 0; s < stats::statistics.size(); ++s)
            check.estimates[s] = {values[s], errors[s], stats::measure_of(stats::statistics[s], errors[s], values[s])};
        stats::compare_with_tolerance(check, settings);
        check.converged = row.converged;
        checks.push_back(std::move(check));
    }
    return checks;
}

/// Values by growing point, and how many places before each hold the same run.
struct Judged {
    std::vector<std::int64_t> points, earlier;
    std::vector<double> values;

    [[nodiscard]] std::vector<stats::Checkpoint> by(const stats::ConvergenceSettings& settings,
                                                    std::int64_t settled) const {
        return stats::judge_convergence(settings, points, values, settled, earlier);
    }
};

/// Every row of `rows`; where repeats weigh, every place of `repeats` too.
Judged judged_of(const Responses& responses, const ResponseColumn& response, std::span<const std::size_t> rows,
                 std::span<const RepeatedPlace> repeats) {
    std::vector<RepeatedPlace> places;
    for (const auto row : rows) places.push_back({responses.points[row], row});
    if (responses.repeats_weigh) {
        places.insert(places.end(), repeats.begin(), repeats.end());
        std::ranges::stable_sort(places, {}, &RepeatedPlace::point);
    }
    Judged judged;
    std::vector<std::int64_t> met(responses.rows());
    for (const auto& place : places) {
        judged.points.push_back(place.point);
        judged.values.push_back(response.values[place.row]);
        judged.earlier.push_back(met[place.row]++);
    }
    return judged;
}

Judged settled_of(const Responses& responses, const ResponseColumn& response) {
    std::vector<std::size_t> rows(responses.settled);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return judged_of(responses, response, rows, responses.settled_repeats());
}

/// Moments of all settled values, with errors where the design is a sample.
stats::Checkpoint check_of_all(const Responses& responses, const ResponseColumn& response,
                               stats::ConvergenceSettings settings, std::span<const stats::Level> levels) {
    settings = plain(std::move(settings));
    for (const auto& level : levels)
        if (std::ranges::find(settings.gates, stats::Gate{level}) == settings.gates.end())
            settings.gates.emplace_back(level);
    settings.block = std::max<std::int64_t>(1, responses.settled_points);
    const auto checks = settled_of(responses, response).by(settings, responses.settled_points);
    if (checks.empty()) return {};
    stats::Checkpoint all = checks.front();
    all.points = responses.counted_points();
    if (!responses.ordered_sample()) {
        constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
        for (auto& estimate : all.estimates) estimate.error = estimate.measure = unknown;
        for (auto& [level, estimate] : all.levels) estimate.error = estimate.measure = unknown;
    }
    return all;
}

/// Levels among the values and the completed cases without one, which lie beyond all others. Withdraws what would lie
/// among the latter.
void count_without_value(History& history, const Responses& responses, const ResponseColumn& response,
                         std::span<const stats::Level> levels, WithoutValue without) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const double value : response.values)
        if (std::isfinite(value)) low = std::min(low, value), high = std::max(high, value);
    if (!(low <= high)) return;
    const double least = low, most = high;
    for (const auto& level : levels)
        if (const auto* beyond = std::get_if<stats::Exceedance>(&level))
            low = std::min(low, beyond->threshold), high = std::max(high, beyond->threshold);
    const bool above = without == WithoutValue::above;
    const double farther = std::max({high - low, std::abs(high), std::abs(low), 1e-300});
    ResponseColumn censored = response;
    for (std::size_t row = 0; row < responses.settled; ++row)
        if (std::isnan(censored.values[row]) && responses.outcomes[row] == campaign::Outcome::completed) {
            censored.values[row] = above ? high + farther : low - farther;
            ++history.beyond;
        }
    if (history.beyond == 0) return;
    history.all.levels = check_of_all(responses, censored, history.settings, levels).levels;
    constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
    for (auto& [level, estimate] : history.all.levels) {
        if (!std::holds_alternative<stats::Quantile>(level)) continue;
        const auto seen = [&](double value) { return least <= value && value <= most; };
        if (!seen(estimate.value)) estimate.value = unknown;
        if (!seen(above ? estimate.value + estimate.error : estimate.value - estimate.error))
            estimate.error = estimate.measure = unknown;
    }
    history.warnings.push_back(
        fmt::format("quantiles and probabilities: {} completed cases without a value count as {} every value; moments "
                    "leave them out",
                    history.beyond, above ? "above" : "below"));
}

/// Moments of all finished values, where the settled beginning has not all of them.
std::optional<stats::Checkpoint> check_of_finished(const Responses& responses, const ResponseColumn& response,
                                                   stats::ConvergenceSettings settings) {
    if (responses.campaign.stopped_at || responses.finished() <= responses.settled) return std::nullopt;
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < responses.rows(); ++row)
        if (has_final_outcome(responses.outcomes[row])) rows.push_back(row);
    std::vector<RepeatedPlace> repeats;
    std::ranges::copy_if(responses.repeated, std::back_inserter(repeats),
                         [&](const auto& place) { return has_final_outcome(responses.outcomes[place.row]); });
    const auto judged = judged_of(responses, response, rows, repeats);
    auto points = judged.points;
    settings = plain(std::move(settings));
    settings.block = points.back() + 1;
    auto found = judged.by(settings, settings.block);
    if (found.empty()) return std::nullopt;
    points.erase(std::unique(points.begin(), points.end()), points.end());
    found.front().points = static_cast<std::int64_t>(points.size());
    return found.front();
}

/// Why statistics are missing of values that spread too far or too little for double precision.
void warn_of_powers(History& history, std::span<const double> values) {
    for (const int power : {2, 4}) {
        const auto reason = stats::reason_against_powers(values, power);
        if (reason.empty()) continue;
        history.warnings.push_back(
            fmt::format("no {}: {}", power == 2 ? "sd, skewness, g1 and kurtosis" : "g1 and kurtosis", reason));
        return;
    }
}

/// Warns if a sample is still too small for its statistics.
void warn_of_few(History& history, const Responses& responses) {
    if (!responses.ordered_sample()) return;
    if (history.all.all_equal)
        history.warnings.push_back(
            fmt::format("all {} values are equal: up to {:.2g} % of the box may have other values (95 %)",
                        history.all.runs, 100 * stats::largest_unseen_share(history.all.runs)));
    for (const auto statistic : {Statistic::g1, Statistic::kurtosis})
        if (const auto carriers = history.all.of(statistic).carriers)
            history.warnings.push_back(
                fmt::format("{} has no error yet: it rests on {:.0f} of the {} values, {:.0f} are needed",
                            stats::to_string(statistic), carriers->count, history.all.count, carriers->needed));
}

void warn(History& history, const Responses& responses, const ResponseColumn& response) {
    warn_of_powers(history, responses.known(response));
    warn_of_few(history, responses);
    const auto& record = responses.campaign;
    if (history.has_rule && history.settings.traits().one_gate) {
        history.warnings.emplace_back(
            "the rule any_change stops too early in about half of all campaigns: quote the errors, not the verdict");
    }
    if (history.has_rule && history.settings.traits().of_model) {
        history.warnings.emplace_back(
            "checks and measures use estimates with a response model, as judged in the run; values and errors over "
            "all points are plain estimates");
        if (history.all.excluded > 0)
            history.warnings.push_back(
                fmt::format("estimates with a model cover the whole box, extrapolated to the settings of the {} cases "
                            "without a value; plain estimates use the cases with a value",
                            history.all.excluded));
    }
    const auto goal = campaign::remarks_in(record.text).goal;
    if (goal && goal->setting && *goal->setting != campaign::AccuracyGoal::measure)
        history.warnings.push_back(
            fmt::format("moments and quantiles are of the setting '{}' and contain its error: the result is the "
                        "corrected mean and sd of {} at the end",
                        *goal->setting, goal->observable));
    if (record.convergence && record.convergence->observable != response.name) {
        history.warnings.push_back(
            fmt::format("the campaign was judged on {}, not on {}", record.convergence->observable, response.name));
    }
    const auto& design = responses.design();
    if (design.grows) {
        history.warnings.push_back(
            fmt::format("a {} places its points by results: their moments do not describe the ranges", record.design));
    } else if (design.beginning == designs::Beginning::corner) {
        history.warnings.push_back(
            fmt::format("a {} gives no errors of its moments: compare campaigns of growing levels", record.design));
    }
    if (design.beginning == designs::Beginning::listed)
        history.warnings.emplace_back("listed points are no sample: their moments have no errors");
    if (design.block(responses.group_names.size()) > 1) {
        history.warnings.push_back(
            fmt::format("points of a {} design depend on each other: errors of moments are rough", record.design));
    }
    if (stats::median_is_unsound(history.all.zero_share)) {
        history.warnings.push_back(
            fmt::format("{:.0f} % of the values are zero: the median jumps, and Pearson's skewness is ill-defined",
                        100 * history.all.zero_share));
    }
    if (!responses.repeated.empty()) {
        history.warnings.push_back(
            fmt::format("{} of {} places repeat an earlier case: each of the {} cases {}", responses.repeated.size(),
                        responses.repeated.size() + responses.rows(), responses.rows(),
                        responses.repeats_weigh ? "weighs as many places as hold it, and errors are widened for that"
                                                : "counts once"));
    }
    if (history.all.excluded > 0) {
        const auto failed = std::ranges::count_if(responses.outcomes, [](const auto& outcome) {
            return outcome && *outcome != campaign::Outcome::completed;
        });
        const std::string why =
            failed < history.all.excluded ? campaign::why_absent(record.scene, response.name) : std::string();
        history.warnings.push_back(fmt::format("{} of {} cases have no value and are excluded{}{}",
                                               history.all.excluded, history.all.excluded + history.all.count,
                                               why.empty() ? "" : ": a completed case has none where ", why));
    }
    const auto finished = responses.finished();
    if (!record.stopped_at && finished < responses.rows()) {
        history.warnings.push_back(
            fmt::format("{} of {} cases are not settled", responses.rows() - finished, responses.rows()));
    }
    if (history.provisional) {
        history.warnings.push_back(
            fmt::format("{} finished cases follow an unfinished one: only the provisional figures include them",
                        finished - responses.settled));
    }
    if (auto note = extent_note(record); !note.empty()) history.warnings.push_back(std::move(note));
}

std::int64_t first_check(const stats::ConvergenceSettings& settings) {
    if (!settings.traits().of_model) return settings.block;
    return (stats::fewest_assisted_points + settings.block - 1) / settings.block * settings.block;
}

std::string verdict_of(const History& history, const Responses& responses) {
    if (!responses.ordered_sample()) return "not judged: no sample of growing size";
    if (!history.has_rule && responses.design().purpose != designs::Purpose::statistics)
        return fmt::format("not judged: no rule was given, and a {} design is made for sensitivity",
                           responses.campaign.design);
    if (history.checks.empty())
        return fmt::format("{}first check at {} points, {} are settled", history.has_rule ? "not converged: " : "",
                           first_check(history.settings), responses.settled_points);
    // The first converged check is where the campaign might have stopped; without one, the last says what is missing.
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    const auto& check = converged == history.checks.end() ? history.checks.back() : *converged;
    const auto line = schedule::verdict_of(check, history.settings, responses.candidates);
    if (!history.has_rule)
        return fmt::format("no rule was given; the rule '{}' would give: {}", stats::to_string(history.settings.rule),
                           line);
    return check.converged ? fmt::format("converged at {} points: {}", check.points, line) : "not converged: " + line;
}

double change(Statistic statistic, double now, double before) {
    const double moved = std::abs(now - before);
    if (statistic == Statistic::skewness) return moved / 3;
    return moved / (statistic == Statistic::g1 ? std::max(1.0, std::abs(now)) : std::abs(now));
}

}  // namespace

std::string extent_note(const store::CampaignRecord& campaign) {
    if (!campaign.shrunk()) return {};
    const auto text = [](const store::Extent& extent) {
        return fmt::format("{} points x {}", extent.candidates, extent.replicates);
    };
    return fmt::format("asked now: {}; stored: {}; view and statistics use the stored cases", text(campaign.asked),
                       text(campaign.stored));
}

std::string points_line(const Responses& responses) {
    const auto line = fmt::format("{} candidates, {} left out by where, {} cases asked, {} finished",
                                  responses.candidates, responses.dropped(), responses.rows(), responses.finished());
    if (responses.repeated.empty()) return line;
    return fmt::format("{}, {} places repeat one of them", line, responses.repeated.size());
}

History figures_of(const Responses& responses, const ResponseColumn& response, std::span<const stats::Level> levels,
                   WithoutValue without) {
    History history;
    history.settings = settings_for(responses, response);
    history.has_rule = responses.campaign.convergence.has_value();
    history.all = check_of_all(responses, response, history.settings, levels);
    history.provisional = check_of_finished(responses, response, history.settings);
    warn(history, responses, response);
    if (without != WithoutValue::left_out) count_without_value(history, responses, response, levels, without);
    return history;
}

History history_of(const Responses& responses, const ResponseColumn& response, std::span<const stats::Level> levels,
                   WithoutValue without) {
    History history = figures_of(responses, response, levels, without);
    if (history.settings.traits().of_model) {
        history.checks = judged_in_the_run(responses, history.settings);
    } else if (responses.ordered_sample()) {
        history.checks = settled_of(responses, response).by(history.settings, responses.settled_points);
    }
    history.verdict = verdict_of(history, responses);
    if (history.has_rule) history.converged = std::ranges::any_of(history.checks, &stats::Checkpoint::converged);
    return history;
}

std::vector<const stats::Checkpoint*> checks_to_show(const History& history, std::size_t most) {
    std::vector<const stats::Checkpoint*> shown;
    const std::size_t step = history.checks.size() / most + 1;
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    for (auto check = history.checks.begin(); check != history.checks.end(); ++check) {
        const auto left = static_cast<std::size_t>(history.checks.end() - check) - 1;
        if (left % step == 0 || check == converged) shown.push_back(&*check);
    }
    if (history.all.points > 0 && (shown.empty() || shown.back()->points != history.all.points))
        shown.push_back(&history.all);
    return shown;
}

std::vector<LatticeStep> lattice_family(const store::Store& store, const Responses& responses,
                                        const ResponseColumn& response) {
    if (responses.design().beginning != designs::Beginning::corner) return {};
    const auto family = campaign::family_of(responses.campaign);
    std::vector<LatticeStep> steps;
    for (const auto& record : store.campaigns()) {
        if (campaign::family_of(record) != family) continue;
        const auto sibling = read_responses(store, record);
        if (sibling.settled < sibling.rows()) continue;  // half a lattice is no lattice
        LatticeStep step;
        step.campaign = record.name;
        step.points = sibling.counted_points();
        step.summary = stats::summarise(sibling.judged(sibling.observable(response.name)));
        steps.push_back(std::move(step));
    }
    std::ranges::stable_sort(steps, {}, &LatticeStep::points);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        for (const auto statistic : stats::statistics) {
            steps[i].changes.push_back(
                i == 0 ? std::numeric_limits<double>::quiet_NaN()
                       : change(statistic, steps[i].summary.of(statistic), steps[i - 1].summary.of(statistic)));
        }
    }
    return steps.size() < 2 ? std::vector<LatticeStep>{} : steps;
}

}  // namespace grainsweep::study
