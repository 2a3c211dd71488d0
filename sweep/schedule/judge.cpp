#include "sweep/schedule/judge.hpp"

#include "stats/confidence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace grainsweep::schedule {
namespace {

std::string percent(double share) {
    return share < 1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

/// Returns the name of the measure that the rule compares: "kurtosis" or "change of kurtosis".
std::string measure_name(const stats::Gate& gate, const stats::ConvergenceSettings& settings) {
    auto name = stats::to_string(gate);
    return settings.traits().of_sequences ? name : fmt::format("change of {}", name);
}

std::string points_left(const stats::Checkpoint& check, std::int64_t candidates) {
    if (!check.points_needed) return "";
    const std::int64_t more = *check.points_needed - check.points;
    const auto text = fmt::format(", about {} more point{}", more, more == 1 ? "" : "s");
    return *check.points_needed > candidates ? fmt::format("{} (the design has {})", text, candidates) : text;
}

}  // namespace

std::size_t independent_sequences(std::string_view design, std::size_t sequences) {
    const auto* info = designs::find_design(design);
    return info != nullptr && info->independent_sequences ? sequences : 1;
}

stats::ConvergenceSettings settings_of(const campaign::Convergence& wanted, std::size_t sequences) {
    stats::ConvergenceSettings settings;
    settings.rule = wanted.traits().rule;
    settings.gates.clear();
    for (const auto& word : wanted.gates) {
        const auto gate = stats::gate_named(word);
        if (!gate) throw std::invalid_argument("no statistic is called '" + word + "'");
        settings.gates.push_back(*gate);
    }
    settings.tolerance = wanted.tolerance;
    settings.block = wanted.block;
    settings.sequences = static_cast<std::int64_t>(sequences);
    return settings;
}

store::ConvergenceRow row_of(const stats::Checkpoint& check, std::string_view observable) {
    using stats::Statistic;
    return {.observable = std::string(observable),
            .points = check.points,
            .mean = check.of(Statistic::mean).value,
            .sd = check.of(Statistic::sd).value,
            .skewness = check.of(Statistic::skewness).value,
            .g1 = check.of(Statistic::g1).value,
            .kurtosis = check.of(Statistic::kurtosis).value,
            .mean_error = check.of(Statistic::mean).error,
            .sd_error = check.of(Statistic::sd).error,
            .skewness_error = check.of(Statistic::skewness).error,
            .g1_error = check.of(Statistic::g1).error,
            .kurtosis_error = check.of(Statistic::kurtosis).error,
            .zero_share = check.zero_share,
            .excluded = check.excluded,
            .converged = check.converged};
}

std::string verdict_of(const stats::Checkpoint& check, const stats::ConvergenceSettings& settings,
                       std::int64_t candidates) {
    if (check.converged) {
        std::string text;
        for (const auto& gate : settings.gates) {
            const double measure = check.of(gate).measure;
            if (!(measure < settings.tolerance)) continue;  // under any_change one is enough
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", measure_name(gate, settings), percent(measure));
        }
        text = fmt::format("{} < {}", text, percent(settings.tolerance));
        if (settings.traits().of_model && check.excluded > 0)
            text += fmt::format(", of the whole box, extrapolated into the settings of {} cases without a value",
                                check.excluded);
        return text;
    }
    if (settings.traits().of_model && std::isnan(check.of(settings.gates.front()).measure))
        return fmt::format("nothing is decided at {} points: {}", check.points,
                           check.remark.empty() ? "the model of the response was refused" : check.remark);
    if (check.passes || !check.held_back) {
        return fmt::format("every gate within {} for the first time, the next check may confirm it{}",
                           percent(settings.tolerance), points_left(check, candidates));
    }
    const double measure = check.of(*check.held_back).measure;
    if (!std::isnan(measure)) {
        return fmt::format("{} {} > {}{}{}", measure_name(*check.held_back, settings), percent(measure),
                           percent(settings.tolerance), points_left(check, candidates),
                           check.remark.empty() ? "" : "; " + check.remark);
    }
    const bool first_of_changes = !settings.traits().of_sequences && check.points <= settings.block;
    if (first_of_changes) return fmt::format("{} points, nothing to compare with yet", check.points);
    if (check.all_equal)
        return fmt::format(
            "all values are equal after {} points ({} values): their scatter is unknown, and up to {} of "
            "the box may have other values",
            check.points, check.count, percent(stats::largest_unseen_share(check.runs)));
    if (check.count == 0) return fmt::format("none of {} points has a value", check.points);
    if (check.fresh == 0)
        return fmt::format("no new value since the check before {} points: the {} different cases are known",
                           check.points, check.count);
    if (*check.held_back == stats::Gate{stats::Statistic::skewness} && stats::median_is_unsound(check.zero_share)) {
        return fmt::format("skewness cannot be judged: {} of the values are zero, so the median jumps",
                           percent(check.zero_share));
    }
    if (const auto carriers = check.of(*check.held_back).carriers)
        return fmt::format("{} has no error yet: it rests on {:.0f} of the {} values at {} points, {:.0f} are needed",
                           stats::to_string(*check.held_back), carriers->count, check.count, check.points,
                           carriers->needed);
    return fmt::format("{} is undefined after {} points ({} values)", measure_name(*check.held_back, settings),
                       check.points, check.count);
}

Judge::Judge(const campaign::Convergence& wanted, campaign::Cases placed, std::size_t sequences,
             std::vector<double> known, std::optional<std::int64_t> candidates, std::optional<ModelView> view,
             bool repeats_weigh)
    : wanted_(wanted),
      settings_(settings_of(wanted, sequences)),
      candidates_(placed.empty() ? 0 : std::int64_t{placed.place(placed.size() - 1).point} + 1),
      placed_(std::move(placed)),
      values_(std::move(known)) {
    assert(values_.size() == placed_.size());
    if (candidates) candidates_ = std::max(candidates_, *candidates);
    if (repeats_weigh) met_.resize(placed_.size());
    std::int64_t first = wanted.block;
    if (settings_.traits().of_model) {
        if (!view) throw std::invalid_argument("a rule with a model needs what the model sees of a case");
        assisted_ = std::make_unique<AssistedJudge>(settings_, std::move(*view), placed_, wanted.stop);
        first = assisted_->first_check();
    } else {
        plain_ = std::make_unique<stats::Convergence>(settings_);
    }
    verdict_ = fmt::format("first check of {} at {} points", wanted.observable, first);
}

void Judge::learn(const campaign::CaseId& id, const Observations& observations) {
    auto place = placed_.find(campaign::hash_of(id));
    if (!place) return;
    const auto scalar = observations.scalars.find(wanted_.observable);
    const double value =
        scalar == observations.scalars.end() ? std::numeric_limits<double>::quiet_NaN() : scalar->second;
    for (; place; place = placed_.next(*place)) values_[*place] = value;
}

std::optional<std::int64_t> Judge::converged_at() const {
    const auto* check = plain_ ? plain_->converged() : assisted_->converged();
    return check == nullptr ? std::nullopt : std::optional(check->points);
}

std::optional<double> Judge::expected_share() const {
    if (!stops() || checkpoints().empty() || candidates_ == 0) return std::nullopt;
    const auto& last = checkpoints().back();
    const auto points = converged_at() ? converged_at() : last.points_needed;
    if (!points) return std::nullopt;
    return std::min(1.0, static_cast<double>(*points) / static_cast<double>(candidates_));
}

bool Judge::overturns(std::int64_t stop) const {
    return !converged_at() && !checkpoints().empty() && checkpoints().back().points >= stop;
}

std::span<const stats::Checkpoint> Judge::checkpoints() const {
    return plain_ ? plain_->checkpoints() : assisted_->checkpoints();
}

void Judge::feed(std::size_t settled) {
    for (; fed_ < settled; ++fed_) {
        if (met_.empty() && !placed_.is_first(fed_)) continue;  // the same run again says nothing new
        if (plain_)
            plain_->add(placed_.place(fed_).point, values_[fed_], met_.empty() ? 0 : met_[placed_.first(fed_)]++);
        else
            assisted_->add(fed_, values_[fed_]);
    }
    if (fed_ != settled) return;
    const std::int64_t points = settled == placed_.size() ? candidates_ : std::int64_t{placed_.place(settled).point};
    if (plain_)
        plain_->settle(points);
    else
        assisted_->settle(points);
}

std::vector<store::ConvergenceRow> Judge::judge(std::size_t settled, Models models) {
    assert(settled <= placed_.size());
    if (!(stops() && converged_at())) feed(settled);
    if (assisted_) assisted_->advance(models == Models::awaited);

    std::vector<store::ConvergenceRow> rows;
    const auto checks = checkpoints();
    while (judged_ < checks.size()) {
        const auto& check = checks[judged_++];
        rows.push_back(row_of(check, wanted_.observable));
        verdict_ = verdict_of(check, settings_, candidates_);
        if (stops() && check.converged) judged_ = checks.size();
    }
    return rows;
}

}  // namespace grainsweep::schedule
