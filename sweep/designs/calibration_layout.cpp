#include "sweep/designs/calibration_layout.hpp"

#include <algorithm>
#include <stdexcept>

namespace grainsweep::designs {

CalibrationLayout calibration_layout(const DesignRequest& request, std::span<const MeasuredTarget> targets) {
    CalibrationLayout layout;
    for (std::size_t j = 0; j < request.dimensions(); ++j)
        (request.levels[j] == 0 ? layout.calibrated : layout.stated).push_back(j);
    if (layout.calibrated.empty())
        throw std::invalid_argument("no factor varies between two values: nothing to calibrate");
    if (targets.empty()) throw std::invalid_argument("a calibration needs at least one target");
    for (const auto& target : targets) {
        const auto found = std::ranges::find(layout.conditions, target.level);
        layout.condition_of.push_back(static_cast<std::size_t>(found - layout.conditions.begin()));
        if (found == layout.conditions.end()) layout.conditions.push_back(target.level);
    }
    return layout;
}

}  // namespace grainsweep::designs
