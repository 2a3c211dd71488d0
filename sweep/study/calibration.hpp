// Results of a calibration: how its waves narrowed the settings, the posterior of the factors, and whether fresh runs
// at settings drawn from the posterior reproduce the measurements.
#pragma once

#include "sweep/designs/calibration.hpp"
#include "sweep/store/store.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::study {

/// Result for one factor, by the width of its posterior divided by the width of its prior. Up to 1/4 the factor is
/// determined (two bits). Above 1/2 it is not (less than one bit). Between them it is determined partly.
enum class Determination { determined, partly, not_determined };

/// Posterior probability of one level, or of one multiple of a step.
struct LevelProbability {
    std::string level;
    double probability = 0;
};

/// Posterior of one factor.
struct FactorPosterior {
    designs::Factor factor;
    double mean = 0, sd = 0;   ///< in its unit; NaN for levels that are words
    double low = 0, high = 0;  ///< 5 and 95 % quantiles
    double share_of_range =
        0;  ///< sd divided by the sd of the uniform prior, in the scale of the factor; near 1: not determined. For
            ///< words: the probability of all but the likeliest, divided by the prior's
    std::vector<LevelProbability> levels = {};  ///< of levels, and of few multiples of a step; else empty
    Determination determination = Determination::not_determined;
    /// Factor with which it is strongly correlated; empty: none.
    std::string ridge_with = {};

    /// Returns "determined", "partly" or "not determined".
    [[nodiscard]] std::string_view word() const;
};

/// Distribution of one factor before and after a calibration, over bins of its range; of levels one bin each, around
/// its index.
struct Marginal {
    std::vector<double> from, to;          ///< in its unit
    std::vector<double> prior, posterior;  ///< probability of each bin
};
/// Returns the distribution of factor j of a calibration that has a posterior.
[[nodiscard]] Marginal marginal_of(const designs::Calibration& found, std::size_t j);

/// Prediction and fresh runs of one target.
struct TargetCheck {
    std::string observable, unit, condition;  ///< "flow_time" or "share without flow_time", "s", "rpm = 15"
    std::string experiment = {};              ///< empty: the calibration has only one experiment
    double value = 0, error = 0, discrepancy = 0;
    double predicted = 0, predicted_error = 0;  ///< mean and sd of the response model over the posterior
    double checked = 0, checked_sd = 0;         ///< mean and sd of the fresh runs; NaN: no run yet
    std::size_t runs = 0;
    std::optional<double> z = {};  ///< distance of the fresh runs from the measurement (designs::miss_of)
    double beyond = 0;             ///< distance from the range of all cases, in standard deviations; 0: inside
    std::string refusal;           ///< why the target has no model; empty: it has one
    /// First and last place of the curves under the target's condition. Only for a target at a place of a curve that no
    /// case has reached.
    std::optional<std::pair<double, double>> covered = {};

    /// Returns a name such as "torque at rpm = 15" or "heap angle".
    [[nodiscard]] std::string name() const;
};

/// Fewest fresh runs with an answer that check a posterior; at least half of the requested ones, too.
inline constexpr std::size_t fewest_checks = 4;

/// Result of a finished calibration in one line: "calibrated"; "not reproduced: rate flow_time by 3.1 sd"; or what is
/// missing, "not determined: friction along a ridge with rolling_friction", "partly determined: gap (0.37 of its
/// range's width)", "not settled: ...", "not checked: 2 of 8 fresh runs have an answer".
struct Verdict {
    std::string sentence;
    bool reproduced = true;  ///< fresh runs meet every measurement within designs::largest_miss_allowed
};

struct CalibrationReport {
    designs::Calibration found;
    std::vector<FactorPosterior> factors;
    std::vector<TargetCheck> targets;
    std::optional<Verdict> verdict;  ///< empty while fresh runs are missing, and without a posterior
    std::vector<std::string> notes;  ///< ridges, undetermined factors, unreachable targets, contradictions, failures
};

/// Returns the report; every campaign of a calibration with several experiments has the same one. Empty for a campaign
/// of another design.
[[nodiscard]] std::optional<CalibrationReport> calibration_report(const store::Store& store,
                                                                  const store::CampaignRecord& record);

}  // namespace grainsweep::study
