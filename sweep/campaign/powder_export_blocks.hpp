// Blocks of numeric lines in the text of an export. Internal to the import of sizes.
#pragma once

#include "sweep/campaign/powder_export.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign::export_blocks {

using Lines = std::vector<std::string>;
using Cells = std::vector<std::string>;

/// Consecutive lines of numbers under one reading of the text.
struct Block {
    char separator = ',';
    bool decimal_comma = false;
    std::size_t first = 0, rows = 0, width = 0, numbers = 0;
};

[[nodiscard]] Lines lines_of(const std::string& text);
/// Returns the cells of a line; a blank as separator stands for any number of blanks. A line that is longer than any of
/// an export has none.
[[nodiscard]] Cells cells_of_line(std::string_view line, char separator);
/// Returns all blocks of two or more rows under a reading. A line with only a size continues a block: it is the last
/// edge of classes.
[[nodiscard]] std::vector<Block> blocks_of(const Lines& lines, char separator, bool decimal_comma);
/// Reads names of the columns from the lines directly above the block, the names' own and the units' below them;
/// returns the first of these lines.
std::size_t read_headers(const Lines& lines, const Block& block, std::vector<std::string>& headers);

}  // namespace grainsweep::campaign::export_blocks
