#include "sweep/study/accuracy.hpp"

#include "stats/confidence.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/study/corrected.hpp"
#include "sweep/study/error_text.hpp"
#include "sweep/study/responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace grainsweep::study {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

using Values = std::map<std::int64_t, double>;  ///< by point

Values values_of(const store::Store& store, const std::string& campaign, const std::string& observable) {
    Values values;
    for (const auto& one : store.values(campaign, observable))
        if (std::isfinite(one.value)) values.insert_or_assign(one.point, one.value);
    return values;
}

/// Returns the standard deviation; NaN of fewer than two values.
double deviation(const std::vector<double>& values) {
    if (values.size() < 2) return nan;
    const auto n = static_cast<double>(values.size());
    double sum = 0, squares = 0;
    for (const double x : values) sum += x;
    for (const double x : values) squares += (x - sum / n) * (x - sum / n);
    return std::sqrt(squares / (n - 1));
}

Bias bias_of(const Values& values, const Values& against) {
    Bias found;
    std::vector<double> differences, own;
    double sum = 0;
    for (const auto& [point, value] : values) {
        const auto other = against.find(point);
        if (other == against.end()) continue;
        differences.push_back(value - other->second);
        own.push_back(value);
        sum += other->second;
    }
    found.pairs = differences.size();
    const auto n = static_cast<double>(differences.size());
    found.mean = found.pairs > 0 ? sum / n : nan;
    double all = 0;
    for (const double x : differences) all += x;
    found.bias = found.pairs > 0 ? all / n : nan;
    found.scatter = deviation(differences);
    found.spread = deviation(own);
    found.half_width = found.pairs > 1 ? stats::student_half_width(differences) : nan;
    return found;
}

/// Processor time of the answers that stand.
void add_costs(const store::Store& store, NumericsCost& cost) {
    const auto rows = store.query(fmt::format(
        "SELECT count(*), sum(c.outcome IN ('completed', 'skipped')), avg(iif(c.outcome = 'completed', a.cpu_seconds, "
        "NULL)) "
        "FROM campaign_case AS p JOIN campaign AS g USING (campaign_id) JOIN sim_case AS c USING (case_key) "
        "LEFT JOIN attempt AS a ON a.case_key = c.case_key AND a.number = c.attempts WHERE g.name = '{}'",
        cost.numerics.campaign));
    const auto& row = rows.rows.front();
    cost.cases = static_cast<std::size_t>(std::max(0.0, number_of(row[0])));
    const double answered = number_of(row[1]);
    cost.answered = std::isfinite(answered) ? static_cast<std::size_t>(answered) : 0;
    cost.seconds = number_of(row[2]);
}

std::string share_or_unknown(double relative) {
    return std::isfinite(relative) ? fmt::format("{:.2g} %", 100 * relative) : "unknown";
}

/// Largest of the gates, relative; NaN where one is unknown.
double largest_part(const stats::TwoLevelCheck& check, double stats::TwoLevelMoment::*part) {
    double found = 0;
    for (const auto& moment : check.moments) {
        const double relative = moment.relative(moment.*part);
        found = std::isnan(relative) || relative > found ? relative : found;
    }
    return found;
}

/// Returns the names of the campaign and of the campaigns of the same design at other settings, as SQL texts.
std::string campaigns_of_goal(const store::Store& store, const store::CampaignRecord& campaign) {
    std::string names;
    for (const auto& other : store.campaigns()) {
        const bool same = other.scene == campaign.scene && other.factors == campaign.factors &&
                          other.seed == campaign.seed && other.design == campaign.design;
        if (other.name == campaign.name || (same && other.name.starts_with(campaign.name + "_")))
            names += fmt::format("{}'{}'", names.empty() ? "" : ", ", other.name);
    }
    return names;
}

/// Processor time of the attempts of these campaigns, each case once: `what` is an aggregate of it.
double core_seconds(const store::Store& store, std::string_view what, const std::string& names) {
    return number_of(
        store
            .query(fmt::format("SELECT {}(cpu_seconds) FROM attempt WHERE case_key IN (SELECT case_key FROM "
                               "campaign_case JOIN campaign USING (campaign_id) WHERE name IN ({}))",
                               what, names))
            .rows.front()
            .front());
}

}  // namespace

