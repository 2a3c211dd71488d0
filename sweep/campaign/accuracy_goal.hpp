// Error goal of a campaign, for numerics and statistics together: "accuracy" as an object. It is no part of the
// campaign's identity.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

struct AccuracyGoal {
    std::string observable;
    std::vector<std::string> gates = {"mean", "sd"};
    double tolerance = 0.01;             ///< relative, for the 95 % half-width
    std::optional<std::string> setting;  ///< setting of most cases; empty: a pilot chooses it

    /// Setting whose answers are the standard.
    static constexpr std::string_view measure = "reference";
};

}  // namespace grainsweep::campaign
