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

/// The factors that are calibrated, and those that state the conditions of targets. Point p is run under the condition
/// p mod conditions.size().
struct CalibrationLayout {
    std::vector<std::size_t> calibrated, stated;                 ///< numbers of factors
    std::vector<std::map<std::string, std::size_t>> conditions;  ///< distinct, in the order of the targets
    std::vector<std::size_t> condition_of;                       ///< each target's
};

/// Throws std::invalid_argument where there is nothing to calibrate or no target.
[[nodiscard]] CalibrationLayout calibration_layout(const DesignRequest& request,
                                                   std::span<const MeasuredTarget> targets);

}  // namespace grainsweep::designs
