// When enough points have been asked: errors of the statistics of a response, and a verdict.
//
// The values of a design come in the order of its points. At every multiple of `block` points the statistics of
// all points so far are formed, with their errors, and each gated statistic gets a measure that is compared
// with the tolerance:
//   mean, sd, kurtosis   e/|value|        g1   e/max(1, |g1|)        skewness (Pearson's)   e/3, 3 being its bound
// Rules, by what e is and what converges:
//   replicates  e = Student-t 95 % half-width over the R values of R independently randomised sequences (point p
//               belongs to sequence p mod R); every gate below the tolerance at two consecutive checks.
//   any_change  e = change since the check before; any one gate below the tolerance. The rule of the thesis this
//               program began with; it stops too early in about half of all sweeps.
//   all_change  the same, every gate below the tolerance.
//   assisted    e = 95 % half-width with a model of the response as control variate: assisted_convergence.hpp.
// The errors shown beside the values are Student-t half-widths where there are at least 4 sequences (of all but the
// mean once each has 4 values). Otherwise they are a delete-a-group jackknife over 8 consecutive stretches of the
// points (see confidence.hpp).
//
// Short sequences have a small g1 and kurtosis with little scatter, even where all values have large ones. Their error:
//
//   error^2 = max(Student over sequences, jackknife that leaves out a sequence)^2 + (all - mean of sequences)^2
//
// and undefined while fewer than 30 values carry g1, or 50 the kurtosis: (sum |y - mean|^p)^2 / sum |y - mean|^2p of
// them do, p = 3 and 4.
//
// What is undefined never passes, and neither does what is unknown: while all values are equal, or where the
// repetitions of a statistic are, nothing is known of its scatter, and its error is undefined. A check without a new
// value since the check before confirms nothing: its measures are undefined. Pearson's skewness is refused as a gate
// while between 45 and 55 % of the values are zero: there the median jumps between zero and the rest.
#pragma once

#include "stats/convergence_rule.hpp"
#include "stats/moments.hpp"
#include "stats/stretches.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::stats {

struct ConvergenceSettings {
    ConvergenceRule rule = ConvergenceRule::replicates;
    std::vector<Statistic> gates = {Statistic::mean, Statistic::sd, Statistic::kurtosis, Statistic::g1};
    double tolerance = 0.01;
    std::int64_t block = 400;    ///< points between two checks
    std::int64_t sequences = 1;  ///< R of the design

    [[nodiscard]] const RuleInfo& traits() const { return info_of(rule); }
};

struct Estimate {
    double value = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();    ///< 95 % half-width, in the unit of the value
    double measure = std::numeric_limits<double>::quiet_NaN();  ///< what the rule compares with the tolerance
    /// g1 and kurtosis whose error is undefined because too few values carry them: how many do.
    std::optional<double> carriers = std::nullopt;
};

/// Fewest values that carry g1 or kurtosis where its error is defined.
[[nodiscard]] constexpr double fewest_carriers(Statistic statistic) {
    return statistic == Statistic::kurtosis ? 50 : 30;
}

struct Checkpoint {
    std::int64_t points = 0;    ///< design points in the prefix
    std::int64_t count = 0;     ///< finite values among them
    std::int64_t excluded = 0;  ///< values that are not finite
    std::int64_t runs = 0;      ///< different runs among those with a finite value
    std::int64_t fresh = 0;     ///< of those, since the check before
    bool all_equal = false;     ///< one value, once or several times: nothing is known of the scatter
    double zero_share = std::numeric_limits<double>::quiet_NaN();
    std::array<Estimate, statistics.size()> estimates;
    bool passes = false;                 ///< the rule holds at this check
    bool converged = false;              ///< and, for `replicates`, at the one before
    std::optional<Statistic> held_back;  ///< while it does not pass: the gate that decides
    /// Points at which it will probably have converged, from the observed decay of the measures; none where
    /// a gate is undefined.
    std::optional<std::int64_t> points_needed;
    /// Under the rule assisted: why a model was refused, withdrawn or not taken; else empty.
    std::string remark;

    [[nodiscard]] const Estimate& of(Statistic statistic) const {
        return estimates[static_cast<std::size_t>(statistic)];
    }
};

