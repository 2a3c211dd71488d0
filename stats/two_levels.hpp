// Moments of an expensive response from many values of a cheap one and some pairs: two-level Monte Carlo (Giles 2015,
// Acta Numerica 24, 259) over independently randomised sequences.
//
//   T = S + D,   S = statistic of the cheap values at points 0 ... n1 - 1
//                D = statistic of the expensive values - statistic of the cheap ones, both at points 0 ... n2 - 1
//
// T estimates the statistic of the expensive response, whatever the bias of the cheap one is. Point p belongs to
// sequence p mod R. Each sequence gives S_r, D_r and T_r = S_r + D_r; half-widths are Student's t over the R of them:
//   statistics  of S      numerics  of D      together  of T, not below sqrt(statistics^2 + numerics^2)
// The second bound guards a rule that stops early: one of R = 8 variances alone is often too small by chance.
// Undefined is what is unknown: fewer than 2 values in a sequence, or R equal repetitions.
#pragma once

#include "stats/moments.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::stats {

/// Values by point, NaN where there is none. `expensive` is a beginning; empty: the cheap response is the one wanted.
struct TwoLevelValues {
    std::span<const double> cheap, expensive;
    std::int64_t sequences = 8;
};

struct TwoLevelMoment {
    Statistic statistic = Statistic::mean;
    double value = 0;  ///< T
    double cheap = 0;  ///< S
    double numerics = 0, statistics = 0, together = 0;

    /// One of the three divided by |T|.
    [[nodiscard]] double relative(double half_width) const;
};

/// Returns mean or sd of the expensive response. NaN: undefined.
[[nodiscard]] TwoLevelMoment two_level_moment(Statistic statistic, const TwoLevelValues& values);

struct TwoLevelRule {
    std::vector<Statistic> gates = {Statistic::mean, Statistic::sd};
    double tolerance = 0.01;  ///< of `together`, relative
    std::int64_t most = 0;    ///< points of the design
    double cost_ratio = 1;    ///< cost of an expensive value / cost of a cheap one
};

struct TwoLevelCheck {
    std::int64_t points = 0, pairs = 0;
    std::vector<TwoLevelMoment> moments;  ///< of the gates
    bool passes = false;                  ///< every gate is within the tolerance
    /// Sizes of the next check; the present ones where the design has no more.
    std::int64_t next_points = 0, next_pairs = 0;

    [[nodiscard]] bool last() const { return next_points == points && next_pairs == pairs; }
};

/// Judges a pair of sizes and proposes the next. Where a gate is not within the tolerance, the sizes that would bring
/// it there at least cost, n2/n1 = sqrt(V2 c1 / (V1 c2)) with V = half-width^2 n, but at most twice the present ones;
/// where all are, an eighth more, which may confirm it.
[[nodiscard]] TwoLevelCheck two_level_check(const TwoLevelRule& rule, const TwoLevelValues& values);

/// A setting at the points of a pilot.
struct PilotLevel {
    std::span<const double> values;
    double cost = 0;  ///< of a value
};
/// Returns the setting whose many values, corrected by pairs with the last, meet a tolerance of every gate at least
/// cost: (sqrt(V1 c1) + sqrt(V2 c2))^2, with the variances of the influence functions y and ((y - m)^2 - s^2)/(2 s) and
/// of their differences; the last alone costs V c. All are as for independent points.
[[nodiscard]] std::size_t cheapest_level(std::span<const Statistic> gates, std::span<const PilotLevel> levels);

}  // namespace grainsweep::stats
