#include "stats/convergence.hpp"

#include "stats/confidence.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>

namespace grainsweep::stats {
namespace {

constexpr std::int64_t fewest_values = 4;  // of each sequence, for an error of anything but the mean
constexpr double most_widened = 3;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Returns whether repetitions of a statistic differ by more than rounding; only then can an error be estimated from
/// them. `scale`: a size of which they are sums or differences. False if one of them is undefined.
bool differ(std::span<const double> repetitions, double scale) {
    if (repetitions.empty() || std::ranges::any_of(repetitions, [](double x) { return std::isnan(x); })) return false;
    const auto [low, high] = std::ranges::minmax(repetitions);
    return high - low > 16 * std::numeric_limits<double>::epsilon() * std::max({std::abs(low), std::abs(high), scale});
}

/// Size of which a statistic of values up to `largest` is a sum or difference: a mean or a skewness of 0 is rounded
/// as they are.
double scale_of(Statistic statistic, double largest) {
    if (statistic == Statistic::mean) return largest;
    return statistic == Statistic::sd ? 0 : 1;
}

/// Returns, for each part, the statistics of all values outside of it. Medians are not computed.
std::vector<Summary> without_each(const std::vector<Moments>& parts) {
    std::vector<Moments> after(parts.size() + 1);
    for (std::size_t i = parts.size(); i > 0; --i) {
        after[i - 1] = parts[i - 1];
        after[i - 1].merge(after[i]);
    }
    std::vector<Summary> summaries;
    Moments before;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        Moments others = before;
        others.merge(after[i + 1]);
        summaries.push_back(others.summary());
        before.merge(parts[i]);
    }
    return summaries;
}

/// log(measure) = a + slope log(points) over the checks of the last three quarters, and its value now.
struct Decay {
    double slope = -1;
    double measure_now = 0;
};

Decay fit_decay(std::span<const std::pair<double, double>> history) {
    Decay decay{.slope = -1, .measure_now = history.back().second};
    double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
    const double now = std::log(history.back().first);
    for (const auto& [points, measure] : history) {
        if (4 * points < history.back().first || !(measure > 0)) continue;
        const double x = std::log(points) - now;
        const double y = std::log(measure);
        n += 1;
        sx += x;
        sy += y;
        sxx += x * x;
        sxy += x * y;
    }
    const double spread = n * sxx - sx * sx;
    if (n < 3 || !(spread > 0)) return decay;
    // Random points give -1/2, low-discrepancy points down to -3/2; noise must not promise more or less.
    decay.slope = std::clamp((n * sxy - sx * sy) / spread, -1.5, -0.5);
    decay.measure_now = std::exp((sy - decay.slope * sx) / n);
    return decay;
}

}  // namespace

bool median_is_unsound(double zero_share) {
    return std::abs(zero_share - 0.5) <= 0.05;
}

std::string to_string(const Gate& gate) {
    if (const auto* statistic = std::get_if<Statistic>(&gate)) return std::string(to_string(*statistic));
    return to_string(std::get<Level>(gate));
}

std::optional<Gate> gate_named(std::string_view word) {
    if (const auto statistic = statistic_named(word)) return *statistic;
    if (const auto level = level_named(word)) return *level;
    return std::nullopt;
}

const Estimate& Checkpoint::of(const Gate& gate) const {
    if (const auto* statistic = std::get_if<Statistic>(&gate)) return of(*statistic);
    const auto found = std::ranges::find(levels, std::get<Level>(gate), &std::pair<Level, Estimate>::first);
    if (found == levels.end()) throw std::invalid_argument("no check of " + to_string(gate));
    return found->second;
}

double measure_of(const Gate& gate, double error, double value) {
    if (const auto* level = std::get_if<Level>(&gate))
        return std::holds_alternative<Quantile>(*level) ? error / std::abs(value) : error;
    switch (std::get<Statistic>(gate)) {
        case Statistic::skewness:
            return error / 3;
        case Statistic::g1:
            return error / std::max(1.0, std::abs(value));
        default:
            return error / std::abs(value);
    }
}

void compare_with_tolerance(Checkpoint& now, const ConvergenceSettings& settings) {
    const bool any = settings.traits().one_gate;
    const auto passes = [&](const Gate& gate) { return now.of(gate).measure < settings.tolerance; };
    now.passes = any ? std::ranges::any_of(settings.gates, passes) : std::ranges::all_of(settings.gates, passes);
    if (now.passes) return;
    // Where one gate is enough the nearest decides.
    const auto distance = [&](const Gate& gate) {
        const double measure = now.of(gate).measure;
        return std::isnan(measure) ? std::numeric_limits<double>::infinity() : measure;
    };
    now.held_back = any ? *std::ranges::min_element(settings.gates, {}, distance)
                        : *std::ranges::max_element(settings.gates, {}, distance);
}

