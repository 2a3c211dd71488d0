// Rows as a workbook that spreadsheets read (Office Open XML, .xlsx).
//
//   numbers       cells of numbers with 16 significant digits, which is what the library writes; csv and json have 17
//   whole numbers beyond 2^53 (seeds) are text, because a spreadsheet's numbers are doubles
//   infinities    the texts "inf" and "-inf": a cell has no such number
//   NULL          an empty cell
//   texts         never a formula; one beyond 32,767 characters, the most that a cell holds, is cut
//
// The same rows give the same bytes: the file holds no time of writing.
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

    /// Writes the first row of the sheet "rows", which stays in view. `units`: one per column, empty where unknown.
    void begin(const std::vector<std::string>& columns, const std::vector<std::string>& units);
    /// Throws WrongQuestion beyond 1,048,575 rows, the most that a sheet holds.
    void add(const std::vector<store::Table::Cell>& row);
    /// Texts that were cut so far.
    [[nodiscard]] std::int64_t cut_texts() const;
    /// Returns the bytes of the file, with the second sheet "provenance". Nothing may be added any more. Throws
    /// BrokenWorld where there is no room for temporary files.
    [[nodiscard]] std::string finish(const store::Table& provenance);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace grainsweep::report
