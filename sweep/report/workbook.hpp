// Workbook of rows for spreadsheets (Office Open XML, .xlsx).
//
//   numbers       numeric cells with 16 significant digits, the most that the library writes; csv and json have 17
//   whole numbers text beyond 2^53 (seeds), because a spreadsheet's numbers are doubles
//   infinities    the texts "inf" and "-inf", because a cell cannot have such a number
//   NULL          an empty cell
//   texts         never a formula; cut after 32,767 characters, the most of a cell
//
// The same rows give the same bytes, because the file has no time of writing.
#pragma once

#include "sweep/store/store.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace grainsweep::report {

class Workbook {
public:
    Workbook();
    Workbook(const Workbook&) = delete;
    Workbook& operator=(const Workbook&) = delete;
    ~Workbook();

    /// Writes the fixed first row of the sheet "rows". `units`: one per column, empty if unknown.
    void begin(const std::vector<std::string>& columns, const std::vector<std::string>& units);
    /// Adds a row. Throws InputError beyond 1,048,575 rows, the most of a sheet.
    void add(const std::vector<store::Table::Cell>& row);
    /// Returns the number of texts cut so far.
    [[nodiscard]] std::int64_t cut_texts() const;
    /// Returns the bytes of the file, with the second sheet "provenance". No row may be added afterwards. Throws
    /// SystemError if there is no room for temporary files.
    [[nodiscard]] std::string finish(const store::Table& provenance);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace grainsweep::report
