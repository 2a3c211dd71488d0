#include "sweep/report/workbook.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/visible_text.hpp"
#include "sweep/report/sheet_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::report {
namespace {

using Cell = store::Table::Cell;

constexpr std::int64_t longest_text = 32'767, most_rows = 1'048'575;
constexpr std::size_t narrowest_column = 7, widest_column = 48, digits_in_view = 11;

/// The first `most` characters of a UTF-8 text.
std::string beginning(const std::string& text, std::int64_t most) {
    std::int64_t characters = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const bool starts = (static_cast<unsigned char>(text[at]) & 0xC0U) != 0x80U;
        if (starts && ++characters > most) return text.substr(0, at);
    }
    return text;
}

/// Replaces the two characters that are UTF-8 and no text of XML (XML 1.0, section 2.2): U+FFFE and U+FFFF.
std::string allowed_in_xml(std::string text) {
    for (std::size_t at = 0; (at = text.find("\xEF\xBF", at)) != std::string::npos; at += 2)
        if (at + 2 < text.size() && static_cast<unsigned char>(text[at + 2]) >= 0xBEU) text[at + 2] = '\xBD';
    return text;
}

}  // namespace

// Not in the namespace without a name: Parts, which has linkage, holds them.

/// A sheet in which rows are written from top to bottom, and how wide its columns have to be.
class WorkbookSheet {
public:
    WorkbookSheet(SheetFile& file, const char* name) : file_(&file), sheet_(file.add_sheet(name)) {}

    void begin(const std::vector<std::string>& titles) {
        widths_.assign(titles.size(), narrowest_column);
        for (std::size_t j = 0; j < titles.size(); ++j) write_text(j, titles[j], SheetFile::Weight::bold);
        file_->freeze_first_row(sheet_);
        ++row_;
    }
    void add(const std::vector<Cell>& row) {
        if (row_ > most_rows)
            throw campaign::input_error("--format", "'xlsx'",
                                        fmt::format("a sheet holds {} rows and the answer has more; take csv or "
                                                    "json, or add LIMIT to the statement",
                                                    most_rows));
        for (std::size_t j = 0; j < row.size(); ++j) std::visit([&](const auto& held) { write(j, held); }, row[j]);
        ++row_;
    }
    void set_widths() {
        for (std::size_t j = 0; j < widths_.size(); ++j)
            file_->set_width(sheet_, j, static_cast<double>(widths_[j]) + 2);
    }
    [[nodiscard]] std::int64_t cut_texts() const { return cut_; }

private:
    void write(std::size_t, std::monostate) {}
    void write(std::size_t column, std::int64_t whole) {
        constexpr std::int64_t exact = std::int64_t{1} << 53U;
        if (whole < -exact || whole > exact) return write_text(column, std::to_string(whole));
        write_number(column, static_cast<double>(whole), std::to_string(whole).size());
    }
    void write(std::size_t column, double real) {
        if (std::isnan(real)) return;
        if (std::isinf(real)) return write_text(column, real > 0 ? "inf" : "-inf");
        write_number(column, real, std::min(campaign::shortest(real).size(), digits_in_view));
    }
    void write(std::size_t column, const std::string& text) { write_text(column, text); }

    void write_number(std::size_t column, double number, std::size_t width) {
        widen(column, width);
        file_->write_number({sheet_, row_, column}, number);
    }
    void write_text(std::size_t column, const std::string& text, SheetFile::Weight weight = SheetFile::Weight::plain) {
        const std::string shown = allowed_in_xml(campaign::valid_utf8(campaign::visible(text)));
        const std::string held = beginning(shown, longest_text);
        if (held.size() < shown.size()) ++cut_;
        widen(column, held.find('\n') == std::string::npos ? held.size() : widest_column);
        file_->write_text({sheet_, row_, column}, held, weight);
    }
    void widen(std::size_t column, std::size_t width) {
        widths_[column] = std::max(widths_[column], std::min(width, widest_column));
    }

    SheetFile* file_;
    std::size_t sheet_;
    std::vector<std::size_t> widths_;
    std::int64_t row_ = 0, cut_ = 0;
};

struct Workbook::Parts {
    std::unique_ptr<SheetFile> file = new_sheet_file();
    WorkbookSheet rows{*file, "rows"};
};

Workbook::Workbook() : parts_(std::make_unique<Parts>()) {}
Workbook::~Workbook() = default;

void Workbook::begin(const std::vector<std::string>& columns, const std::vector<std::string>& units) {
    std::vector<std::string> titles;
    for (std::size_t j = 0; j < columns.size(); ++j)
        titles.push_back(units[j].empty() ? columns[j] : fmt::format("{} ({})", columns[j], units[j]));
    parts_->rows.begin(titles);
}

void Workbook::add(const std::vector<Cell>& row) {
    parts_->rows.add(row);
}

std::int64_t Workbook::cut_texts() const {
    return parts_->rows.cut_texts();
}

std::string Workbook::finish(const store::Table& provenance) {
    WorkbookSheet second(*parts_->file, "provenance");
    second.begin(provenance.columns);
    for (const auto& row : provenance.rows) second.add(row);
    for (WorkbookSheet* sheet : {&parts_->rows, &second}) sheet->set_widths();
    return parts_->file->finish();
}

}  // namespace grainsweep::report
