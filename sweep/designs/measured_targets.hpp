// Targets of a calibration: measurements, each under a condition. A measurement is a value, or the share of runs that
// had no value, such as jams.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::designs {

/// Measurement and its condition.
struct MeasuredTarget {
    std::string observable;  ///< a scalar, a place along a curve, or a missing value (curve_place.hpp)
    double value = 0;        ///< measured value, or measured share of runs without a value
    double error = 0;        ///< standard error of the measurement
    double discrepancy = 0;  ///< standard deviation of the effects that the simulation does not
                             ///< model; of a share: where it is 1/2
    std::map<std::string, std::size_t> level{};  ///< level of each condition factor, by number
    std::size_t curve = 0;                       ///< targets of one measured curve share a number above 0
    std::string experiment{};                    ///< experiment of the measurement; empty: the calibration has only one
    std::optional<std::size_t> of{};             ///< measured runs of a share; empty: the measurement is a value
    bool operator==(const MeasuredTarget&) const = default;

    /// Returns the key of its answers in a request: "angle", or "heap/angle" of the experiment "heap".
    [[nodiscard]] std::string answers_key() const {
        return experiment.empty() ? observable : experiment + '/' + observable;
    }
    /// Returns the number of measured runs without a value; only for a share.
    [[nodiscard]] std::size_t count() const;
    /// Returns the observable as shown to users: "angle", "surface@0.0042", "share without flow_time".
    [[nodiscard]] std::string shown_observable() const;
};

/// Returns the distance of fresh runs from the measurement in standard deviations, (mean - value)/sqrt(error^2 +
/// discrepancy^2 + scatter^2), with the standard deviation of the runs as scatter. Of a share of n measured runs and
/// the share of N fresh ones, with p of both together: the difference divided by sqrt(p (1 - p) (1/n + 1/N + 4
/// discrepancy^2)). Empty if fewer than two runs have an answer (NaN: no answer).
[[nodiscard]] std::optional<double> miss_of(const MeasuredTarget& target, std::span<const double> answers);

/// Largest miss of a calibration's measurements and the number of its target: |miss| for a scalar; for a curve the root
/// mean square of its places, at the first one. Empty if there was no check.
struct LargestMiss {
    double size = 0;
    std::size_t target = 0;
};
[[nodiscard]] std::optional<LargestMiss> largest_miss(std::span<const MeasuredTarget> targets,
                                                      std::span<const std::vector<double>> answers);
/// Largest miss, in standard deviations, at which fresh runs reproduce a measurement.
inline constexpr double largest_miss_allowed = 2;

/// Returns the covariance of measurement and discrepancy, row-major. Errors are independent. Discrepancies along a
/// curve have the correlation exp(-|x - x'|/L), L a quarter of the curve's length, because errors of the simulation are
/// similar at neighbouring points.
[[nodiscard]] std::vector<double> covariance_of(std::span<const MeasuredTarget> targets);

/// Convert targets to the one-line text of the option "targets" and back.
[[nodiscard]] std::string text_of(const std::vector<MeasuredTarget>& targets);
/// Reads such a text. Throws std::invalid_argument for any other text.
[[nodiscard]] std::vector<MeasuredTarget> targets_in(std::string_view text);

}  // namespace grainsweep::designs
