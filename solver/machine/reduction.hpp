// Reductions of a probe's values at the frames to one number, a series, or a profile.
#pragma once

#include "solver/scenes/values.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::machine {

/// Integral of a value over the steps between two frames.
struct FrameInterval {
    double end = 0, length = 0;  ///< s
    double integral = 0;         ///< unit of the value, s
};

struct ReductionInfo {
    std::string_view name, meaning;
    Shape shape = Shape::scalar;
    /// Returns the number; NaN: undefined. Null for a series, whose values are the answer.
    double (*of)(std::span<const Sample>) = nullptr;
    double (*error)(std::span<const Sample>) = nullptr;  ///< standard error of the number; null: none
    /// Suffix of the probe's unit.
    std::string_view unit = {};
    bool last = false;  ///< uses the last frame only: undefined if the probe has no value there
    /// The same for a probe whose value is integrated over the steps. Null: values at frames are used.
    double (*of_intervals)(std::span<const FrameInterval>) = nullptr;
    double (*error_of_intervals)(std::span<const FrameInterval>) = nullptr;
    bool every = false;  ///< of a profile: all frames, with their times
};

[[nodiscard]] std::span<const ReductionInfo> reduction_catalogue();
/// Returns the reduction of this name; nullptr if there is none.
[[nodiscard]] const ReductionInfo* find_reduction(std::string_view name);

/// Returns the rate of change at each sample but the first, since the one before.
[[nodiscard]] std::vector<Sample> with_rates(std::span<const Sample> samples);
/// Returns the first time at which samples pass a value, s; between two samples on a straight line. Empty: they never
/// do.
[[nodiscard]] std::optional<double> crossing_time(std::span<const Sample> samples, double value, bool above);
/// Returns the intervals that end at one of the samples. Both lists are in the order of time.
[[nodiscard]] std::vector<FrameInterval> ending_at(std::span<const FrameInterval> intervals,
                                                   std::span<const Sample> samples);
/// Returns the samples with values between two shares of the first value.
[[nodiscard]] std::vector<Sample> between_shares(std::span<const Sample> samples, double low, double high);
/// Returns the samples at whose times a sample of `others` lies between two values. Both lists are in the order of
/// time.
[[nodiscard]] std::vector<Sample> while_between(std::span<const Sample> samples, std::span<const Sample> others,
                                                double low, double high);

}  // namespace grainsweep::machine
