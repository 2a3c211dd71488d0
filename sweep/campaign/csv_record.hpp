// CSV by RFC 4180, record by record.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Record of cells, without blanks around them.
using CsvRecord = std::vector<std::string>;

/// Takes one record from `rest`, which advances behind its line end. Quoted cells may contain separators and line ends.
[[nodiscard]] CsvRecord take_csv_record(std::string_view& rest, char separator = ',');

}  // namespace grainsweep::campaign
