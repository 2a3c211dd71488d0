// Equal bins of a coordinate, from the options of a probe.
#pragma once

#include "solver/machine/probe.hpp"

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::machine {

struct Bins {
    double low = 0, high = 0;
    std::size_t count = 20;

    [[nodiscard]] double width() const { return (high - low) / static_cast<double>(count); }
    /// Returns the bin of a value, or `count` outside all bins.
    [[nodiscard]] std::size_t at(double x) const {
        const double place = std::floor((x - low) / width());
        return place >= 0 && place < static_cast<double>(count) ? static_cast<std::size_t>(place) : count;
    }
    [[nodiscard]] double centre(std::size_t bin) const { return low + (static_cast<double>(bin) + 0.5) * width(); }
};

inline constexpr double default_bins = 20;
inline constexpr Field bins_option =
    option("bins", Field::Kind::quantity, "1", "number of bins; default: 20", false, {1, 1e5});

inline constexpr Field coordinate_option =
    option("along", Field::Kind::direction, "", "the direction of the coordinate", true);
inline constexpr Field first_bin_option =
    option("from", Field::Kind::quantity, "m", "where the first bin begins", true);
inline constexpr Field last_bin_option = option("to", Field::Kind::quantity, "m", "where the last bin ends", true);

[[nodiscard]] inline std::size_t bins_in(const Options& options) {
    return static_cast<std::size_t>(options.number("bins", default_bins));
}
/// Returns the bins between the options "from" and "to"; none if these are absent.
[[nodiscard]] inline Bins bins_along(const Options& options) {
    if (!options.has("from")) return {.low = 0, .high = 1, .count = 0};
    return {options.number("from"), options.number("to"), bins_in(options)};
}

/// Appends the value of every bin, at its centre.
template <class Value>
void append_bins(std::vector<Sample>& into, const Bins& bins, Value&& value) {
    for (std::size_t b = 0; b < bins.count; ++b) into.push_back({.bin = bins.centre(b), .value = value(b)});
}
/// Appends the probability density of values divided by a unit; values outside all bins count in their number only.
inline void append_density(std::vector<Sample>& into, const Bins& bins, std::span<const double> values, double unit) {
    std::vector<double> numbers(bins.count, 0.0);
    for (const double x : values)
        if (const std::size_t bin = bins.at(x / unit); bin < bins.count) numbers[bin] += 1;
    append_bins(into, bins,
                [&](std::size_t b) { return numbers[b] / (static_cast<double>(values.size()) * bins.width()); });
}

/// Returns the error of "bins" and their ends, in one sentence; empty: none.
[[nodiscard]] inline std::string flaw_of_bins(const Options& given, double from, double to) {
    if (!(from < to)) return "\"from\" of a profile must lie below \"to\"";
    const double bins = given.number("bins", default_bins);
    return bins == std::floor(bins) ? "" : "\"bins\" must be a whole number";
}
[[nodiscard]] inline std::string flaw_of_bins_along(const Options& given) {
    return flaw_of_bins(given, given.number("from"), given.number("to"));
}

}  // namespace grainsweep::machine