/// True where so many values are zero that the median jumps: Pearson's skewness cannot be judged.
[[nodiscard]] bool median_is_unsound(double zero_share);

/// An error in the unit of the statistic -> what the tolerance is compared with.
[[nodiscard]] double measure_of(Statistic statistic, double error, double value);
/// Whether every gate (any_change: one) is below the tolerance; else which gate holds it back, undefined ones counting
/// as infinitely far.
void compare_with_tolerance(Checkpoint& now, const ConvergenceSettings& settings);
/// Points at which the measures will probably be below the tolerance, from their decay over the checks `before` and
/// now; infinite where a gate is undefined.
[[nodiscard]] double points_for_tolerance(const ConvergenceSettings& settings, std::span<const Checkpoint> before,
                                          const Checkpoint& now);

/// Values that arrive in order and stay sorted: the middle is at hand at every check.
class SortedSample {
public:
    void add(double value) { fresh_.push_back(value); }
    [[nodiscard]] Middle middle();
    /// (sum |y - centre|^p)^2 / sum |y - centre|^2p of the values of the last middle().
    [[nodiscard]] double carriers(double centre, double p) const;

private:
    std::vector<double> sorted_;
    std::vector<double> fresh_;
};

/// Follows one response through a growing design. Same values, same verdict, however they were computed.
class Convergence {
public:
    /// Throws std::invalid_argument: the rule `assisted`, `replicates` with fewer than 4 sequences, no gate, a block
    /// below 1, a tolerance that is not positive.
    explicit Convergence(ConvergenceSettings settings);

    /// The next value (NaN: the case failed), by growing point number; numbers may be missing (filtered out)
    /// or repeated. All points before `point` must have been added: checks they complete are made here.
    /// `earlier`: places before this one that hold the same run, which was added there. The run then weighs as many
    /// places as hold it, and every error is widened for it:
    ///
    ///   error^2 = (error from sequences or stretches)^2 + (1.96 c)^2 sum over runs of (w^2 - w/N)
    ///
    /// w: share of the N places that hold the run; c: asymptotic standard deviation of the statistic of a normal
    /// sample, times sqrt(n) (mean: sd; sd: sd sqrt((kurtosis - 1)/4); skewness: 3 sqrt(pi/2 - 1); g1: sqrt 6;
    /// kurtosis: sqrt 24). The second term is 0 without repeated runs; it takes all of the variance for scatter of
    /// single runs.
    void add(std::int64_t point, double value, std::int64_t earlier = 0);
    /// Every point below `points` has been added or will never be.
    void settle(std::int64_t points);

    [[nodiscard]] std::span<const Checkpoint> checkpoints() const { return checkpoints_; }
    /// The first converged check, if any: where the campaign may stop.
    [[nodiscard]] const Checkpoint* converged() const;

private:
    struct Sequence {
        Moments moments;
        SortedSample sample;
    };

    void check();
    void find_errors(Checkpoint& now);
    void judge_shape(Checkpoint& now, std::span<const Summary> repetitions) const;
    void widen_errors(Checkpoint& now) const;
    void find_measures(Checkpoint& now) const;
    void judge(Checkpoint& now) const;
    [[nodiscard]] std::optional<std::int64_t> predict(const Checkpoint& now) const;

    ConvergenceSettings settings_;
    std::vector<Sequence> sequences_;
    Sequence pooled_;
    std::int64_t places_ = 0, runs_ = 0;  ///< with a value; of those different
    double excess_ = 0;                   ///< sum over runs of (places of the run)^2 - places
    StretchedSample stretches_;           ///< filled where errors come from the jackknife
    std::vector<Checkpoint> checkpoints_;
};

/// One go: values[i] belongs to design point points[i] (growing); the first `settled` points are judged. `earlier`: as
/// in Convergence::add, empty: every value is a run of its own.
[[nodiscard]] std::vector<Checkpoint> judge_convergence(const ConvergenceSettings& settings,
                                                        std::span<const std::int64_t> points,
                                                        std::span<const double> values, std::int64_t settled,
                                                        std::span<const std::int64_t> earlier = {});

}  // namespace grainsweep::stats