double points_for_tolerance(const ConvergenceSettings& settings, std::span<const Checkpoint> before,
                            const Checkpoint& now) {
    const bool any = settings.traits().one_gate;
    double needed = any ? std::numeric_limits<double>::infinity() : 0;
    for (const Gate& gate : settings.gates) {
        std::vector<std::pair<double, double>> history;
        for (const auto& check : before) history.emplace_back(check.points, check.of(gate).measure);
        history.emplace_back(now.points, now.of(gate).measure);
        if (std::isnan(history.back().second)) {
            if (any) continue;
            return std::numeric_limits<double>::infinity();
        }
        if (history.back().second < settings.tolerance) continue;
        const Decay decay = fit_decay(history);
        const double growth = std::pow(settings.tolerance / decay.measure_now, 1 / decay.slope);
        const double points = static_cast<double>(now.points) * growth;
        needed = any ? std::min(needed, points) : std::max(needed, points);
    }
    constexpr double most = 1e15;
    return needed < most ? needed : std::numeric_limits<double>::infinity();
}

Middle SortedSample::middle() {
    std::ranges::sort(fresh_);
    const auto old = static_cast<std::ptrdiff_t>(sorted_.size());
    sorted_.insert(sorted_.end(), fresh_.begin(), fresh_.end());
    std::inplace_merge(sorted_.begin(), sorted_.begin() + old, sorted_.end());
    fresh_.clear();
    if (sorted_.empty()) return {};
    return {sorted_[(sorted_.size() - 1) / 2], sorted_[sorted_.size() / 2]};
}

double SortedSample::carriers(double centre, double p) const {
    if (sorted_.empty()) return 0;
    const double farthest = std::max(std::abs(sorted_.front() - centre), std::abs(sorted_.back() - centre));
    double sum = 0, squares = 0;
    for (const double value : sorted_) {
        const double one = std::pow(std::abs(value - centre) / farthest, p);
        sum += one;
        squares += one * one;
    }
    return sum * sum / squares;
}

Convergence::Convergence(ConvergenceSettings settings) : settings_(std::move(settings)) {
    if (settings_.traits().of_model)
        throw std::invalid_argument("the rule 'assisted' is judged with a model of the response");
    if (settings_.traits().of_sequences && settings_.sequences < fewest_sequences)
        throw std::invalid_argument("the rule 'replicates' needs at least 4 random sequences, not " +
                                    std::to_string(settings_.sequences));
    if (settings_.gates.empty()) throw std::invalid_argument("convergence needs at least one gate");
    if (settings_.block < 1) throw std::invalid_argument("a block has at least 1 point");
    if (!(settings_.tolerance > 0)) throw std::invalid_argument("the tolerance is a positive number");
    if (settings_.sequences >= fewest_sequences) sequences_.resize(static_cast<std::size_t>(settings_.sequences));
}

void Convergence::add(std::int64_t point, double value, std::int64_t earlier) {
    settle(point);
    pooled_.moments.add(value);
    const bool finite = std::isfinite(value);
    if (finite) {
        ++places_;
        if (earlier == 0) ++runs_;
        excess_ += 2 * static_cast<double>(earlier);
    }
    if (finite) pooled_.sample.add(value);
    if (sequences_.empty()) {
        if (!finite) return;
        stretches_.add(value);
        pooled_.values.push_back(value);
        return;
    }
    auto& sequence = sequences_[static_cast<std::size_t>(point % settings_.sequences)];
    sequence.moments.add(value);
    if (!finite) return;
    sequence.sample.add(value);
    sequence.values.push_back(value);
}

void Convergence::settle(std::int64_t points) {
    while (static_cast<std::int64_t>(checkpoints_.size() + 1) * settings_.block <= points) check();
}

const Checkpoint* Convergence::converged() const {
    const auto found = std::ranges::find(checkpoints_, true, &Checkpoint::converged);
    return found == checkpoints_.end() ? nullptr : &*found;
}

void Convergence::check() {
    Checkpoint now;
    now.points = static_cast<std::int64_t>(checkpoints_.size() + 1) * settings_.block;
    const Summary summary = pooled_.moments.summary(pooled_.sample.middle());
    now.count = summary.count;
    now.excluded = summary.excluded;
    now.runs = runs_;
    now.fresh = now.runs - (checkpoints_.empty() ? 0 : checkpoints_.back().runs);
    now.all_equal = now.count > 0 && summary.minimum == summary.maximum;
    now.zero_share = summary.zero_share;
    for (std::size_t s = 0; s < statistics.size(); ++s) now.estimates[s].value = summary.of(statistics[s]);
    find_errors(now);
    widen_errors(now);
    find_levels(now);
    find_measures(now);
    judge(now);
    checkpoints_.push_back(now);
}