double Bias::relative_bound() const {
    if (bias == 0 && half_width == 0) return 0;
    return mean != 0 ? (std::abs(bias) + half_width) / std::abs(mean) : std::numeric_limits<double>::infinity();
}

std::vector<NumericsCost> accuracy_of(const store::Store& store, std::span<const NumericsCampaign> campaigns) {
    std::vector<NumericsCost> costs;
    if (campaigns.empty()) return costs;
    const auto against = read_responses(store, find_campaigns(store, campaigns.back().campaign).front());
    for (const auto& one : campaigns) {
        auto& cost = costs.emplace_back();
        cost.numerics = one;
        add_costs(store, cost);
        for (const auto& response : against.observables) {
            const auto reference = values_of(store, campaigns.back().campaign, response.name);
            if (reference.empty()) continue;
            auto& bias = cost.biases.emplace_back(bias_of(values_of(store, one.campaign, response.name), reference));
            bias.observable = response.name;
            bias.unit = response.unit;
        }
    }
    return costs;
}

std::optional<std::size_t> cheapest_within(std::span<const NumericsCost> costs,
                                           std::span<const std::string> observables, double tolerance) {
    std::optional<std::size_t> best;
    for (std::size_t k = 0; k + 1 < costs.size(); ++k) {
        const auto within = [&](const std::string& name) {
            const auto found = std::ranges::find(costs[k].biases, name, &Bias::observable);
            return found != costs[k].biases.end() && found->relative_bound() <= tolerance;
        };
        const bool complete = costs[k].answered == costs[k].cases && costs[k].cases > 0;
        if (!complete || !std::ranges::all_of(observables, within)) continue;
        if (!best || costs[k].seconds < costs[*best].seconds) best = k;
    }
    if (best && !(costs[*best].seconds < costs.back().seconds)) best.reset();
    return best;
}

std::string Corrected::verdict() const {
    std::string moments;
    for (const auto& moment : check.moments)
        moments += fmt::format("{}{} {}", moments.empty() ? "" : ", ", to_string(moment.statistic),
                               with_error(moment.value, moment.together));
    const auto cases = check.pairs == 0
                           ? fmt::format("{} cases at {}", check.points, *goal.setting)
                           : fmt::format("{} cases at {} and {} pairs", check.points, *goal.setting, check.pairs);
    const auto other =
        alone          ? fmt::format("; {} alone at least {:.3g}", campaign::AccuracyGoal::measure, *alone)
        : before_alone ? fmt::format("; after {} cases at a cheaper setting, as more pairs cost more", *before_alone)
        : chosen_alone ? "; pairs with a cheaper setting would have cost more"
                       : "";
    return fmt::format(
        "{} {} {} of {}: {}; numerics {}, statistics {}, together {}; {}, {:.3g} core-s{}", goal.observable,
        within ? "within" : "not yet within", share_or_unknown(goal.tolerance), campaign::AccuracyGoal::measure,
        moments, share_or_unknown(largest_part(check, &stats::TwoLevelMoment::numerics)),
        share_or_unknown(largest_part(check, &stats::TwoLevelMoment::statistics)),
        share_or_unknown(largest_part(check, &stats::TwoLevelMoment::together)), cases, core_seconds, other);
}

std::string name_at(std::string_view campaign, std::string_view setting) {
    return fmt::format("{}_{}", campaign, setting);
}

FirstValues first_values(const store::Store& store, std::string_view campaign, std::string_view observable,
                         std::int64_t points) {
    FirstValues found{std::vector<double>(static_cast<std::size_t>(points), nan)};
    for (const auto& one : store.values(campaign, observable)) {
        if (one.point >= points) break;
        if (!has_final_outcome(one.outcome)) {
            found.values.resize(static_cast<std::size_t>(one.point));
            break;
        }
        found.values[static_cast<std::size_t>(one.point)] = one.value;
        if (std::isnan(one.value)) ++found.without_value;
    }
    return found;
}

