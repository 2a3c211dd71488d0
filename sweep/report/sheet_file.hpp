// Workbook file as its library (libxlsxwriter) writes it: cells, without the rules of workbook.hpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace grainsweep::report {

class SheetFile {
public:
    enum class Weight { plain, bold };
    struct Place {
        std::size_t sheet;
        std::int64_t row;
        std::size_t column;
    };

    SheetFile() = default;
    SheetFile(const SheetFile&) = delete;
    SheetFile& operator=(const SheetFile&) = delete;
    virtual ~SheetFile() = default;

    /// Returns the number of the new sheet.
    virtual std::size_t add_sheet(const char* name) = 0;
    virtual void freeze_first_row(std::size_t sheet) = 0;
    /// `characters`: width of the column.
    virtual void set_width(std::size_t sheet, std::size_t column, double characters) = 0;
    /// Rows must be written from top to bottom.
    virtual void write_number(const Place& place, double number) = 0;
    virtual void write_text(const Place& place, const std::string& text, Weight weight) = 0;
    /// Returns the bytes of the file. Nothing may be written afterwards.
    [[nodiscard]] virtual std::string finish() = 0;
};

/// Returns an empty workbook file. It and its functions throw SystemError if there is no room for temporary files.
[[nodiscard]] std::unique_ptr<SheetFile> new_sheet_file();

}  // namespace grainsweep::report