void Convergence::find_errors(Checkpoint& now) {
    std::vector<Summary> summaries;
    for (auto& sequence : sequences_) summaries.push_back(sequence.moments.summary(sequence.sample.middle()));
    if (sequences_.empty() && stretches_.size() >= 2 * StretchedSample::batches) {
        const auto parts = stretches_.leave_one_out();
        summaries.assign(parts.begin(), parts.end());
    }
    // With fewer values, spread and shape depend almost only on their number (the kurtosis of two values is 1), and
    // give no error.
    const bool too_few =
        !sequences_.empty() && std::ranges::any_of(summaries, [](const Summary& x) { return x.count < fewest_values; });
    std::vector<double> repetitions(summaries.size());
    const auto sorted = pooled_.sample.sorted();
    const double largest = sorted.empty() ? 0 : std::max(std::abs(sorted.front()), std::abs(sorted.back()));
    for (std::size_t s = 0; s < statistics.size(); ++s) {
        if (now.all_equal || (too_few && statistics[s] != Statistic::mean)) continue;
        std::ranges::transform(summaries, repetitions.begin(), [&](const Summary& x) { return x.of(statistics[s]); });
        if (!differ(repetitions, scale_of(statistics[s], largest))) continue;
        now.estimates[s].error =
            sequences_.empty() ? jackknife_half_width(repetitions) : student_half_width(repetitions);
    }
    doubt_agreement(now);
    const auto tails = tails_of(pooled_.sample.sorted(), std::max<std::size_t>(1, sequences_.size()));
    judge_shape(now, summaries, !tails.empty());
    doubt_tails(now, tails);
}

void Convergence::find_levels(Checkpoint& now) const {
    GroupedSample sample{.sorted = pooled_.sample.sorted(),
                         .groups = {},
                         .independent = !sequences_.empty(),
                         .repeated = std::sqrt(excess_) / static_cast<double>(places_)};
    for (const auto& sequence : sequences_) sample.groups.emplace_back(sequence.values);
    if (sequences_.empty()) sample.groups = batches_of(pooled_.values);
    for (const Gate& gate : settings_.gates) {
        const auto* level = std::get_if<Level>(&gate);
        if (level == nullptr) continue;
        const auto found = level_of(*level, sample);
        now.levels.emplace_back(*level, Estimate{.value = found.value, .error = now.all_equal ? nan : found.error});
    }
}

void Convergence::doubt_tails(Checkpoint& now, std::span<const Tail> tails) {
    const auto of = [&](Statistic statistic) { return now.of(statistic).value; };
    const double mean = of(Statistic::mean), sd = of(Statistic::sd);
    constexpr double infinite = std::numeric_limits<double>::infinity();
    const auto widen = [&](Statistic statistic, double at_most, const auto& influence) {
        double variance = 0;
        for (const Tail& tail : tails)
            variance += tail.variance_of_mean([&](double y) { return influence((y - mean) / sd); });
        double& error = now.estimates[static_cast<std::size_t>(statistic)].error;
        error = std::max(error, std::min(tail_95 * std::sqrt(variance), at_most * error));
    };
    widen(Statistic::mean, most_widened, [&](double z) { return sd * z; });
    widen(Statistic::sd, most_widened, [&](double z) { return sd * z * z / 2; });
    widen(Statistic::skewness, infinite, [&](double z) { return 3 * z - of(Statistic::skewness) * z * z / 2; });
    widen(Statistic::g1, infinite, [&](double z) { return z * z * z - 1.5 * of(Statistic::g1) * z * z - 3 * z; });
    widen(Statistic::kurtosis, infinite,
          [&](double z) { return z * z * (z * z - 2 * of(Statistic::kurtosis)) - 4 * of(Statistic::g1) * z; });
}

void Convergence::doubt_agreement(Checkpoint& now) const {
    double fall = 1;
    for (std::size_t halved = 1; halved <= most_halvings; ++halved) {
        fall *= steepest_fall;
        std::vector<Summary> halves;
        for (const auto& sequence : sequences_) {
            halves.push_back(summarise(std::span(sequence.values).first(sequence.values.size() >> halved)));
        }
        if (std::ranges::any_of(halves, [](const Summary& x) { return x.count < fewest_values; })) return;
        std::vector<double> repetitions(halves.size());
        for (const Statistic statistic : statistics) {
            double& error = now.estimates[static_cast<std::size_t>(statistic)].error;
            std::ranges::transform(halves, repetitions.begin(), [&](const Summary& x) { return x.of(statistic); });
            if (differ(repetitions, scale_of(statistic, 0)))
                error = std::max(error, fall * student_half_width(repetitions));
        }
    }
}

