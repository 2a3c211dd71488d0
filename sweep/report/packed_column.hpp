// Packed columns of numbers in a page, with a few bytes per case.
#pragma once

#include "sweep/report/table.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace grainsweep::report {

/// Returns base64 (RFC 4648, section 4).
[[nodiscard]] std::string base64(std::string_view bytes);
/// Returns the bytes packed by zlib (RFC 1950), as small as it can.
[[nodiscard]] std::string deflated(std::string_view bytes);

/// Returns a column of a film, packed; `values`: complete frames of `items` each.
///
/// Each number is written as its difference r to the same item of the frame before; in the first frame to the item
/// before it, for the first item to 0. Differences are modulo 2^16 and folded: z = 2 r, or -2 r - 1 for r < 0. zlib
/// packs the low bytes of all z, then the high bytes.
[[nodiscard]] std::string pack_film_column(std::span<const std::uint16_t> values, std::size_t items);

/// Returns one of these forms, with bytes in base64, little-endian:
///   {"of": [values], "u8": indices}   at most 256 different values, exact; NaN among them is null
///   {"f32": numbers}                  other numbers, to seven digits
///   {"f64": numbers}                  whole numbers with more than seven digits, and numbers beyond the range of float
[[nodiscard]] Json packed(std::span<const double> values);
[[nodiscard]] Json packed(std::span<const std::int64_t> values);
/// Returns words as {"of": [words], "u8": indices}. Throws std::length_error for more than 256 different words.
[[nodiscard]] Json packed(std::span<const std::string> words);
/// Returns ids of 32 hexadecimal digits as 16 bytes each, in base64. Throws std::invalid_argument for other texts.
[[nodiscard]] std::string packed_ids(std::span<const std::string> ids);

}  // namespace grainsweep::report
