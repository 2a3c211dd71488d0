// Moments of an expensive response from many values of a cheap one and some pairs, and how many of both to run.
//
//   mean  T of the values (corrected_mean.hpp)
//   sd    sqrt(T2), T2 = T of the squares (e - T)^2 and (c - mean c)^2; half-widths divided by 2 sd
//
// Undefined is what is unknown: a sequence without a pair, R equal repetitions, or pairs that are all equal.
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

    /// One of the half-widths divided by |value|.
    [[nodiscard]] double relative(double half_width) const;
};

/// Returns mean or sd of the expensive response. NaN: undefined.
[[nodiscard]] TwoLevelMoment two_level_moment(Statistic statistic, const PairedValues& values);

/// Points and pairs of the first check: two pairs of each sequence, which the pilot has; eight points, or four where
/// the expensive response runs alone.
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
    /// Sizes of the next check; the present ones where the design has no more.
    std::int64_t next_points = 0, next_pairs = 0;

    [[nodiscard]] bool last() const { return next_points == points && next_pairs == pairs; }
};

/// Judges a pair of sizes and proposes the next. Where a gate is not within the tolerance, the sizes that would bring
/// it there at least cost, n2/n1 = sqrt(V2 c1 / (V1 c2)) with V = half-width^2 n, but at most twice the present ones.
/// Where all are, an eighth more, which may confirm it; no more pairs where half the tolerance holds the numerics.
[[nodiscard]] TwoLevelCheck two_level_check(const TwoLevelRule& rule, const PairedValues& values);

/// A setting at the points of a pilot.
struct PilotLevel {
    std::span<const double> values;
    double cost = 0;  ///< of a value
};
struct Pilot {
    std::vector<PilotLevel> levels;  ///< the last is the measure
    std::size_t sequences = 8;
    Rows points = {};  ///< PairedValues::points
};
/// Returns the setting whose many values, corrected by pairs with the last, are predicted to meet the tolerance of
/// every gate at least cost; the last without pairs. V of the cheap values is from what a trend over the factors
/// leaves, for evenly spread points integrate the trend. What the pilot has run costs nothing more.
[[nodiscard]] std::size_t cheapest_level(const TwoLevelRule& rule, const Pilot& pilot);

/// Returns whether the expensive response alone is predicted to meet the tolerance at less further cost than more
/// values and pairs. The pairs so far count for both.
[[nodiscard]] bool alone_costs_less(const TwoLevelRule& rule, const PairedValues& values);

/// Returns how many values of the expensive response alone would bring every gate within the tolerance, no fewer than
/// the first check has.
[[nodiscard]] double cases_alone(const TwoLevelRule& rule, const PairedValues& expensive);

}  // namespace grainsweep::stats
