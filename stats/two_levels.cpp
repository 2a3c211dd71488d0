#include "stats/two_levels.hpp"

#include "stats/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainsweep::stats {
namespace {

constexpr double no_moment = std::numeric_limits<double>::quiet_NaN();

/// Statistics of one sequence, or of all.
struct Levels {
    Moments cheap, cheap_pairs, expensive_pairs;

    void add(const TwoLevelValues& values, std::size_t p) {
        cheap.add(values.cheap[p]);
        if (p >= values.expensive.size()) return;
        if (!std::isfinite(values.cheap[p]) || !std::isfinite(values.expensive[p])) return;
        cheap_pairs.add(values.cheap[p]);
        expensive_pairs.add(values.expensive[p]);
    }
    [[nodiscard]] double statistic(Statistic which) const {
        return cheap.count() < 2 ? no_moment : cheap.summary().of(which);
    }
    [[nodiscard]] double difference(Statistic which) const {
        if (cheap_pairs.count() < 2) return no_moment;
        return expensive_pairs.summary().of(which) - cheap_pairs.summary().of(which);
    }
};

/// Undefined where all repetitions are equal: then their scatter is unknown.
double half_width_of(std::span<const double> repetitions) {
    const double half_width = student_half_width(repetitions);
    return half_width > 0 ? half_width : no_moment;
}

std::int64_t whole_sequences(double points, std::int64_t sequences, std::int64_t most) {
    const double limit = static_cast<double>(most);
    const double asked = std::isfinite(points) ? std::min(points, limit) : limit;
    const auto rounds = static_cast<std::int64_t>(std::ceil(asked / static_cast<double>(sequences)));
    return std::min(most, rounds * sequences);
}

struct Sizes {
    double points = 0, pairs = 0;
};

/// Sizes at which statistics^2 + numerics^2 is `target`^2 at least cost, with no more points than there are.
Sizes optimal(const TwoLevelMoment& moment, const TwoLevelCheck& now, double target, const TwoLevelRule& rule) {
    const double v1 = moment.statistics * moment.statistics * static_cast<double>(now.points);
    const double v2 = now.pairs == 0 ? 0 : moment.numerics * moment.numerics * static_cast<double>(now.pairs);
    const double squared = target * target, mixed = std::sqrt(v1 * v2), root = std::sqrt(rule.cost_ratio);
    Sizes sizes{(v1 + mixed * root) / squared, (v2 + mixed / root) / squared};
    if (const auto most = static_cast<double>(rule.most); sizes.points > most) {
        const double left = squared - v1 / most;
        sizes = {most, left > 0 ? v2 / left : most};
    }
    return sizes;
}

void propose(const TwoLevelRule& rule, std::int64_t sequences, TwoLevelCheck& check) {
    const auto points = static_cast<double>(check.points), pairs = static_cast<double>(check.pairs);
    const Sizes step{points + std::max(static_cast<double>(sequences), points / 8),
                     pairs + std::max(static_cast<double>(sequences), pairs / 8)};
    Sizes next{0, 0};
    for (const auto& moment : check.moments) {
        constexpr double margin = 0.9;  // the half-widths of the next check scatter, too
        const auto best = optimal(moment, check, margin * rule.tolerance * std::abs(moment.value), rule);
        if (std::isnan(best.points) || std::isnan(best.pairs)) {
            next = {2 * points, 2 * pairs};
            break;
        }
        next = {std::max(next.points, best.points), std::max(next.pairs, best.pairs)};
    }
    next = {std::clamp(next.points, points, 2 * points), std::clamp(next.pairs, pairs, 2 * pairs)};
    if (check.passes || (next.points < step.points && next.pairs < step.pairs)) next = step;
    check.next_points = whole_sequences(next.points, sequences, rule.most);
    check.next_pairs = check.pairs == 0 ? 0 : whole_sequences(next.pairs, sequences, check.next_points);
}

/// The values of the influence function of a statistic at the points that all of `also` have, too.
std::vector<double> influence(Statistic statistic, std::span<const double> values, std::span<const double> also) {
    Moments moments;
    for (std::size_t p = 0; p < values.size(); ++p)
        if (std::isfinite(values[p]) && std::isfinite(also[p])) moments.add(values[p]);
    const auto summary = moments.summary();
    std::vector<double> found;
    for (std::size_t p = 0; p < values.size(); ++p) {
        if (!std::isfinite(values[p]) || !std::isfinite(also[p])) continue;
        const double d = values[p] - summary.mean;
        found.push_back(statistic == Statistic::mean ? d : (d * d - summary.sd * summary.sd) / (2 * summary.sd));
    }
    return found;
}

double mean_square(std::span<const double> values, std::span<const double> less) {
    double sum = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const double d = values[i] - (less.empty() ? 0 : less[i]);
        sum += d * d;
    }
    return values.empty() ? no_moment : sum / static_cast<double>(values.size());
}

