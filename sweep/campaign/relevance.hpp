// Relevance of parameters: a campaign must not set a parameter without effect on any of its cases.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Returns why the parameter has no effect on any case of the space; empty if it has. A condition on another parameter
/// holds if one of its levels, or a value of its range, satisfies it.
[[nodiscard]] std::optional<std::string> no_effect(const ParameterSpace& space, const ParameterSpec& parameter);

/// Returns whether an accuracy setting may decide an input: the file neither varies it nor states it, and it acts on
/// some case.
[[nodiscard]] bool is_left_open(const ParameterSpace& space, const Inputs& stated, const std::string& name);

/// Adds the inputs of an accuracy setting that are neither fixed nor varied. Inputs without effect keep their defaults.
void resolve_accuracy(ParameterSpace& space, std::string_view accuracy);

/// Fixes a parameter at a value, replacing its former value or factor, and removes inputs of the accuracy setting that
/// then have no effect.
void hold(ParameterSpace& space, std::string_view parameter, const Value& value, std::string_view accuracy);

}  // namespace grainsweep::campaign
