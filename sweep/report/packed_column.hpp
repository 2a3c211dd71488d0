// Columns of numbers in a page: a few bytes per case.
#pragma once

#include "sweep/report/table.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace grainsweep::report {

/// Base64 (RFC 4648, section 4).
[[nodiscard]] std::string base64(std::string_view bytes);

/// One of, in base64 where bytes are meant, little-endian:
///   {"of": [values], "u8": indices}   at most 256 different values, exact; NaN among them is null
///   {"f32": numbers}                  others, to seven digits
///   {"f64": numbers}                  whole numbers that seven digits do not hold, numbers beyond the range of float
[[nodiscard]] Json packed(std::span<const double> values);
[[nodiscard]] Json packed(std::span<const std::int64_t> values);
/// Words: {"of": [words], "u8": indices}. Throws std::length_error for more than 256 different words.
[[nodiscard]] Json packed(std::span<const std::string> words);
/// Ids of 32 hexadecimal digits as 16 bytes each, in base64. Throws std::invalid_argument for other texts.
[[nodiscard]] std::string packed_ids(std::span<const std::string> ids);

}  // namespace grainsweep::report
