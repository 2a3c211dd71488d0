#include "sweep/report/workbook.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/visible_text.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/files/broken_world.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xlsxwriter.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <utility>

namespace grainsweep::report {
namespace {

using Cell = store::Table::Cell;

constexpr std::int64_t longest_text = 32'767, most_rows = 1'048'575;
constexpr std::size_t narrowest_column = 7, widest_column = 48, digits_in_view = 11;
constexpr std::time_t no_time = 315'532'800;  // 1980-01-01, the first day of a ZIP archive

BrokenWorld unwritten(std::string_view why) {
    return BrokenWorld(fmt::format("the workbook cannot be written: {}", why));
}

void require(lxw_error error) {
    if (error != LXW_NO_ERROR) throw unwritten(lxw_strerror(error));
}

/// The first `most` characters of a UTF-8 text.
std::string beginning(const std::string& text, std::int64_t most) {
    std::int64_t characters = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        const bool starts = (static_cast<unsigned char>(text[at]) & 0xC0U) != 0x80U;
        if (starts && ++characters > most) return text.substr(0, at);
    }
    return text;
}

}  // namespace

// Not in the namespace without a name: Parts, which has linkage, holds them.

/// File without a name, which disappears when it is closed.
class WorkbookFile {
public:
    WorkbookFile() : file_(std::tmpfile()) {
        if (file_ == nullptr) throw unwritten(std::strerror(errno));
    }
    WorkbookFile(const WorkbookFile&) = delete;
    WorkbookFile& operator=(const WorkbookFile&) = delete;
    ~WorkbookFile() { std::fclose(file_); }

    /// A path that this process can open.
    [[nodiscard]] std::string path() const { return fmt::format("/proc/self/fd/{}", ::fileno(file_)); }
    [[nodiscard]] std::string contents() const {
        struct stat facts {};
        if (::fstat(::fileno(file_), &facts) != 0) throw unwritten(std::strerror(errno));
        std::string bytes(static_cast<std::size_t>(facts.st_size), '\0');
        std::rewind(file_);
        if (std::fread(bytes.data(), 1, bytes.size(), file_) != bytes.size()) throw unwritten(std::strerror(errno));
        return bytes;
    }

private:
    std::FILE* file_;
};

/// A sheet in which rows are written from top to bottom, and how wide its columns have to be.
class WorkbookSheet {
public:
    WorkbookSheet(lxw_workbook* book, const char* name) : sheet_(workbook_add_worksheet(book, name)) {
        if (sheet_ == nullptr) throw unwritten("out of memory");
    }

    void begin(const std::vector<std::string>& titles, lxw_format* bold) {
        widths_.assign(titles.size(), narrowest_column);
        for (std::size_t j = 0; j < titles.size(); ++j) write_text(j, titles[j], bold);
        worksheet_freeze_panes(sheet_, 1, 0);
        ++row_;
    }
    void add(const std::vector<Cell>& row) {
        if (row_ > most_rows)
            throw campaign::wrong_question("--format", "'xlsx'",
                                           fmt::format("a sheet holds {} rows and the answer has more; take csv or "
                                                       "json, or add LIMIT to the statement",
                                                       most_rows));
        for (std::size_t j = 0; j < row.size(); ++j) std::visit([&](const auto& held) { write(j, held); }, row[j]);
        ++row_;
    }
    void set_widths() {
        for (std::size_t j = 0; j < widths_.size(); ++j) {
            const auto column = static_cast<lxw_col_t>(j);
            require(worksheet_set_column(sheet_, column, column, static_cast<double>(widths_[j]) + 2, nullptr));
        }
    }
    [[nodiscard]] std::int64_t cut_texts() const { return cut_; }

private:
    void write(std::size_t, std::monostate) {}
    void write(std::size_t column, std::int64_t whole) {
        constexpr std::int64_t exact = std::int64_t{1} << 53U;
        if (whole < -exact || whole > exact) return write_text(column, std::to_string(whole), nullptr);
        write_number(column, static_cast<double>(whole), std::to_string(whole).size());
    }
    void write(std::size_t column, double real) {
        if (std::isnan(real)) return;
        if (std::isinf(real)) return write_text(column, real > 0 ? "inf" : "-inf", nullptr);
        write_number(column, real, std::min(campaign::shortest(real).size(), digits_in_view));
    }
    void write(std::size_t column, const std::string& text) {
        write_text(column, campaign::valid_utf8(campaign::visible(text)), nullptr);
    }

    void write_number(std::size_t column, double number, std::size_t width) {
        widen(column, width);
        require(worksheet_write_number(sheet_, static_cast<lxw_row_t>(row_), static_cast<lxw_col_t>(column), number,
                                       nullptr));
    }
    void write_text(std::size_t column, const std::string& text, lxw_format* format) {
        const std::string held = beginning(text, longest_text);
        if (held.size() < text.size()) ++cut_;
        widen(column, held.find('\n') == std::string::npos ? held.size() : widest_column);
        require(worksheet_write_string(sheet_, static_cast<lxw_row_t>(row_), static_cast<lxw_col_t>(column),
                                       held.c_str(), format));
    }
    void widen(std::size_t column, std::size_t width) {
        widths_[column] = std::max(widths_[column], std::min(width, widest_column));
    }

    lxw_worksheet* sheet_;
    std::vector<std::size_t> widths_;
    std::int64_t row_ = 0, cut_ = 0;
};

struct Workbook::Parts {
    struct Free {
        void operator()(lxw_workbook* unfinished) const { lxw_workbook_free(unfinished); }
    };
    WorkbookFile file;
    std::unique_ptr<lxw_workbook, Free> book;
    lxw_format* bold;
    std::unique_ptr<WorkbookSheet> rows;

    Parts() {
        lxw_workbook_options options{};
        options.constant_memory = LXW_TRUE;  // rows go to a temporary file, not to memory
        book.reset(workbook_new_opt(file.path().c_str(), &options));
        if (book == nullptr) throw unwritten("out of memory");
        lxw_doc_properties properties{};
        properties.created = no_time;
        require(workbook_set_properties(book.get(), &properties));
        bold = workbook_add_format(book.get());
        format_set_bold(bold);
        rows = std::make_unique<WorkbookSheet>(book.get(), "rows");
    }
};

Workbook::Workbook() : parts_(std::make_unique<Parts>()) {}
Workbook::~Workbook() = default;

void Workbook::begin(const std::vector<std::string>& columns, const std::vector<std::string>& units) {
    std::vector<std::string> titles;
    for (std::size_t j = 0; j < columns.size(); ++j)
        titles.push_back(units[j].empty() ? columns[j] : fmt::format("{} ({})", columns[j], units[j]));
    parts_->rows->begin(titles, parts_->bold);
}

void Workbook::add(const std::vector<Cell>& row) {
    parts_->rows->add(row);
}

std::int64_t Workbook::cut_texts() const {
    return parts_->rows->cut_texts();
}

std::string Workbook::finish(const store::Table& provenance) {
    WorkbookSheet second(parts_->book.get(), "provenance");
    second.begin(provenance.columns, parts_->bold);
    for (const auto& row : provenance.rows) second.add(row);
    for (WorkbookSheet* sheet : {parts_->rows.get(), &second}) sheet->set_widths();
    require(workbook_close(parts_->book.release()));
    return parts_->file.contents();
}

}  // namespace grainsweep::report
