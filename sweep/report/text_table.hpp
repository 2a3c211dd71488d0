// Table as aligned text that fits a width. The first sufficient measure is used:
//
//   cells of text are wrapped, and headings behind an underscore
//   columns with the same value in every row are printed in one line below
//   case ids are shortened to their beginning, which every command accepts
//   columns are left out, and a line below names them: whole numbers beyond 2^53 (seeds), then columns on how a case
//     was computed (wall_seconds, attempts), then from the right
//
// Numbers are aligned to the right and never broken. They have 6 digits, or up to 12 in a column where two neighbours
// would else look alike.
#pragma once

#include "sweep/store/store.hpp"

#include <cstddef>
#include <iosfwd>
#include <string>

namespace grainsweep::report {

/// Writes the table with lines of at most `width` columns.
void write_text(std::ostream& out, const store::Table& table, std::size_t width);

/// Returns a cell on one line: numbers to 6 digits, control characters made visible, empty for an absent value.
[[nodiscard]] std::string cell_text(const store::Table::Cell& cell);

}  // namespace grainsweep::report
