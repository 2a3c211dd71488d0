// CSV files that a campaign file names, and listed rows from one (RFC 4180): a header that names the factors in any
// order, then one point a line.
#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

namespace grainsweep::campaign {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_table = 256ULL << 20U;

/// For each factor the column that holds it.
std::vector<std::size_t> columns_of(const Cursor& file, const CsvRecord& header, const ParameterSpace& space) {
    const auto names = names_of(space.factors);
    for (std::size_t k = 0; k < header.size(); ++k) {
        if (std::ranges::find(names, header[k]) == names.end()) {
            file.refuse(
                fmt::format("column {} of its header, {}, is no factor of the campaign", k + 1, shown(header[k])),
                nearest_word(header[k], names));
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

std::string read_csv_text(const Cursor& file, const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) file.refuse("there is no such file beside the campaign file");
    if (fs::file_size(path, error) > largest_table || error)
        file.refuse("the file must be readable and at most 256 MiB");
    std::string text = files::whole_file(path, error);
    if (error)  // the rows read so far are only a part, but would look like a shorter list
        file.refuse(fmt::format("'{}' cannot be read beyond line {}: {}", path.string(),
                                1 + std::ranges::count(text, '\n'), error.message()));
    return text;
}

designs::Rows read_rows_file(const Cursor& file, const ParameterSpace& space, const fs::path& folder) {
    const std::string name = file.text();
    const std::string text = read_csv_text(file, folder / name);
    CsvTable table(text, [&](const std::string& rule) { file.refuse(rule); });
    const auto columns = columns_of(file, table.header(), space);
    designs::Rows rows;
    while (const auto record = table.next()) {
        auto& row = rows.emplace_back();
        for (std::size_t j = 0; j < columns.size(); ++j) {
            const auto& parameter = *space.scene->find_parameter(space.factors[j].name);
            const auto where =
                fmt::format("{}: {}, record {}, column '{}'", file.path(), name, table.number(), parameter.name);
            row.push_back(parse_value(parameter, (*record)[columns[j]], folder, where));
            const Json cell = (*record)[columns[j]];
            check_in_range(Cursor(cell, where), space.factors[j], row.back());
        }
    }
    if (rows.empty()) file.refuse("it has no row below its header");
    return rows;
}

}  // namespace grainsweep::campaign