/// Cost of a relative half-width of 1, up to a factor that all settings share.
double cost_of_gate(Statistic gate, const PilotLevel& level, const PilotLevel& last, bool alone) {
    const auto expensive = influence(gate, last.values, level.values);
    Moments moments;
    for (std::size_t p = 0; p < last.values.size(); ++p)
        if (std::isfinite(level.values[p])) moments.add(last.values[p]);
    const double value = moments.summary().of(gate);
    if (alone) return mean_square(expensive, {}) * last.cost / (value * value);
    const auto cheap = influence(gate, level.values, last.values);
    const double root =
        std::sqrt(mean_square(cheap, {}) * level.cost) + std::sqrt(mean_square(expensive, cheap) * last.cost);
    return root * root / (value * value);
}

}  // namespace

double TwoLevelMoment::relative(double half_width) const {
    return half_width / std::abs(value);
}

TwoLevelMoment two_level_moment(Statistic statistic, const TwoLevelValues& values) {
    const auto sequences = static_cast<std::size_t>(values.sequences);
    Levels all;
    std::vector<Levels> each(sequences);
    for (std::size_t p = 0; p < values.cheap.size(); ++p) {
        all.add(values, p);
        each[p % sequences].add(values, p);
    }
    std::vector<double> s, d, t;
    const bool corrected = !values.expensive.empty();
    for (const auto& one : each) {
        s.push_back(one.statistic(statistic));
        d.push_back(corrected ? one.difference(statistic) : 0);
        t.push_back(s.back() + d.back());
    }
    TwoLevelMoment moment;
    moment.statistic = statistic;
    moment.cheap = all.statistic(statistic);
    moment.value = moment.cheap + (corrected ? all.difference(statistic) : 0);
    moment.statistics = half_width_of(s);
    moment.numerics = corrected ? half_width_of(d) : 0;
    moment.together = std::max(half_width_of(t), std::hypot(moment.statistics, moment.numerics));
    if (std::isnan(moment.statistics) || std::isnan(moment.numerics)) moment.together = no_moment;
    return moment;
}

TwoLevelCheck two_level_check(const TwoLevelRule& rule, const TwoLevelValues& values) {
    TwoLevelCheck check;
    check.points = std::ssize(values.cheap);
    check.pairs = std::ssize(values.expensive);
    check.passes = true;
    for (const auto gate : rule.gates) {
        const auto& moment = check.moments.emplace_back(two_level_moment(gate, values));
        check.passes = check.passes && moment.relative(moment.together) < rule.tolerance;
    }
    propose(rule, values.sequences, check);
    return check;
}

std::size_t cheapest_level(std::span<const Statistic> gates, std::span<const PilotLevel> levels) {
    std::size_t best = levels.size() - 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = levels.size(); k-- > 0;) {
        const bool alone = k + 1 == levels.size();
        double cost = 0;
        for (const auto gate : gates) {
            const double of_gate = cost_of_gate(gate, levels[k], levels.back(), alone);
            cost = std::isfinite(of_gate) ? std::max(cost, of_gate) : std::numeric_limits<double>::infinity();
        }
        if (!(cost < least)) continue;
        least = cost;
        best = k;
    }
    return best;
}

}  // namespace grainsweep::stats
