// What a calibration has found: how the waves closed in, the posterior of the factors, and whether fresh runs at
// settings drawn from it reproduce what was measured.
#pragma once

#include "sweep/designs/calibration.hpp"
#include "sweep/store/store.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::study {

/// Of one factor.
struct FactorPosterior {
    std::string name, unit;
    double mean = 0, sd = 0;   ///< in its unit
    double low = 0, high = 0;  ///< 5 and 95 % quantiles
    double share_of_range =
        0;  ///< sd over that of the uniform prior, in the scale of the factor; near 1: not determined
};

/// Of one target.
struct TargetCheck {
    std::string observable, unit, condition;  ///< "rpm = 15"
    std::string experiment = {};              ///< empty: the calibration has one
    double value = 0, error = 0, discrepancy = 0;
    double predicted = 0, predicted_error = 0;  ///< mean over the posterior, and its sd, of the response model
    double checked = 0, checked_sd = 0;         ///< mean and sd of the fresh runs; NaN: none yet
    std::size_t runs = 0;
    std::optional<double> z = {};  ///< distance of the fresh runs from the measurement (designs::miss_of)
    double beyond = 0;             ///< how far it lies beyond every case, in standard deviations; 0: within
    std::string refusal;           ///< why it has no model; empty: it has one
    /// Of a place along a curve that no case has answered: the first and last place of the curves under its condition.
    std::optional<std::pair<double, double>> covered = {};

    /// "torque at rpm = 15", "heap angle"
    [[nodiscard]] std::string name() const;
};

/// What a calibration that has ended comes to, in one line: "calibrated", "not determined: friction along a ridge with
/// rolling_friction", "not reproduced: rate flow_time by 3.1 sd".
struct Verdict {
    std::string sentence;
    bool reproduced = true;  ///< fresh runs meet every measurement within designs::largest_miss_allowed
};

struct CalibrationReport {
    designs::Calibration found;
    std::vector<FactorPosterior> factors;
    std::vector<TargetCheck> targets;
    std::optional<Verdict> verdict;  ///< none while fresh runs are missing, and without a posterior
    std::vector<std::string> notes;  ///< ridges, what is not determined, targets out of reach, contradictions, failures
};

/// Of several experiments each campaign has the same report. None for a campaign of another design.
[[nodiscard]] std::optional<CalibrationReport> calibration_report(const store::Store& store,
                                                                  const store::CampaignRecord& record);

}  // namespace grainsweep::study
