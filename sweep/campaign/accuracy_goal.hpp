// What the answer of a campaign may be off by, numerics and statistics together: "accuracy" as an object. It is no part
// of what the campaign is.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

struct AccuracyGoal {
    std::string observable;
    std::vector<std::string> gates = {"mean", "sd"};
    double tolerance = 0.01;             ///< relative, with 95 %
    std::optional<std::string> setting;  ///< of most cases; none: a pilot chooses it

    /// The setting whose answers are the measure.
    static constexpr std::string_view measure = "reference";
};

}  // namespace grainsweep::campaign
