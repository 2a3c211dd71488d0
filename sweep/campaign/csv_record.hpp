// CSV by RFC 4180, record by record.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Cells without blanks around them.
using CsvRecord = std::vector<std::string>;

/// One record from `rest`, which advances behind its line end. Quoted cells may hold commas and line ends.
[[nodiscard]] CsvRecord take_csv_record(std::string_view& rest);

}  // namespace grainsweep::campaign
