// Catalogue of the convergence rules with their traits. Equations: convergence.hpp and assisted_convergence.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace grainsweep::stats {

enum class ConvergenceRule { replicates, assisted, any_change, all_change };

/// Row of the catalogue. No other code compares names of rules.
struct RuleInfo {
    ConvergenceRule rule = ConvergenceRule::replicates;
    std::string_view name;
    /// True: the error comes from at least 4 independent sequences of the design, and two checks in a row must pass.
    /// False: the error is the change since the check before.
    bool of_sequences = false;
    bool of_model = false;  ///< uses a model of the response: fewer checks, and no estimate of a median
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
/// Returns the rule of this name; nullptr if there is none.
[[nodiscard]] constexpr const RuleInfo* find_rule(std::string_view name) {
    const auto* const found = std::ranges::find(convergence_rules, name, &RuleInfo::name);
    return found == convergence_rules.end() ? nullptr : found;
}

/// Smallest number of sequences that gives an error.
inline constexpr std::int64_t fewest_sequences = 4;
/// For a rule with a model: fewest points of a check, and its growth: the next check has at least 1/5 more points.
inline constexpr std::int64_t fewest_assisted_points = 104, assisted_growth = 5;

}  // namespace grainsweep::stats
