// How the points of a calibration are laid out: every setting is run under every condition of the targets.
#pragma once

#include "sweep/designs/design.hpp"
#include "sweep/designs/measured_targets.hpp"

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::designs {

/// The calibrated factors, and the factors that state the conditions of targets. Every setting is run in every
/// experiment under each condition of its targets: in an experiment of c conditions point p is setting p div c under
/// the condition p mod c.
struct CalibrationLayout {
    std::vector<std::size_t> calibrated, stated;                 ///< numbers of the request's factors
    std::vector<FactorRange> factors;                            ///< calibrated, those of other experiments too
    std::vector<std::size_t> column;                             ///< among them, of each in `calibrated`
    std::vector<std::map<std::string, std::size_t>> conditions;  ///< of this experiment, in the order of its targets
    std::vector<std::size_t> condition_of;                       ///< each target's, in its experiment
    std::vector<std::size_t> conditions_of;                      ///< how many the experiment of each target has
    std::size_t runs = 0;                                        ///< of one setting in all experiments

    /// The point at which a setting answers a target, in the numbers of the target's experiment.
    [[nodiscard]] std::size_t point(std::size_t target, std::size_t setting) const {
        return setting * conditions_of[target] + condition_of[target];
    }
};

/// The experiment that the request runs; empty: the calibration has one.
[[nodiscard]] std::string experiment_of(const DesignRequest& request);

/// Throws std::invalid_argument where there is nothing to calibrate or no target.
[[nodiscard]] CalibrationLayout calibration_layout(const DesignRequest& request,
                                                   std::span<const MeasuredTarget> targets);

}  // namespace grainsweep::designs
