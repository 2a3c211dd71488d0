// What a calibration compares with: measurements, each under a condition.
#pragma once

#include <cstddef>
#include <map>
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
    bool operator==(const MeasuredTarget&) const = default;
};

/// Covariance of measurement and discrepancy, row-major: errors are independent; along a curve discrepancies are off
/// together, with the correlation exp(-|x - x'|/L), L a quarter of the curve's length: what the simulation leaves out
/// does not change from one point of a curve to the next.
[[nodiscard]] std::vector<double> covariance_of(std::span<const MeasuredTarget> targets);

/// Targets as one line of text, as the option "targets" holds them, and back.
[[nodiscard]] std::string text_of(const std::vector<MeasuredTarget>& targets);
/// Throws std::invalid_argument for any other text.
[[nodiscard]] std::vector<MeasuredTarget> targets_in(std::string_view text);

}  // namespace grainsweep::designs
