// Packing of whole numbers of a film's frames by zlib: positions, colours and slices.
//
// A column is frames x items of 16-bit numbers, frame by frame. Each number is written as its difference r to the same
// item of the frame before. In the first frame the difference is to the item before it, for the first item to 0.
// Differences are modulo 2^16 and folded: z = 2 r, or -2 r - 1 for r < 0. zlib packs the low bytes of all z, then the
// high bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace grainsweep::report {

/// Returns the packed column; `values`: complete frames of `items` each.
[[nodiscard]] std::string pack_film_column(std::span<const std::uint16_t> values, std::size_t items);

}  // namespace grainsweep::report
