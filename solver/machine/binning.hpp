// Equal bins of a coordinate, from the options of a probe.
#pragma once

#include "solver/machine/probe.hpp"

#include <cmath>
#include <cstddef>
#include <string>

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

[[nodiscard]] inline std::size_t bins_in(const Options& options) {
    return static_cast<std::size_t>(options.number("bins", default_bins));
}
/// Returns the bins between the options "from" and "to"; none if these are absent.
[[nodiscard]] inline Bins bins_along(const Options& options) {
    if (!options.has("from")) return {.low = 0, .high = 1, .count = 0};
    return {options.number("from"), options.number("to"), bins_in(options)};
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
