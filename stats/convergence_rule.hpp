// The rules by which the statistics of a response are good enough, and what others must know of each. What they compute
// is described in convergence.hpp and assisted_convergence.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace grainsweep::stats {

enum class ConvergenceRule { replicates, assisted, any_change, all_change };

/// A row of the catalogue; nothing else compares names.
struct RuleInfo {
    ConvergenceRule rule = ConvergenceRule::replicates;
    std::string_view name;
    /// The error comes from independent sequences of the design, at least 4, and two checks in a row must pass. Else it
    /// is the change since the check before.
    bool of_sequences = false;
    bool of_model = false;  ///< with a model of the response: checks are fewer, and a median has no estimate
    bool one_gate = false;  ///< one gate within the tolerance is enough
};

inline constexpr std::array convergence_rules = {
    RuleInfo{.rule = ConvergenceRule::replicates, .name = "replicates", .of_sequences = true},
    RuleInfo{.rule = ConvergenceRule::assisted, .name = "assisted", .of_sequences = true, .of_model = true},
    RuleInfo{.rule = ConvergenceRule::any_change, .name = "any_change", .one_gate = true},
    RuleInfo{.rule = ConvergenceRule::all_change, .name = "all_change"},
};

[[nodiscard]] constexpr const RuleInfo& info_of(ConvergenceRule rule) {
    return convergence_rules[static_cast<std::size_t>(rule)];
}
[[nodiscard]] constexpr std::string_view to_string(ConvergenceRule rule) {
    return info_of(rule).name;
}
/// nullptr where there is none of that name.
[[nodiscard]] constexpr const RuleInfo* find_rule(std::string_view name) {
    const auto* const found = std::ranges::find(convergence_rules, name, &RuleInfo::name);
    return found == convergence_rules.end() ? nullptr : found;
}

/// Sequences of a design that give an error.
inline constexpr std::int64_t fewest_sequences = 4;
/// Of a rule with a model: fewest points of a check, and the share by which the next one is larger at least: 1 in 5.
inline constexpr std::int64_t fewest_assisted_points = 104, assisted_growth = 5;

}  // namespace grainsweep::stats
