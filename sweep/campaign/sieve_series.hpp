// Openings of test sieves by their numbers, and sizes on the phi scale.
#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace grainsweep::campaign {

/// Standards whose numbers of sieves are not their openings.
enum class SieveSeries { astm, tyler, british };
inline constexpr std::array<std::string_view, 3> sieve_series = {"astm", "tyler", "british"};

/// Returns the nominal opening in um of a sieve by its number: "No. 40" of ASTM E11 has 425 um; Tyler's 35 mesh has 425
/// um; the British 36 (BS 410) has 425 um. Absent: the series has no such sieve.
[[nodiscard]] std::optional<double> sieve_opening(SieveSeries series, double number);
/// Returns the nominal opening in um of a sieve of ASTM E11 by its size in inches (3/8 in: 9500 um). Absent: none.
[[nodiscard]] std::optional<double> inch_sieve_opening(double inches);
/// Returns the size in um on the phi scale of sediments: d = 2^-phi mm (Krumbein 1934).
[[nodiscard]] double phi_size(double phi);

}  // namespace grainsweep::campaign
