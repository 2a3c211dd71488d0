// Cells of Excel workbooks (.xlsx, ECMA-376) as lines of text with tabs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Sheet of a workbook: one line per row, from row 1; tabs between cells; numbers with decimal points.
struct WorkbookSheet {
    std::string name, text;
};

/// Returns whether the bytes begin as an archive does, of which .xlsx and .ods are kinds.
[[nodiscard]] bool is_archive(std::string_view bytes);
/// Returns the sheets with cells, in the order of the workbook. Throws InputError if the archive is damaged or holds no
/// Excel workbook.
[[nodiscard]] std::vector<WorkbookSheet> workbook_sheets(std::string_view bytes);

}  // namespace grainsweep::campaign
