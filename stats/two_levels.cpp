#include "stats/two_levels.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainsweep::stats {
namespace {

constexpr double margin = 0.9;  // share of the tolerance that is aimed at, because the half-widths of the next check
                                // scatter
constexpr double no_moment = std::numeric_limits<double>::quiet_NaN();

std::vector<double> squared_from(std::span<const double> values, double centre) {
    std::vector<double> squares;
    for (const double x : values) squares.push_back((x - centre) * (x - centre));
    return squares;
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

/// Half-width^2 n of the two parts of the error.
struct Variances {
    double points = 0, pairs = 0;
};

/// Returns the cheapest sizes at which statistics^2 + numerics^2 = `target`^2, within the points of the design.
Sizes optimal(const Variances& v, double target, const TwoLevelRule& rule) {
    const double squared = target * target, root = std::sqrt(rule.cost_ratio);
    const double mixed = std::sqrt(v.points * v.pairs);
    Sizes sizes{(v.points + mixed * root) / squared, (v.pairs + mixed / root) / squared};
    if (const auto most = static_cast<double>(rule.most); sizes.points > most) {
        const double left = squared - v.points / most;
        sizes = {most, left > 0 ? v.pairs / left : most};
    }
    return {std::max(sizes.points, sizes.pairs), sizes.pairs};
}

/// Returns the sizes that are enough for all gates; NaN if they are unknown for a gate.
Sizes needed(const TwoLevelRule& rule, const TwoLevelCheck& check) {
    Sizes sizes;
    for (const auto& moment : check.moments) {
        const Variances v{moment.statistics * moment.statistics * static_cast<double>(check.points),
                          moment.numerics * moment.numerics * static_cast<double>(check.pairs)};
        const auto best = optimal(v, margin * rule.tolerance * std::abs(moment.value), rule);
        if (std::isnan(best.points) || std::isnan(best.pairs)) return {no_moment, no_moment};
        sizes = {std::max(sizes.points, best.points), std::max(sizes.pairs, best.pairs)};
    }
    return sizes;
}

void propose(const TwoLevelRule& rule, std::int64_t sequences, TwoLevelCheck& check) {
    const auto points = static_cast<double>(check.points), pairs = static_cast<double>(check.pairs);
    const Sizes step{points + std::max(static_cast<double>(sequences), points / 8),
                     pairs + std::max(static_cast<double>(sequences), pairs / 8)};
    const bool known = std::ranges::all_of(
        check.moments, [&](const auto& one) { return one.relative(one.numerics) <= rule.tolerance / 2; });
    auto next = needed(rule, check);
    if (std::isnan(next.points)) {
        next = {2 * points, 2 * pairs};
    } else if (check.passes || (next.points <= points && next.pairs <= pairs)) {
        const bool whole = check.points == rule.most;
        next = {step.points, known && !whole ? pairs : step.pairs};
    } else {
        next = {next.points > points ? std::clamp(next.points, step.points, 2 * points) : points,
                next.pairs > pairs ? std::clamp(next.pairs, step.pairs, 2 * pairs) : pairs};
    }
    check.next_points = whole_sequences(std::max(next.points, next.pairs), sequences, rule.most);
    check.next_pairs = check.pairs == 0 ? 0 : whole_sequences(next.pairs, sequences, check.next_points);
}

/// Returns the cost of the values and pairs that are still to run, in units of a cheap value; infinite if it is
/// unknown.
double further_cost_of_pairs(const TwoLevelRule& rule, const PairedValues& values) {
    TwoLevelCheck check{.points = std::ssize(values.cheap), .pairs = std::ssize(values.expensive), .moments = {}};
    for (const auto gate : rule.gates) {
        auto& moment = check.moments.emplace_back(two_level_moment(gate, values));
        moment.statistics = moment.scatter;
    }
    const auto first = first_sizes(static_cast<std::int64_t>(values.sequences), true);
    const auto sizes = needed(rule, check);
    if (std::isnan(sizes.points)) return std::numeric_limits<double>::infinity();
    const auto missing = [](double wanted, std::int64_t least, std::int64_t present) {
        return std::max({wanted, static_cast<double>(least), static_cast<double>(present)}) -
               static_cast<double>(present);
    };
    return missing(sizes.points, first.points, check.points) +
           missing(sizes.pairs, first.pairs, check.pairs) * rule.cost_ratio;
}

/// Returns the further cost of the expensive response alone, in the same unit; infinite if it is unknown.
double further_cost_alone(const TwoLevelRule& rule, const PairedValues& values) {
    const auto n = static_cast<double>(values.expensive.size());
    const double cases = cases_alone(rule, {values.expensive, {}, values.sequences, values.points});
    return std::isnan(cases) ? std::numeric_limits<double>::infinity() : std::max(0.0, cases - n) * rule.cost_ratio;
}

}  // namespace

double TwoLevelMoment::relative(double half_width) const {
    return half_width / std::abs(value);
}

TwoLevelSizes first_sizes(std::int64_t sequences, bool paired) {
    constexpr std::int64_t points = 8, alone = 4, pairs = 2;
    return paired ? TwoLevelSizes{points * sequences, pairs * sequences} : TwoLevelSizes{alone * sequences, 0};
}

TwoLevelMoment two_level_moment(Statistic statistic, const PairedValues& values) {
    auto mean = corrected_mean(values);
    const auto cheap = summarise(values.cheap);
    TwoLevelMoment moment{statistic,     mean.value,      statistic == Statistic::mean ? cheap.mean : cheap.sd,
                          mean.numerics, mean.statistics, mean.together,
                          mean.scatter,  mean.by};
    if (statistic == Statistic::mean) return moment;
    const auto c = squared_from(values.cheap, cheap.mean), e = squared_from(values.expensive, mean.value);
    const auto variance = corrected_mean({c, e, values.sequences, values.points});
    moment.value = variance.value > 0 ? std::sqrt(variance.value) : no_moment;
    const double factor = 1 / (2 * moment.value);
    moment.numerics = variance.numerics * factor;
    moment.statistics = variance.statistics * factor;
    moment.together = variance.together * factor;
    moment.scatter = variance.scatter * factor;
    moment.by = variance.by;
    return moment;
}

TwoLevelCheck two_level_check(const TwoLevelRule& rule, const PairedValues& values) {
    TwoLevelCheck check;
    check.points = std::ssize(values.cheap);
    check.pairs = std::ssize(values.expensive);
    check.passes = true;
    for (const auto gate : rule.gates) {
        const auto& moment = check.moments.emplace_back(two_level_moment(gate, values));
        check.passes = check.passes && moment.relative(moment.together) < rule.tolerance;
    }
    propose(rule, static_cast<std::int64_t>(values.sequences), check);
    return check;
}

double cases_alone(const TwoLevelRule& rule, const PairedValues& expensive) {
    const auto n = static_cast<double>(expensive.cheap.size());
    auto most = static_cast<double>(first_sizes(static_cast<std::int64_t>(expensive.sequences), false).points);
    for (const auto gate : rule.gates) {
        const auto moment = two_level_moment(gate, expensive);
        const double ratio = moment.relative(moment.scatter) / (margin * rule.tolerance);
        if (std::isnan(ratio)) return no_moment;
        most = std::max(most, n * ratio * ratio);
    }
    return most;
}

bool alone_costs_less(const TwoLevelRule& rule, const PairedValues& values) {
    return further_cost_alone(rule, values) < further_cost_of_pairs(rule, values);
}

std::size_t cheapest_level(const TwoLevelRule& rule, const Pilot& pilot) {
    const auto& measure = pilot.levels.back();
    std::size_t best = pilot.levels.size() - 1;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < pilot.levels.size(); ++k) {
        const auto& level = pilot.levels[k];
        auto here = rule;
        here.cost_ratio = measure.cost / level.cost;
        const PairedValues values{level.values, measure.values, pilot.sequences, pilot.points};
        const double cost = further_cost_of_pairs(here, values) * level.cost;
        if (!(cost < least) || !(cost < further_cost_alone(here, values) * level.cost)) continue;
        least = cost;
        best = k;
    }
    return best;
}

}  // namespace grainsweep::stats
