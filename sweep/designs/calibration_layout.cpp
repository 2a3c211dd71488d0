#include "sweep/designs/calibration_layout.hpp"

#include <algorithm>
#include <stdexcept>

namespace grainsweep::designs {

std::string experiment_of(const DesignRequest& request) {
    const auto own = request.options.find("experiment");
    return own == request.options.end() ? std::string() : std::get<std::string>(own->second);
}

CalibrationLayout calibration_layout(const DesignRequest& request, std::span<const MeasuredTarget> targets) {
    CalibrationLayout layout;
    if (targets.empty()) throw std::invalid_argument("a calibration needs at least one target");
    const auto is_stated = [&](const std::string& factor) {
        return std::ranges::any_of(targets, [&](const MeasuredTarget& target) {
            return target.experiment == experiment_of(request) && target.level.contains(factor);
        });
    };
    for (std::size_t j = 0; j < request.dimensions(); ++j)
        (is_stated(request.factors[j].name) ? layout.stated : layout.calibrated).push_back(j);
    if (layout.calibrated.empty()) throw std::invalid_argument("there is no factor to calibrate");
    layout.factors = request.shared;
    for (const std::size_t j : layout.calibrated) {
        if (request.shared.empty()) layout.factors.push_back(request.factors[j]);
        const auto found = std::ranges::find(layout.factors, request.factors[j].name, &Factor::name);
        layout.column.push_back(static_cast<std::size_t>(found - layout.factors.begin()));
    }
    std::map<std::string, std::vector<std::map<std::string, std::size_t>>> conditions;
    for (const auto& target : targets) {
        auto& known = conditions[target.experiment];
        const auto found = std::ranges::find(known, target.level);
        layout.condition_of.push_back(static_cast<std::size_t>(found - known.begin()));
        if (found == known.end()) known.push_back(target.level);
    }
    for (const auto& target : targets) layout.conditions_of.push_back(conditions[target.experiment].size());
    for (const auto& [experiment, known] : conditions) layout.runs += known.size();
    layout.conditions = conditions[experiment_of(request)];
    return layout;
}

}  // namespace grainsweep::designs
