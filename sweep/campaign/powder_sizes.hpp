// Sizes of a powder file as a table. Internal to the reader of powders.
#pragma once

#include "solver/particles/size_table.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/powder.hpp"

namespace grainsweep::campaign {

/// Returns a positive number in `unit`; the text may have another unit.
[[nodiscard]] double powder_number(const Cursor& place, std::string_view unit);
/// Reads "sizes" and "cut" into the powder; `read` returns the contents of the file that "sizes" names.
void read_powder_sizes(const Section& top, const std::function<std::string(const std::string&)>& read, Powder& powder);

}  // namespace grainsweep::campaign
