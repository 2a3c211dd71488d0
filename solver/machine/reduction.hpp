// Reductions of a probe's values at the frames to one number, a series, or a profile.
#pragma once

#include "solver/scenes/values.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::machine {

struct ReductionInfo {
    std::string_view name, meaning;
    Shape shape = Shape::scalar;
    /// Returns the number; NaN: undefined. Null for a series, whose values are the answer.
    double (*of)(std::span<const Sample>) = nullptr;
    double (*error)(std::span<const Sample>) = nullptr;  ///< standard error of the number; null: none
    /// Suffix of the probe's unit.
    std::string_view unit = {};
    bool last = false;  ///< uses the last frame only: undefined if the probe has no value there
};

[[nodiscard]] std::span<const ReductionInfo> reduction_catalogue();
/// Returns the reduction of this name; nullptr if there is none.
[[nodiscard]] const ReductionInfo* find_reduction(std::string_view name);

/// Returns the samples with values between two shares of the first value.
[[nodiscard]] std::vector<Sample> between_shares(std::span<const Sample> samples, double low, double high);
/// Returns the samples at whose times a sample of `others` lies between two values. Both lists are in the order of
/// time.
[[nodiscard]] std::vector<Sample> while_between(std::span<const Sample> samples, std::span<const Sample> others,
                                                double low, double high);

}  // namespace grainsweep::machine
