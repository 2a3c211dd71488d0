#include "sweep/campaign/csv_table.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/json_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace grainsweep::campaign {
namespace {

/// Returns whether the cell is a number, or a number as other programs write it: +1, 1.0D+03, nan.
bool is_number(std::string_view cell) {
    const bool begins = !cell.empty() && std::string_view("+-.0123456789").find(cell.front()) != std::string_view::npos;
    const bool digits = cell.find_first_of("0123456789") != std::string_view::npos;
    return any_number_in(cell) ||
           (begins && digits && cell.find_first_not_of("+-.0123456789eEdD") == std::string::npos);
}

char separator_in(std::string_view text) {
    const auto header = text.substr(0, text.find('\n', std::min(text.find_first_not_of("\r\n"), text.size())));
    for (const char mark : {'\t', ';'})
        if (header.find(mark) != std::string_view::npos) return mark;
    return ',';
}

}  // namespace

CsvTable::CsvTable(std::string_view text, Refuse refuse, std::optional<char> separator)
    : rest_(text), refuse_(std::move(refuse)), separator_(separator.value_or(separator_in(text))) {
    if (rest_.starts_with("\xFF\xFE") || rest_.starts_with("\xFE\xFF"))
        refuse_("the file must be UTF-8 text, not UTF-16");
    if (rest_.starts_with("\xEF\xBB\xBF")) rest_.remove_prefix(3);
    header_ = take().value_or(CsvRecord{""});
    check_header();
}

std::optional<CsvRecord> CsvTable::take() {
    while (!rest_.empty()) {
        ++number_;
        auto record = take_csv_record(rest_, separator_);
        for (auto& cell : record)  // "'-x" of a table that query wrote: see report/table.cpp
            if (cell.starts_with('\'') && std::string_view("=+-@").find(cell[1]) != std::string_view::npos)
                cell.erase(0, 1);
        if (record != CsvRecord{""}) return record;
    }
    return std::nullopt;
}

void CsvTable::check_header() const {
    if (header_ == CsvRecord{""}) refuse_("the file is empty; a header and records are expected");
    for (const auto& [mark, name] : {std::pair(';', "semicolons"), std::pair('\t', "tabs")})
        if (std::ranges::any_of(header_, [mark = mark](const auto& cell) { return cell.find(mark) != cell.npos; }))
            refuse_(
                fmt::format("its header has {} between the columns; commas are expected, and points in numbers", name));
    for (std::size_t k = 0; k < header_.size(); ++k) {
        if (is_number(header_[k]))
            refuse_(fmt::format("its first line has the number {}; a header that names the columns is expected",
                                shown(header_[k])));
        if (header_[k].empty())
            refuse_(fmt::format("column {} of its header has no name; leave out row names and empty columns", k + 1));
        if (std::ranges::count(header_, header_[k]) > 1)
            refuse_(fmt::format("its header names '{}' twice", header_[k]));
    }
}

std::optional<CsvRecord> CsvTable::next() {
    auto record = take();
    if (record && record->size() != header_.size())
        refuse_(fmt::format("record {} has {} cells and the header {}", number_, record->size(), header_.size()));
    return record;
}

CsvRecord take_csv_record(std::string_view& rest, char separator) {
    CsvRecord record(1);
    bool quoted = false;
    std::size_t k = 0;
    for (; k < rest.size(); ++k) {
        const char c = rest[k];
        if (quoted && c == '"' && k + 1 < rest.size() && rest[k + 1] == '"') {
            record.back() += rest[++k];
        } else if (c == '"') {
            quoted = !quoted;
        } else if (!quoted && c == separator) {
            record.emplace_back();
        } else if (!quoted && c == '\n') {
            break;
        } else if (quoted || c != '\r') {
            record.back() += c;
        }
    }
    rest.remove_prefix(std::min(k + 1, rest.size()));
    for (auto& cell : record) cell = trimmed(cell);
    return record;
}

}  // namespace grainsweep::campaign
