// "sample": columns of a CSV file as the distribution of factors.
#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/powder.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/sections.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grainsweep::campaign {

namespace {

namespace fs = std::filesystem;

/// Columns of one file, in the order in which they stand there.
struct SampledFile {
    std::string name;
    std::vector<NamedColumn> columns;
    std::vector<std::size_t> places;  ///< of the columns
};

std::vector<SampledFile> files_of(std::span<const NamedColumn> columns, const fs::path& folder) {
    std::vector<SampledFile> files;
    for (const auto& column : columns) {
        std::error_code error;
        const auto same = [&](const SampledFile& file) {
            return file.name == column.file || fs::equivalent(folder / file.name, folder / column.file, error);
        };
        auto found = std::ranges::find_if(files, same);
        if (found == files.end()) found = files.insert(files.end(), {column.file, {}, {}});
        found->columns.push_back(column);
    }
    return files;
}

/// Finds the columns and sorts them as the header does.
void find_columns(SampledFile& file, const CsvRecord& header) {
    for (const auto& column : file.columns) {
        const auto found = std::ranges::find(header, column.column);
        if (found == header.end())
            column.place.refuse(
                fmt::format("its header has no column '{}'{}", column.column,
                            column.place.json().is_string() ? ": name it by {\"file\": ..., \"column\": ...}" : ""),
                nearest_word(column.column, header));
        const auto place = static_cast<std::size_t>(found - header.begin());
        if (std::ranges::find(file.places, place) != file.places.end())
            column.place.refuse(fmt::format("another factor samples the column '{}' already", column.column));
        file.places.push_back(place);
    }
    std::vector<std::size_t> order(file.places.size());
    for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
    std::ranges::sort(order, {}, [&](std::size_t k) { return file.places[k]; });
    SampledFile sorted{file.name, {}, {}};
    for (const auto k : order) {
        sorted.columns.push_back(file.columns[k]);
        sorted.places.push_back(file.places[k]);
    }
    file = std::move(sorted);
}

/// The values of the columns, row by row.
std::vector<std::vector<double>> values_in(CsvTable& table, const SampledFile& file, const std::vector<Factor>& factors,
                                           const SceneInfo& scene, const fs::path& folder) {
    std::vector<std::vector<double>> values(file.columns.size());
    const Cursor& named = file.columns.front().place;
    while (const auto record = table.next()) {
        for (std::size_t k = 0; k < values.size(); ++k) {
            const auto& column = file.columns[k];
            const auto& parameter = *scene.find_parameter(factors[column.factor].name);
            const auto where = fmt::format("{}: {}, record {}, column '{}'", column.place.path(), file.name,
                                           table.number(), column.column);
            values[k].push_back(std::get<double>(parse_value(parameter, (*record)[file.places[k]], folder, where)));
        }
        if (values.front().size() > most_sample_rows)
            named.refuse(fmt::format("a sample has at most {} rows; take every n-th of them", most_sample_rows));
    }
    if (values.front().size() < 2) named.refuse("a sample has at least 2 rows below its header");
    for (std::size_t k = 0; k < values.size(); ++k)
        if (std::ranges::count(values[k], values[k].front()) == std::ssize(values[k]))
            file.columns[k].place.refuse(
                fmt::format("all {} values of the column '{}' are the same; what does not vary goes into \"fixed\"",
                            values[k].size(), file.columns[k].column));
    return values;
}

/// The posterior of the powder file, from the folder.
std::string posterior_of(const Cursor& place, const fs::path& folder) {
    const fs::path posterior = powder_beside(place, folder).posterior;
    if (posterior.empty())
        place.refuse("this powder has no \"posterior\", the CSV file that a calibration writes (calibrate --powder)");
    return posterior.lexically_relative(fs::absolute(folder / ".")).string();
}

}  // namespace

NamedColumn read_named_column(const Section& section, std::size_t factor, const ParameterSpec& parameter,
                              const fs::path& folder) {
    const Cursor place = section.at("sample");
    if (place.json().is_string()) return {factor, place, place.text(), parameter.name};
    if (!place.json().is_object())
        place.refuse("must be the name of a CSV file, or {\"file\": ... or \"powder\": ..., \"column\": ...}");
    const Section named(place, sample_keys);
    const auto column = named.find("column"), file = named.find("file"), powder = named.find("powder");
    if (file.has_value() == powder.has_value()) place.refuse("needs \"file\" or \"powder\", one of the two");
    return {factor, place, file ? file->text() : posterior_of(*powder, folder),
            column ? column->text() : parameter.name};
}

void read_samples(std::span<const NamedColumn> columns, std::vector<Factor>& factors, const SceneInfo& scene,
                  const fs::path& folder) {
    for (auto& file : files_of(columns, folder)) {
        const Cursor named = file.columns.front().place;  // the columns are sorted below
        const std::string text = read_csv_text(named, folder / file.name);
        CsvTable table(text, [&](const std::string& rule) { named.refuse(rule); });
        find_columns(file, table.header());
        const auto sample = std::make_shared<const stats::JointSample>(values_in(table, file, factors, scene, folder));
        for (std::size_t k = 0; k < file.columns.size(); ++k)
            factors[file.columns[k].factor].range = stats::Distribution(stats::SampleColumn{sample, k});
    }
}

}  // namespace grainsweep::campaign
