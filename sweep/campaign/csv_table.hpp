// A CSV file of numbers or words under a header (RFC 4180), record by record.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Record of cells, without blanks around them.
using CsvRecord = std::vector<std::string>;

/// Takes one record from `rest`, which advances behind its line end. Quoted cells may contain separators and line ends.
[[nodiscard]] CsvRecord take_csv_record(std::string_view& rest, char separator = ',');

/// Table with a header. Empty lines are skipped. Refused are a first line of numbers, a column without a name (row
/// names of data frames), a repeated name, another separator, a record of another length, and UTF-16.
class CsvTable {
public:
    /// Function that throws the refusal of a rule.
    using Refuse = std::function<void(const std::string& rule)>;

    /// `text` must outlive the table. `separator`: of the columns; empty: the first of tabulator, semicolon and comma
    /// that the header has.
    CsvTable(std::string_view text, Refuse refuse, std::optional<char> separator = ',');
    [[nodiscard]] const CsvRecord& header() const { return header_; }
    /// Returns the next record, as long as the header; empty after the last one.
    [[nodiscard]] std::optional<CsvRecord> next();
    /// Returns the line of the last record; the first line of the file is 1.
    [[nodiscard]] std::size_t number() const { return number_; }

private:
    [[nodiscard]] std::optional<CsvRecord> take();
    void check_header() const;

    std::string_view rest_;
    Refuse refuse_;
    char separator_ = ',';
    std::size_t number_ = 0;
    CsvRecord header_;
};

}  // namespace grainsweep::campaign
