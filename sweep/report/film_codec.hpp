// Whole numbers over the frames of a film, packed: what positions, colours and slices of a page to watch travel in.
//
// A column is frames x items of 16-bit numbers, frame by frame. Each frame predicts every item in the one of three ways
// that leaves least, and the rest is written in Rice's code (Rice & Plaunt 1971, doi 10.1109/TCOM.1971.1090789), whose
// parameter is chosen for every group of 32 items; what does not move costs a sixth of a bit. Bits fill bytes from the
// lowest. Of each frame:
//   2 bits                       0: predicted by the item before it in the frame (the first one by 0)
//                                1: by the item in the frame before
//                                2: by the line through the two frames before, between 0 and 65535
//   per group: 5 bits k          31: all its items are as predicted, nothing follows
//     per item: z = 2 r, or -2 r - 1 for r < 0, of the rest r
//       z >> k < 24              so many zeros and a one, then k bits
//       otherwise                24 zeros and a one, then the 17 bits of z
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace grainsweep::report {

/// values: a whole number of frames of `items` each.
[[nodiscard]] std::string pack_film_column(std::span<const std::uint16_t> values, std::size_t items);

}  // namespace grainsweep::report
