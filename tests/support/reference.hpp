// Reads reference numbers made by other programs.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace grainsweep::tests {

/// A CSV file with one header row: column name -> numbers.
struct Table {
    std::map<std::string, std::vector<double>> columns;
    std::size_t rows = 0;
    [[nodiscard]] double at(const std::string& column, std::size_t row) const { return columns.at(column).at(row); }
};

[[nodiscard]] Table read_table(const std::filesystem::path& file);

/// GRAINSWEEP_REFERENCE/part, which may not exist.
[[nodiscard]] std::filesystem::path reference(const std::string& part);

}  // namespace grainsweep::tests
