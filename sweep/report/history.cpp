#include "sweep/report/history.hpp"

#include "sweep/campaign/json_text.hpp"
#include "sweep/schedule/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainsweep::report {
namespace {

using stats::ConvergenceRule;
using stats::Statistic;

constexpr std::int64_t default_block = 400;
constexpr std::int64_t blocks_of_small_campaigns = 8;

/// Where no rule was given: blocks to look at, the campaign in about eight where it is small.
stats::ConvergenceSettings settings_for_looking(const Responses& responses) {
    stats::ConvergenceSettings settings;
    settings.sequences = static_cast<std::int64_t>(schedule::independent_sequences(
        responses.campaign.design, static_cast<std::size_t>(responses.campaign.sequences)));
    if (settings.sequences < 4) settings.rule = ConvergenceRule::all_change;
    const std::int64_t part = responses.candidates / blocks_of_small_campaigns;
    const std::int64_t whole_rounds = part - part % settings.sequences;
    settings.block = std::max(settings.sequences, std::min(whole_rounds, default_block));
    return settings;
}

stats::ConvergenceSettings settings_for(const Responses& responses) {
    const auto& record = responses.campaign;
    if (!record.convergence) return settings_for_looking(responses);
    return schedule::settings_of(*record.convergence, schedule::independent_sequences(
                                                          record.design, static_cast<std::size_t>(record.sequences)));
}

std::span<const std::int64_t> judged_points(const Responses& responses) {
    return std::span(responses.points).first(responses.settled);
}

/// Moments of all settled values, with errors where the design is a sample.
stats::Checkpoint check_of_all(const Responses& responses, const ResponseColumn& response,
                               stats::ConvergenceSettings settings) {
    settings.block = std::max<std::int64_t>(1, responses.settled_points);
    const auto checks = stats::judge_convergence(settings, judged_points(responses), responses.judged(response),
                                                 responses.settled_points);
    if (checks.empty()) return {};
    stats::Checkpoint all = checks.front();
    all.points = responses.counted_points();
    if (!responses.ordered_sample()) {
        for (auto& estimate : all.estimates)
            estimate.error = estimate.measure = std::numeric_limits<double>::quiet_NaN();
    }
    return all;
}

void warn(History& history, const Responses& responses, const ResponseColumn& response) {
    const auto& record = responses.campaign;
    if (history.has_rule && history.settings.rule == ConvergenceRule::any_change) {
        history.warnings.emplace_back(
            "the rule any_change stops too early in about half of all sweeps: quote the errors, not the verdict");
    }
    if (record.convergence && record.convergence->observable != response.name) {
        history.warnings.push_back(
            fmt::format("the campaign was judged on {}, not on {}", record.convergence->observable, response.name));
    }
    if (record.design == "lattice") {
        history.warnings.emplace_back(
            "a lattice has no errors and cannot be judged from inside: compare campaigns of growing levels");
    }
    if (record.design == "list")
        history.warnings.emplace_back("listed points are no sample: their moments have no errors");
    if (record.design == "saltelli" || record.design == "morris") {
        history.warnings.push_back(
            fmt::format("points of a {} design depend on each other: errors of moments are rough", record.design));
    }
    if (stats::median_is_unsound(history.all.zero_share)) {
        history.warnings.push_back(
            fmt::format("{:.0f} % of the values are zero: the median jumps between zero and the rest, Pearson's "
                        "skewness is ill-defined",
                        100 * history.all.zero_share));
    }
    if (history.all.excluded > 0) {
        history.warnings.push_back(fmt::format("{} of {} cases have no value and are left out", history.all.excluded,
                                               history.all.excluded + history.all.count));
    }
    if (!record.stopped_at && responses.settled < responses.rows()) {
        history.warnings.push_back(fmt::format("{} of {} cases are not settled{}", responses.rows() - responses.settled,
                                               responses.rows(),
                                               responses.ordered_sample() ? ", or lie behind one that is not" : ""));
    }
}

std::string verdict_of(const History& history, const Responses& responses) {
    if (!responses.ordered_sample()) return "not judged: no sample of growing size";
    const auto& design = responses.campaign.design;
    if (!history.has_rule && (design == "saltelli" || design == "morris"))
        return fmt::format("not judged: no rule was given, and a {} design is made for sensitivity", design);
    if (history.checks.empty()) return fmt::format("first check at {} points", history.settings.block);
    // The first converged check is where the campaign might have stopped; without one, the last says what is missing.
    const auto converged = std::ranges::find(history.checks, true, &stats::Checkpoint::converged);
    const auto& check = converged == history.checks.end() ? history.checks.back() : *converged;
    const auto line = schedule::verdict_of(check, history.settings, responses.candidates);
    if (!history.has_rule)
        return fmt::format("no rule was given; by '{}' it would say: {}", stats::to_string(history.settings.rule),
                           line);
    return check.converged ? fmt::format("converged at {} points: {}", check.points, line) : "not converged: " + line;
}

/// What makes two lattices siblings: scene, revision, fixed values, and factors with their ranges.
std::string family_of(const store::CampaignRecord& record) {
    const auto text = campaign::parse_json(record.text);
    campaign::Json key = {{"scene", record.scene}, {"revision", record.revision}, {"factors", text.at("factors")}};
    for (const auto* section : {"fixed", "where", "accuracy"})
        if (text.contains(section)) key[section] = text.at(section);
    for (auto& factor : key["factors"]) factor.erase("notes");
    if (key.contains("fixed")) key["fixed"].erase("notes");
    const auto& design = text.at("design");
    if (design.contains("placement")) key["placement"] = design.at("placement");
    return key.dump();
}

double change(Statistic statistic, double now, double before) {
    const double moved = std::abs(now - before);
    if (statistic == Statistic::skewness) return moved / 3;
    return moved / (statistic == Statistic::g1 ? std::max(1.0, std::abs(now)) : std::abs(now));
}

}  // namespace

History history_of(const Responses& responses, const ResponseColumn& response) {
    History history;
    history.settings = settings_for(responses);
    history.has_rule = responses.campaign.convergence.has_value();
    history.all = check_of_all(responses, response, history.settings);
    if (responses.ordered_sample()) {
        history.checks = stats::judge_convergence(history.settings, judged_points(responses),
                                                  responses.judged(response), responses.settled_points);
    }
    history.verdict = verdict_of(history, responses);
    warn(history, responses, response);
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
    if (responses.campaign.design != "lattice") return {};
    const auto family = family_of(responses.campaign);
    std::vector<LatticeStep> steps;
    for (const auto& record : store.campaigns()) {
        if (record.design != "lattice" || record.scene != responses.campaign.scene || family_of(record) != family)
            continue;
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

}  // namespace grainsweep::report
