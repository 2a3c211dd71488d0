// Which parameters can matter to a campaign: a given one that no case can feel is a misunderstanding.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Why no case of the space can feel the parameter; none where one can. A condition on another parameter holds
/// if one of its levels, or a value of its range, satisfies it.
[[nodiscard]] std::optional<std::string> no_effect(const ParameterSpace& space, const ParameterSpec& parameter);

/// Adds the inputs of an accuracy setting under what is fixed and varied; one that could not matter beside
/// those is left at its default.
void resolve_accuracy(ParameterSpace& space, std::string_view accuracy);

/// Holds a parameter at a value, whatever held or varied it before, and lets go of inputs of the accuracy
/// setting which that makes meaningless.
void hold(ParameterSpace& space, std::string_view parameter, const Value& value, std::string_view accuracy);

}  // namespace grainsweep::campaign