FirstFactors first_factors(const store::Store& store, std::string_view campaign, std::int64_t points) {
    constexpr double middle = 0.5;  // of a point that has no case
    const auto responses = read_responses(store, find_campaigns(store, campaign).front());
    FirstFactors found{{}, responses.factors.size()};
    found.rows.assign(static_cast<std::size_t>(points) * found.dimensions, middle);
    for (std::size_t row = 0; row < responses.rows(); ++row) {
        if (responses.points[row] >= points) continue;
        const auto at = static_cast<std::size_t>(responses.points[row]) * found.dimensions;
        for (std::size_t j = 0; j < found.dimensions; ++j) found.rows[at + j] = responses.factors[j].coordinate(row);
    }
    return found;
}

std::vector<stats::Statistic> gates_of(const campaign::AccuracyGoal& goal) {
    std::vector<stats::Statistic> gates;
    for (const auto& word : goal.gates)
        if (const auto gate = stats::statistic_named(word)) gates.push_back(*gate);
    return gates;
}

store::ConvergenceRow row_of(const stats::TwoLevelCheck& check, const campaign::AccuracyGoal& goal,
                             std::int64_t excluded, bool converged) {
    store::ConvergenceRow row{.observable = goal.observable,
                              .points = check.points,
                              .mean = nan,
                              .sd = nan,
                              .skewness = nan,
                              .g1 = nan,
                              .kurtosis = nan,
                              .mean_error = nan,
                              .sd_error = nan,
                              .skewness_error = nan,
                              .g1_error = nan,
                              .kurtosis_error = nan,
                              .zero_share = nan,
                              .excluded = excluded,
                              .converged = converged};
    for (const auto& moment : check.moments) {
        const bool mean = moment.statistic == stats::Statistic::mean;
        (mean ? row.mean : row.sd) = moment.value;
        (mean ? row.mean_error : row.sd_error) = moment.together;
    }
    return row;
}

std::optional<Corrected> corrected_of(const store::Store& store, const store::CampaignRecord& campaign) {
    auto goal = campaign::remarks_in(campaign.text).goal;
    if (!goal || !goal->setting) return std::nullopt;
    const auto records = store.campaigns();
    const auto name = name_at(campaign.name, campaign::AccuracyGoal::measure);
    const auto measure = std::ranges::find(records, name, &store::CampaignRecord::name);
    Corrected found;
    auto cheap = first_values(store, campaign.name, goal->observable, campaign.asked.candidates).values;
    std::vector<double> expensive;
    auto checks = store.convergence(campaign.name, goal->observable);
    bool paired = *goal->setting != campaign::AccuracyGoal::measure;
    if (paired && measure != records.end()) {
        expensive = first_values(store, name, goal->observable, measure->asked.candidates).values;
        if (auto alone = store.convergence(name, goal->observable); !alone.empty()) {
            paired = false;
            checks = std::move(alone);
            found.before_alone = std::ssize(cheap);
            cheap = std::exchange(expensive, {});
            goal->setting = campaign::AccuracyGoal::measure;
        }
    }
    expensive.resize(std::min(expensive.size(), cheap.size()));
    if (cheap.empty() || (paired && expensive.empty())) return std::nullopt;
    const stats::TwoLevelRule rule{gates_of(*goal), goal->tolerance, campaign.asked.candidates, 1};
    const auto factors = first_factors(store, found.before_alone ? name : campaign.name, std::ssize(cheap));
    const auto sequences = static_cast<std::size_t>(campaign.sequences);
    found.check = stats::two_level_check(rule, {cheap, expensive, sequences, factors.view()});
    found.within =
        std::ranges::any_of(checks, [&](const auto& row) { return row.converged && row.points == found.check.points; });
    found.core_seconds = core_seconds(store, "total", campaigns_of_goal(store, campaign));
    if (paired)
        found.alone = stats::cases_alone(rule, {expensive, {}, sequences, factors.view()}) *
                      core_seconds(store, "avg", fmt::format("'{}'", name));
    else
        found.chosen_alone = measure != records.end();
    found.goal = std::move(*goal);
    return found;
}

}  // namespace grainsweep::study
