// What becomes of the values that a probe has given at the frames: one number, a series, or a profile.
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
    /// Returns the number; NaN where it is undefined. Of a series nothing: the values are the answer.
    double (*of)(std::span<const Sample>) = nullptr;
    double (*error)(std::span<const Sample>) = nullptr;  ///< its standard error, where it has one
    /// What to append to the unit of the probe.
    std::string_view unit = {};
    bool last = false;  ///< the last frame decides: undefined where the probe has no value there
};

[[nodiscard]] std::span<const ReductionInfo> reduction_catalogue();
/// Returns nullptr where there is none of that name.
[[nodiscard]] const ReductionInfo* find_reduction(std::string_view name);

/// Returns the samples between two shares of the first one.
[[nodiscard]] std::vector<Sample> between_shares(std::span<const Sample> samples, double low, double high);
/// Returns the samples at times at which there is another one between two values. Both in the order of time.
[[nodiscard]] std::vector<Sample> while_between(std::span<const Sample> samples, std::span<const Sample> others,
                                                double low, double high);

}  // namespace grainsweep::machine
