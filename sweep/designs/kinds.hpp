// What the files of designs share. A design is a file in kinds/ (listed.cpp.in).
#pragma once

#include "sweep/designs/design.hpp"

namespace grainsweep::designs {

/// Random streams of designs, so that two kinds never share a draw of the campaign's seed.
enum class DrawPurpose : std::uint64_t { random = 1, latin_hypercube = 2, sobol = 3, morris = 4, calibration = 5 };

/// Returns the initial state of a generator for a purpose and up to three whole numbers, chained through SplitMix64.
[[nodiscard]] std::uint64_t draw_key(std::uint64_t seed, DrawPurpose purpose, std::uint64_t a, std::uint64_t b = 0,
                                     std::uint64_t c = 0);

inline constexpr Interval any_number{};
/// Returns the field of a whole number; without a default it is required.
[[nodiscard]] constexpr Field count_field(std::string_view name, double low, double high, std::string_view standard,
                                          std::string_view meaning) {
    return {name, Field::Kind::whole, meaning, standard, {low, high}, {}, standard.empty()};
}
/// Returns the option "points" of sampling designs.
[[nodiscard]] OptionSpec points_option(std::string_view meaning);
/// Returns the value of this option.
[[nodiscard]] std::int64_t points_asked(const DesignRequest& request);

/// Allocates points x dimensions coordinates. Throws std::invalid_argument for more than 2^28 coordinates (2 GiB).
[[nodiscard]] std::vector<double> room_for(std::int64_t points, std::size_t dimensions);

}  // namespace grainsweep::designs
