// Numbers with a unit, as an engineer writes them: "60 um", "150 mm/s", "35 kJ/m3".
#pragma once

#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::campaign {

/// Converts a number, with or without a unit, to `unit`; a number without a unit is already in `unit`. If the text is
/// invalid, returns the reason as a part of a sentence with the nearest suitable unit. Thread-safe.
///
/// - Decimal factors are exact: "60 um" in m is the double nearest to 60e-6.
/// - Angles are no pure numbers: "30 deg" is refused for a friction coefficient, and "10 %" for an angle.
/// - A frequency counts turns: 20 rpm is 20 1/min, 2 Hz is 120 rpm, 1 rad/s is 1/(2 pi) Hz.
/// - Only a place in rad/s refuses "Hz" and "1/s", because many authors write 1/s for rad/s.
/// - Units: UDUNITS-2, whose database is read at the first unit, and deg, rev and the permille sign.
[[nodiscard]] std::variant<double, std::string> in_si(std::string_view text, std::string_view unit);

/// Returns whether in_si converts numbers in `from` to `to`; it makes no sentence where not.
[[nodiscard]] bool is_convertible(std::string_view from, std::string_view to);

/// Returns the text with a point where a decimal comma stands, for "30,5 mm"; empty: no comma stands between digits, or
/// brackets do, whose commas separate.
[[nodiscard]] std::string with_decimal_point(std::string_view text);

/// Head of a column, "gap [mm]" or "gap (mm)": the name, and what the brackets at its end hold; a degree sign is deg.
struct ColumnHead {
    std::string name, unit;
};
[[nodiscard]] ColumnHead column_head(std::string_view head);

/// Returns the unit of a quantity as written, a part of `text`; empty without one or without a number.
[[nodiscard]] std::string_view unit_of_quantity(std::string_view text);

/// Returns whether a text whose parameter states no unit is a number and a unit all the same: "2 mm", "35kPa". "2d" and
/// "3rd" are words.
[[nodiscard]] bool resembles_united_number(std::string_view text);

/// Returns whether numbers in `unit` are those in SI units: true for "m", "N", "1" and for words that are no unit;
/// false for "mm", "%" and "degC".
[[nodiscard]] bool is_si_unit(std::string_view unit);

}  // namespace grainsweep::campaign
