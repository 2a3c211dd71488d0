// Layout of the points of a calibration: every setting is run under every condition of the targets.
#pragma once

#include "sweep/designs/design.hpp"
#include "sweep/designs/measured_targets.hpp"

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::designs {

/// Layout: calibrated factors, and factors for the conditions of targets. Every setting is run in every experiment
/// under each condition of its targets. In an experiment with c conditions, point p is setting p div c under the
/// condition p mod c.
struct CalibrationLayout {
    std::vector<std::size_t> calibrated, stated;                 ///< numbers of the request's factors
    std::vector<Factor> factors;                                 ///< calibrated factors, including those of other
                                                                 ///< experiments
    std::vector<std::size_t> column;                             ///< index in `factors` of each in `calibrated`
    std::vector<std::map<std::string, std::size_t>> conditions;  ///< of this experiment, in the order of its targets
    std::vector<std::size_t> condition_of;                       ///< condition of each target in its experiment
    std::vector<std::size_t> conditions_of;                      ///< number of conditions in the experiment of each
                                                                 ///< target
    std::size_t runs = 0;                                        ///< runs of one setting in all experiments

    /// Returns the point of a setting for a target, numbered as in the target's experiment.
    [[nodiscard]] std::size_t point(std::size_t target, std::size_t setting) const {
        return setting * conditions_of[target] + condition_of[target];
    }
};

/// Returns the experiment of the request; empty: the calibration has only one.
[[nodiscard]] std::string experiment_of(const DesignRequest& request);

/// Returns the layout. Throws std::invalid_argument if there is no calibrated factor or no target.
[[nodiscard]] CalibrationLayout calibration_layout(const DesignRequest& request,
                                                   std::span<const MeasuredTarget> targets);

}  // namespace grainsweep::designs
