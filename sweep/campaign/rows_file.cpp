// Listed rows from CSV (RFC 4180): a header that names the factors in any order, then one point a line.
#include "sweep/campaign/csv_record.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/campaign/wrong_question.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

namespace grainsweep::campaign {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_rows_file = 256ULL << 20U;

using Record = CsvRecord;

std::string read_text(const Cursor& file, const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) file.refuse("there is no such file beside the campaign file");
    if (fs::file_size(path, error) > largest_rows_file || error)
        file.refuse("the file must be readable and at most 256 MiB");
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(path.c_str(), "rb"), std::fclose);
    if (!stream) file.refuse(fmt::format("'{}' cannot be read: {}", path.string(), std::strerror(errno)));
    std::string text;
    std::array<char, 65536> part{};
    for (std::size_t got = 1; got > 0;) {
        got = std::fread(part.data(), 1, part.size(), stream.get());
        text.append(part.data(), got);
    }
    if (std::ferror(stream.get()) != 0) {  // what was read is a part, and would pass for a shorter list
        const std::string why = std::strerror(errno);
        file.refuse(fmt::format("'{}' cannot be read beyond line {}: {}", path.string(),
                                1 + std::ranges::count(text, '\n'), why));
    }
    constexpr std::string_view utf8_mark = "\xEF\xBB\xBF";
    if (text.starts_with(utf8_mark)) text.erase(0, utf8_mark.size());
    return text;
}

/// For each factor the column that holds it.
std::vector<std::size_t> columns_of(const Cursor& file, const Record& header, const ParameterSpace& space) {
    std::vector<std::string> names;
    for (const auto& factor : space.factors) names.push_back(factor.name);
    for (std::size_t k = 0; k < header.size(); ++k) {
        if (std::ranges::find(names, header[k]) == names.end()) {
            file.refuse(
                fmt::format("column {} of its header, {}, is no factor of the campaign", k + 1, shown(header[k])),
                nearest_word(header[k], names));
        }
        if (std::count(header.begin(), header.end(), header[k]) > 1) {
            file.refuse(fmt::format("its header names '{}' twice", header[k]));
        }
    }
    std::vector<std::size_t> columns;
    for (const auto& name : names) {
        const auto found = std::ranges::find(header, name);
        if (found == header.end()) file.refuse(fmt::format("its header has no column for factor '{}'", name));
        columns.push_back(static_cast<std::size_t>(found - header.begin()));
    }
    return columns;
}

}  // namespace

designs::Rows read_rows_file(const Cursor& file, const ParameterSpace& space, const fs::path& folder) {
    const std::string name = file.text();
    const std::string text = read_text(file, folder / name);
    std::string_view rest = text;
    const Record header = take_csv_record(rest);
    const auto columns = columns_of(file, header, space);
    designs::Rows rows;
    for (std::size_t number = 2; !rest.empty(); ++number) {
        const Record record = take_csv_record(rest);
        if (record == Record{""}) continue;
        if (record.size() != header.size()) {
            file.refuse(fmt::format("record {} has {} cells and the header {}", number, record.size(), header.size()));
        }
        auto& row = rows.emplace_back();
        for (std::size_t j = 0; j < columns.size(); ++j) {
            const auto& parameter = *space.scene->find_parameter(space.factors[j].name);
            const auto where = fmt::format("{}: {}, record {}, column '{}'", file.path(), name, number, parameter.name);
            row.push_back(parse_value(parameter, record[columns[j]], folder, where));
            const Json cell = record[columns[j]];
            check_in_range(Cursor(cell, where), space.factors[j], row.back());
        }
    }
    if (rows.empty()) file.refuse("it has no row below its header");
    return rows;
}

}  // namespace grainsweep::campaign