void Convergence::judge_shape(Checkpoint& now, std::span<const Summary> repetitions, bool endless) const {
    std::vector<Summary> without;
    if (!sequences_.empty()) {
        std::vector<Moments> parts;
        for (const auto& sequence : sequences_) parts.push_back(sequence.moments);
        without = without_each(parts);
    }
    for (const Statistic statistic : {Statistic::g1, Statistic::kurtosis}) {
        Estimate& estimate = now.estimates[static_cast<std::size_t>(statistic)];
        if (std::isnan(estimate.error)) continue;
        if (!without.empty()) {
            std::vector<double> jackknifed;
            double mean = 0;
            for (std::size_t i = 0; i < without.size(); ++i) {
                jackknifed.push_back(without[i].of(statistic));
                mean += repetitions[i].of(statistic) / static_cast<double>(without.size());
            }
            estimate.error =
                std::hypot(std::max(estimate.error, jackknife_half_width(jackknifed)), estimate.value - mean);
        }
        // Places that hold the same run are one value.
        const double carriers =
            pooled_.sample.carriers(now.of(Statistic::mean).value, statistic == Statistic::g1 ? 3 : 4) *
            static_cast<double>(runs_) / static_cast<double>(places_);
        const double needed = statistic == Statistic::g1 ? (endless ? 60 : 30) : (endless ? 200 : 50);
        if (carriers >= needed) continue;
        estimate.carriers = {carriers, needed};
        estimate.error = nan;
    }
}

void Convergence::widen_errors(Checkpoint& now) const {
    if (!(excess_ > 0)) return;
    const double kurtosis = now.of(Statistic::kurtosis).value;
    const double sd = now.of(Statistic::sd).value;
    const auto of_one_run = [&](Statistic statistic) {
        switch (statistic) {
            case Statistic::mean:
                return sd;
            case Statistic::sd:
                return sd * std::sqrt((kurtosis - 1) / 4);
            case Statistic::skewness:
                return 3 * std::sqrt(std::numbers::pi / 2 - 1);
            case Statistic::g1:
                return std::sqrt(6.0);
            case Statistic::kurtosis:
                return std::sqrt(24.0);
        }
        return nan;
    };
    const double share = std::sqrt(excess_) / static_cast<double>(places_);
    for (const Statistic statistic : statistics) {
        double& error = now.estimates[static_cast<std::size_t>(statistic)].error;
        error = std::hypot(error, normal_95 * share * of_one_run(statistic));
    }
}

void Convergence::find_measures(Checkpoint& now) const {
    const auto judge_one = [&](const Gate& gate, Estimate& estimate) {
        double error = estimate.error;
        if (!settings_.traits().of_sequences)
            error = checkpoints_.empty() ? nan : std::abs(estimate.value - checkpoints_.back().of(gate).value);
        const bool unsound = gate == Gate{Statistic::skewness} && median_is_unsound(now.zero_share);
        const bool unknown = now.all_equal || now.fresh == 0 || unsound;
        estimate.measure = unknown ? nan : measure_of(gate, error, estimate.value);
    };
    for (const Statistic statistic : statistics)
        judge_one(statistic, now.estimates[static_cast<std::size_t>(statistic)]);
    for (auto& [level, estimate] : now.levels) judge_one(level, estimate);
}

void Convergence::judge(Checkpoint& now) const {
    compare_with_tolerance(now, settings_);
    now.converged = now.passes;
    if (settings_.traits().of_sequences)
        now.converged = now.passes && !checkpoints_.empty() && checkpoints_.back().passes;
    now.points_needed = predict(now);
}

std::optional<std::int64_t> Convergence::predict(const Checkpoint& now) const {
    if (now.converged) return now.points;
    const std::int64_t block = settings_.block;
    const double needed = points_for_tolerance(settings_, checkpoints_, now);
    if (std::isinf(needed)) return std::nullopt;
    // The first check not yet made that reaches `needed`; `replicates` wants the one after it, too.
    const auto reached = static_cast<std::int64_t>(std::ceil(needed / static_cast<double>(block))) * block;
    const std::int64_t first = now.passes ? now.points : std::max(reached, now.points + block);
    return settings_.traits().of_sequences ? first + block : first;
}

std::vector<Checkpoint> judge_convergence(const ConvergenceSettings& settings, std::span<const std::int64_t> points,
                                          std::span<const double> values, std::int64_t settled,
                                          std::span<const std::int64_t> earlier) {
    assert(points.size() == values.size() && (earlier.empty() || earlier.size() == values.size()));
    Convergence convergence(settings);
    for (std::size_t i = 0; i < values.size() && points[i] < settled; ++i)
        convergence.add(points[i], values[i], earlier.empty() ? 0 : earlier[i]);
    convergence.settle(settled);
    return {convergence.checkpoints().begin(), convergence.checkpoints().end()};
}

}  // namespace grainsweep::stats
