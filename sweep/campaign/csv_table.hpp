// A CSV file of numbers or words under a header (RFC 4180), record by record.
#pragma once

#include "sweep/campaign/csv_record.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// Empty lines are passed over. What is no such table is refused: a first line of numbers, a column without a name (row
/// names, as data frames are written), a name twice, another separator, a record of another length, UTF-16.
class CsvTable {
public:
    /// Throws the refusal of a rule.
    using Refuse = std::function<void(const std::string& rule)>;

    /// `text` must outlive the table.
    CsvTable(std::string_view text, Refuse refuse);
    [[nodiscard]] const CsvRecord& header() const { return header_; }
    /// As long as the header; nothing behind the last one.
    [[nodiscard]] std::optional<CsvRecord> next();
    /// Of the record read last; the first line of the file is 1.
    [[nodiscard]] std::size_t number() const { return number_; }

private:
    [[nodiscard]] std::optional<CsvRecord> take();
    void check_header() const;

    std::string_view rest_;
    Refuse refuse_;
    std::size_t number_ = 0;
    CsvRecord header_;
};

}  // namespace grainsweep::campaign
