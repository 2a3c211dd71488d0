// Moments of an expensive response from many values of a cheap one and some pairs, and how many of both to run.
//
//   mean  T of the values (corrected_mean.hpp)
//   sd    sqrt(T2), T2 = T of the squares (e - T)^2 and (c - mean c)^2; half-widths divided by 2 sd
//
// A value is undefined if it is unknown: with a sequence without a pair, with R equal repetitions, or if both values
// are equal in every pair.
#pragma once

#include "stats/corrected_mean.hpp"
#include "stats/moments.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::stats {

struct TwoLevelMoment {
    Statistic statistic = Statistic::mean;
    double value = 0;  ///< corrected
    double cheap = 0;  ///< of the cheap values alone
    double numerics = 0, statistics = 0, together = 0;
    double scatter = 0;  ///< CorrectedMean::scatter
    PairPredictor by = PairPredictor::none;

    /// Returns one of the half-widths divided by |value|.
    [[nodiscard]] double relative(double half_width) const;
};

/// Returns mean or sd of the expensive response. NaN: undefined.
[[nodiscard]] TwoLevelMoment two_level_moment(Statistic statistic, const PairedValues& values);

/// Numbers of points and pairs. At the first check each sequence has two pairs (those of the pilot) and eight points,
/// or four points if the expensive response runs alone.
struct TwoLevelSizes {
    std::int64_t points = 0, pairs = 0;
};
[[nodiscard]] TwoLevelSizes first_sizes(std::int64_t sequences, bool paired);

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
    /// Sizes of the next check; equal to the present ones if the design has no more points.
    std::int64_t next_points = 0, next_pairs = 0;

    [[nodiscard]] bool last() const { return next_points == points && next_pairs == pairs; }
};

/// Judges the present sizes and proposes the next ones. If a gate is not within the tolerance, these are the cheapest
/// sizes that would be enough: n2/n1 = sqrt(V2 c1 / (V1 c2)) with V = half-width^2 n, but at most twice the present
/// ones. If all gates are within it, the sizes grow by an eighth to confirm this. The number of pairs then stays the
/// same if the half-width of the numerics is at most half the tolerance.
[[nodiscard]] TwoLevelCheck two_level_check(const TwoLevelRule& rule, const PairedValues& values);

/// Values and cost of one setting at the points of a pilot.
struct PilotLevel {
    std::span<const double> values;
    double cost = 0;  ///< cost of one value
};
struct Pilot {
    std::vector<PilotLevel> levels;  ///< the last one is the standard
    std::size_t sequences = 8;
    Rows points = {};  ///< PairedValues::points
};
/// Returns the setting that is predicted to meet the tolerance of every gate at least cost, with many values and pairs
/// with the last setting. Returns the last setting if it alone is cheaper. V of the cheap values is computed from their
/// scatter about a trend over the factors, because evenly spread points integrate the trend. Runs of the pilot add no
/// cost.
[[nodiscard]] std::size_t cheapest_level(const TwoLevelRule& rule, const Pilot& pilot);

/// Returns whether the expensive response alone is predicted to meet the tolerance at less further cost than more
/// values and pairs. Expensive values of the present pairs count for both.
[[nodiscard]] bool alone_costs_less(const TwoLevelRule& rule, const PairedValues& values);

/// Returns the number of values of the expensive response alone that would bring every gate within the tolerance; at
/// least the number at the first check. NaN: unknown.
[[nodiscard]] double cases_alone(const TwoLevelRule& rule, const PairedValues& expensive);

}  // namespace grainsweep::stats
