#include "stats/assisted_convergence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>

namespace grainsweep::stats {
namespace {

Estimate& at(Checkpoint& check, Statistic statistic) {
    return check.estimates[static_cast<std::size_t>(statistic)];
}

/// The rule of plain estimates with the same gates.
ConvergenceSettings plain(ConvergenceSettings settings) {
    settings.rule = ConvergenceRule::replicates;
    return settings;
}

}  // namespace

AssistedConvergence::AssistedConvergence(ConvergenceSettings settings, ModelSpace space)
    : settings_(std::move(settings)), space_(std::move(space)) {
    if (!settings_.traits().of_model) throw std::invalid_argument("the rule is not 'assisted'");
    if (settings_.sequences < fewest_sequences)
        throw std::invalid_argument("the rule 'assisted' needs at least 4 random sequences, not " +
                                    std::to_string(settings_.sequences));
    if (std::ranges::find(settings_.gates, Gate{Statistic::skewness}) != settings_.gates.end())
        throw std::invalid_argument("Pearson's skewness has no model-assisted estimate");
    if (std::ranges::any_of(settings_.gates, [](const Gate& g) { return std::holds_alternative<Level>(g); }))
        throw std::invalid_argument("a quantile or probability has no model-assisted gate");
    if (space_.dimensions == 0) throw std::invalid_argument("a model of the response needs a feature");
    (void)Convergence(plain(settings_));  // the other settings
}

std::int64_t AssistedConvergence::next_check() const {
    return next_check(checkpoints_.empty() ? 0 : checkpoints_.back().points);
}

std::int64_t AssistedConvergence::next_check(std::int64_t after) const {
    const auto of_models = static_cast<std::int64_t>(8 * (space_.dimensions + 1));
    const std::int64_t least = after == 0 ? std::max(fewest_assisted_points, of_models)
                                          : after + std::max<std::int64_t>(1, after / assisted_growth);
    return (least + settings_.block - 1) / settings_.block * settings_.block;
}

void AssistedConvergence::check(std::span<const std::int64_t> points, std::span<const double> values,
                                std::span<const double> features) {
    ConvergenceSettings once = plain(settings_);
    once.block = next_check();
    Checkpoint now = judge_convergence(once, points, values, once.block).front();
    now.passes = false;
    now.held_back.reset();
    take_estimates(now, points, values, features);
    compare_with_tolerance(now, settings_);
    now.converged = now.passes && !checkpoints_.empty() && checkpoints_.back().passes;
    now.points_needed.reset();
    const double needed = points_for_tolerance(settings_, checkpoints_, now);
    if (now.converged) {
        now.points_needed = now.points;
    } else if (std::isfinite(needed)) {
        std::int64_t first = now.passes ? now.points : next_check(now.points);
        while (static_cast<double>(first) < needed) first = next_check(first);
        now.points_needed = next_check(first);
    }
    checkpoints_.push_back(std::move(now));
}

void AssistedConvergence::take_estimates(Checkpoint& now, std::span<const std::int64_t> points,
                                         std::span<const double> values, std::span<const double> features) {
    std::vector<std::size_t> sequences;
    sequences.reserve(points.size());
    for (const std::int64_t point : points) sequences.push_back(static_cast<std::size_t>(point % settings_.sequences));
    AssistedSettings settings;
    settings.low = space_.low;
    settings.high = space_.high;
    auto answer = assisted_moments(
        {{features, space_.dimensions}, values, sequences, {space_.integration, space_.dimensions}, space_.scramblings},
        settings, before_ ? &*before_ : nullptr);
    const auto* moments = std::get_if<AssistedMoments>(&answer);
    now.remark = moments == nullptr ? std::get<Refusal>(answer).sentence : moments->remark;
    for (const Statistic statistic : assisted_statistics) {
        Estimate& estimate = at(now, statistic);
        if (moments == nullptr) {
            estimate.error = estimate.measure = std::numeric_limits<double>::quiet_NaN();
            continue;
        }
        const AssistedStatistic& both = moments->of(statistic);
        if (both.takes_assisted) estimate.carriers.reset();
        estimate.value = both.chosen().value;
        estimate.error = estimate.carriers ? std::numeric_limits<double>::quiet_NaN() : both.chosen().half_width;
        estimate.measure = measure_of(statistic, estimate.error, estimate.value);
    }
    before_ = moments == nullptr ? std::nullopt : std::optional(*moments);
}

const Checkpoint* AssistedConvergence::converged() const {
    const auto found = std::ranges::find(checkpoints_, true, &Checkpoint::converged);
    return found == checkpoints_.end() ? nullptr : &*found;
}

}  // namespace grainsweep::stats
