// Errors of the statistics of a response along a design, and the verdict whether they have converged.
//
// The values of a design are added in the order of its points. A check at every multiple of `block` points computes the
// statistics of all points so far, with their errors. For each gated statistic a measure is compared with the
// tolerance:
//   mean, sd, kurtosis, a quantile   e/|value|        g1   e/max(1, |g1|)        skewness (Pearson's)   e/3, 3 being
//   its bound        a probability   e
// The rules differ in the error e and in the condition of convergence:
//   replicates  e = Student-t 95 % half-width over the R values of R independently randomised sequences (point p
//               belongs to sequence p mod R); every gate below the tolerance at two consecutive checks.
//   any_change  e = change since the check before; any one gate below the tolerance. It stops too early in about half
//               of all sweeps.
//   all_change  e as for any_change; every gate below the tolerance.
//   assisted    e = 95 % half-width with a model of the response as control variate: assisted_convergence.hpp.
// The errors shown beside the values are Student-t half-widths if there are at least 4 sequences (for statistics other
// than the mean, once each sequence has 4 values). Otherwise they are a delete-a-group jackknife over 8 consecutive
// batches of the points (see confidence.hpp).
//
// Short sequences have small g1 and kurtosis with little scatter, even if the whole sample has large ones. Therefore
// their error is
//
//   error^2 = max(Student over sequences, jackknife that leaves out a sequence)^2 + (all - mean of sequences)^2
//
// and it is undefined while fewer than 30 values carry g1, or 50 the kurtosis. The number of carrying values is (sum |y
// - mean|^p)^2 / sum |y - mean|^2p, p = 3 and 4. Where a tail has no visible end (tail.hpp) 60 and 200 are needed:
// values that are missing from the sample are missing from this number, too.
//
// Two things make sequences agree by more than they know.
// - Even sequences of 2^k points count a jump alike: of 16 points 3 or 4 lie below 0.2, and in one campaign of six all
// of
//   8 sequences have 3. Errors of even points fall as n^-3/2 at the steepest, so no error is smaller than that of the
//   first half of each sequence times 2^-3/2, of the first quarter times 2^-3, of the first eighth times 2^-9/2.
// - Sequences that lack the same rare large values agree about too small an sd. No error is smaller than 2.8 standard
//   errors of the statistic from the tails, to first order in its influence function (z: standardised value): sd z for
//   the mean, sd z^2/2, 3 z - skewness z^2/2, z^3 - 3 z - 3/2 g1 z^2, z^4 - 4 g1 z - 2 kurtosis z^2. Those of mean and
//   sd grow threefold at most: beyond, a bounded response with two clusters of values would pay for the tail it lacks.
//
// An undefined error never passes. While all values are equal, or all repetitions of a statistic are, its scatter is
// unknown and its error undefined. A check without a new value since the check before is no confirmation: its measures
// are undefined. Pearson's skewness is refused as a gate while between 45 and 55 % of the values are zero, because the
// median then jumps between zero and the other values.
#pragma once

#include "stats/batches.hpp"
#include "stats/convergence_rule.hpp"
#include "stats/levels.hpp"
#include "stats/moments.hpp"
#include "stats/tail.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace grainsweep::stats {

/// What a rule judges.
using Gate = std::variant<Statistic, Level>;

[[nodiscard]] std::string to_string(const Gate& gate);
/// Returns the gate of a word of the campaign file: the name of a statistic, or a level (levels.hpp).
[[nodiscard]] std::optional<Gate> gate_named(std::string_view word);

struct ConvergenceSettings {
    ConvergenceRule rule = ConvergenceRule::replicates;
    std::vector<Gate> gates = {Statistic::mean, Statistic::sd, Statistic::kurtosis, Statistic::g1};
    double tolerance = 0.01;
    std::int64_t block = 400;    ///< points between two checks
    std::int64_t sequences = 1;  ///< R of the design

    [[nodiscard]] const RuleInfo& traits() const { return info_of(rule); }
};

/// Values that carry a statistic, (sum |y - mean|^p)^2 / sum |y - mean|^2p.
struct Carriers {
    double count = 0;
    double needed = 0;  ///< for a defined error
};

struct Estimate {
    double value = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();    ///< 95 % half-width, in the unit of the value
    double measure = std::numeric_limits<double>::quiet_NaN();  ///< compared with the tolerance
    std::optional<Carriers> carriers = std::nullopt;  ///< of g1 or kurtosis, if there are too few for an error
};

struct Checkpoint {
    std::int64_t points = 0;    ///< design points in the prefix
    std::int64_t count = 0;     ///< finite values among them
    std::int64_t excluded = 0;  ///< values that are not finite
    std::int64_t runs = 0;      ///< distinct runs with a finite value
    std::int64_t fresh = 0;     ///< new ones of these since the check before
    bool all_equal = false;     ///< only one distinct value: the scatter is unknown
    double zero_share = std::numeric_limits<double>::quiet_NaN();
    std::array<Estimate, statistics.size()> estimates;
    std::vector<std::pair<Level, Estimate>> levels;  ///< those among the gates
    bool passes = false;                             ///< the gates are below the tolerance at this check
    bool converged = false;                          ///< passes, and for `replicates` also at the check before
    std::optional<Gate> held_back;                   ///< if the check does not pass: the gate that decides
    /// Number of points at which the campaign will probably converge, from the observed decay of the measures; empty if
    /// a gate is undefined.
    std::optional<std::int64_t> points_needed;
    /// Rule `assisted`: why a model was refused, withdrawn or not used; else empty.
    std::string remark;

