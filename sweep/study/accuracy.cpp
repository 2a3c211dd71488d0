#include "sweep/study/accuracy.hpp"

#include "stats/confidence.hpp"
#include "sweep/study/responses.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

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

Bias bias_of(const Values& values, const Values& against) {
    Bias found;
    std::vector<double> differences;
    double sum = 0;
    for (const auto& [point, value] : values) {
        const auto other = against.find(point);
        if (other == against.end()) continue;
        differences.push_back(value - other->second);
        sum += other->second;
    }
    found.pairs = differences.size();
    const auto n = static_cast<double>(differences.size());
    found.mean = found.pairs > 0 ? sum / n : nan;
    double all = 0;
    for (const double x : differences) all += x;
    found.bias = found.pairs > 0 ? all / n : nan;
    double squares = 0;
    for (const double x : differences) squares += (x - found.bias) * (x - found.bias);
    found.scatter = found.pairs > 1 ? std::sqrt(squares / (n - 1)) : nan;
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

}  // namespace grainsweep::study
