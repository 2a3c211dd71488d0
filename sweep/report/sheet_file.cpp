#include "sweep/report/sheet_file.hpp"

#include "sweep/files/system_error.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xlsxwriter.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <string_view>
#include <vector>

namespace grainsweep::report {
namespace {

constexpr std::time_t no_time = 315'532'800;  // 1980-01-01, the first day of a ZIP archive

SystemError unwritten(std::string_view why) {
    return SystemError(fmt::format("the workbook cannot be written: {}", why));
}

void require(lxw_error error) {
    if (error != LXW_NO_ERROR) throw unwritten(lxw_strerror(error));
}

/// File without a name, which disappears when it is closed.
class NamelessFile {
public:
    NamelessFile() : file_(std::tmpfile()) {
        if (file_ == nullptr) throw unwritten(std::strerror(errno));
    }
    NamelessFile(const NamelessFile&) = delete;
    NamelessFile& operator=(const NamelessFile&) = delete;
    ~NamelessFile() { std::fclose(file_); }

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

struct FreeWorkbook {
    void operator()(lxw_workbook* unfinished) const { lxw_workbook_free(unfinished); }
};

class XlsxFile final : public SheetFile {
public:
    XlsxFile() {
        lxw_workbook_options options{};
        options.constant_memory = LXW_TRUE;  // rows go to a temporary file, not to memory
        book_.reset(workbook_new_opt(file_.path().c_str(), &options));
        if (book_ == nullptr) throw unwritten("out of memory");
        lxw_doc_properties properties{};
        properties.created = no_time;
        require(workbook_set_properties(book_.get(), &properties));
        bold_ = workbook_add_format(book_.get());
        format_set_bold(bold_);
    }

    std::size_t add_sheet(const char* name) override {
        auto* sheet = workbook_add_worksheet(book_.get(), name);
        if (sheet == nullptr) throw unwritten("out of memory");
        sheets_.push_back(sheet);
        return sheets_.size() - 1;
    }
    void freeze_first_row(std::size_t sheet) override { worksheet_freeze_panes(sheets_[sheet], 1, 0); }
    void set_width(std::size_t sheet, std::size_t column, double characters) override {
        const auto number = static_cast<lxw_col_t>(column);
        require(worksheet_set_column(sheets_[sheet], number, number, characters, nullptr));
    }
    void write_number(const Place& place, double number) override {
        require(worksheet_write_number(sheets_[place.sheet], static_cast<lxw_row_t>(place.row),
                                       static_cast<lxw_col_t>(place.column), number, nullptr));
    }
    void write_text(const Place& place, const std::string& text, Weight weight) override {
        require(worksheet_write_string(sheets_[place.sheet], static_cast<lxw_row_t>(place.row),
                                       static_cast<lxw_col_t>(place.column), text.c_str(),
                                       weight == Weight::bold ? bold_ : nullptr));
    }
    std::string finish() override {
        require(workbook_close(book_.release()));
        return file_.contents();
    }

private:
    NamelessFile file_;
    std::unique_ptr<lxw_workbook, FreeWorkbook> book_;
    lxw_format* bold_ = nullptr;
    std::vector<lxw_worksheet*> sheets_;
};

}  // namespace

std::unique_ptr<SheetFile> new_sheet_file() {
    return std::make_unique<XlsxFile>();
}

}  // namespace grainsweep::report