    [[nodiscard]] const Estimate& of(Statistic statistic) const {
        return estimates[static_cast<std::size_t>(statistic)];
    }
    [[nodiscard]] const Estimate& of(const Gate& gate) const;
};

/// Returns whether the share of zeros makes the median jump, so that Pearson's skewness cannot be judged.
[[nodiscard]] bool median_is_unsound(double zero_share);

/// Returns the measure of an error that is given in the unit of the statistic.
[[nodiscard]] double measure_of(const Gate& gate, double error, double value);
/// Sets whether every gate (any_change: one gate) is below the tolerance, and otherwise which gate decides. An
/// undefined gate counts as infinitely far from the tolerance.
void compare_with_tolerance(Checkpoint& now, const ConvergenceSettings& settings);
/// Returns the points at which the measures will probably be below the tolerance, from their decay in the checks
/// `before` and `now`; infinite if a gate is undefined.
[[nodiscard]] double points_for_tolerance(const ConvergenceSettings& settings, std::span<const Checkpoint> before,
                                          const Checkpoint& now);

/// Sample that stays sorted while values are added, so that the middle is available at every check.
class SortedSample {
public:
    void add(double value) { fresh_.push_back(value); }
    [[nodiscard]] Middle middle();
    /// Returns (sum |y - centre|^p)^2 / sum |y - centre|^2p of the values at the last middle().
    [[nodiscard]] double carriers(double centre, double p) const;
    /// Returns the values at the last middle(), ascending.
    [[nodiscard]] std::span<const double> sorted() const { return sorted_; }

private:
    std::vector<double> sorted_;
    std::vector<double> fresh_;
};

/// Checks of one response along a growing design. The verdict depends on the values alone.
class Convergence {
public:
    /// Throws std::invalid_argument: the rule `assisted`, `replicates` with fewer than 4 sequences, no gate, a block
    /// below 1, a tolerance that is not positive.
    explicit Convergence(ConvergenceSettings settings);

    /// Adds the next value (NaN: the case failed), by ascending point number. Numbers may be missing (filtered out) or
    /// repeated. All points before `point` must have been added; checks that they complete are made here.
    /// `earlier`: number of earlier places with the same run, which was added there. The weight of the run is then its
    /// number of places, and every error is widened:
    ///
    ///   error^2 = (error from sequences or batches)^2 + (1.96 c)^2 sum over runs of (w^2 - w/N)
    ///
    /// w: share of the N places that have this run; c: asymptotic standard deviation of the statistic of a normal
    /// sample, times sqrt(n) (mean: sd; sd: sd sqrt((kurtosis - 1)/4); skewness: 3 sqrt(pi/2 - 1); g1: sqrt 6;
    /// kurtosis: sqrt 24). The second term is 0 without repeated runs. It counts the whole variance as scatter of
    /// single runs.
    void add(std::int64_t point, double value, std::int64_t earlier = 0);
    /// States that every point below `points` has been added or never will be.
    void settle(std::int64_t points);

    [[nodiscard]] std::span<const Checkpoint> checkpoints() const { return checkpoints_; }
    /// Returns the first converged check, if any, at which the campaign may stop.
    [[nodiscard]] const Checkpoint* converged() const;

private:
    struct Sequence {
        Moments moments;
        SortedSample sample;
        std::vector<double> values;  ///< finite ones, in their order; of all points only without sequences
    };

    void check();
    void find_errors(Checkpoint& now);
    void find_levels(Checkpoint& now) const;
    void doubt_agreement(Checkpoint& now) const;
    static void doubt_tails(Checkpoint& now, std::span<const Tail> tails);
    void judge_shape(Checkpoint& now, std::span<const Summary> repetitions, bool endless) const;
    void widen_errors(Checkpoint& now) const;
    void find_measures(Checkpoint& now) const;
    void judge(Checkpoint& now) const;
    [[nodiscard]] std::optional<std::int64_t> predict(const Checkpoint& now) const;

    ConvergenceSettings settings_;
    std::vector<Sequence> sequences_;
    Sequence pooled_;
    std::int64_t places_ = 0, runs_ = 0;  ///< places with a value; distinct runs among them
    double excess_ = 0;                   ///< sum over runs of (places of the run)^2 - places
    StretchedSample stretches_;           ///< used if errors come from the jackknife
    std::vector<Checkpoint> checkpoints_;
};

/// Returns the checks of a complete list: values[i] belongs to design point points[i] (ascending); the first `settled`
/// points are judged. `earlier`: as in Convergence::add; empty: every value is a run of its own.
[[nodiscard]] std::vector<Checkpoint> judge_convergence(const ConvergenceSettings& settings,
                                                        std::span<const std::int64_t> points,
                                                        std::span<const double> values, std::int64_t settled,
                                                        std::span<const std::int64_t> earlier = {});

}  // namespace grainsweep::stats
