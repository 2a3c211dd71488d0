// What a calibration compares with: measurements, each under a condition.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::designs {

/// What was measured, under which condition.
struct MeasuredTarget {
    std::string observable;  ///< a scalar, or a place along a curve (curve_place.hpp)
    double value = 0;
    double error = 0;                            ///< standard error of the measurement
    double discrepancy = 0;                      ///< standard deviation of what the simulation leaves out
    std::map<std::string, std::size_t> level{};  ///< of each condition factor, by number
    std::size_t curve = 0;                       ///< targets of one measured curve share a number above 0
    std::string experiment{};                    ///< it was measured in; empty: the calibration has one
    bool operator==(const MeasuredTarget&) const = default;

    /// Key of its answers in a request: "angle", or "heap/angle" of the experiment "heap".
    [[nodiscard]] std::string answers_key() const {
        return experiment.empty() ? observable : experiment + '/' + observable;
    }
};

/// Distance of fresh runs from the measurement in standard deviations, (mean - value)/sqrt(error^2 + discrepancy^2 +
/// scatter^2), scatter the standard deviation of the runs; none where fewer than two have an answer. NaN: no answer.
[[nodiscard]] std::optional<double> miss_of(const MeasuredTarget& target, std::span<const double> answers);

/// The largest miss of a calibration's measurements and the number of the target: |miss| of a scalar; of a curve the
/// root mean square over its places, at the first of them. None where nothing was checked.
struct LargestMiss {
    double size = 0;
    std::size_t target = 0;
};
[[nodiscard]] std::optional<LargestMiss> largest_miss(std::span<const MeasuredTarget> targets,
                                                      std::span<const std::vector<double>> answers);
/// Fresh runs that miss by more standard deviations do not reproduce a measurement.
inline constexpr double largest_miss_allowed = 2;

/// Covariance of measurement and discrepancy, row-major. Errors are independent. Discrepancies along a curve have the
/// correlation exp(-|x - x'|/L), L a quarter of the curve's length, because the simulation errs alike at neighbouring
/// points of a curve.
[[nodiscard]] std::vector<double> covariance_of(std::span<const MeasuredTarget> targets);

/// Targets as one line of text, as the option "targets" holds them, and back.
[[nodiscard]] std::string text_of(const std::vector<MeasuredTarget>& targets);
/// Throws std::invalid_argument for any other text.
[[nodiscard]] std::vector<MeasuredTarget> targets_in(std::string_view text);

}  // namespace grainsweep::designs
