// Reads reference numbers made by other programs.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/places.hpp"

namespace grainsweep::tests {

/// A CSV file with one header row: column name -> numbers.
struct Table {
    std::map<std::string, std::vector<double>> columns;
    std::size_t rows = 0;
    [[nodiscard]] double at(const std::string& column, std::size_t row) const { return columns.at(column).at(row); }
};

/// Throws std::runtime_error where the file cannot be read.
[[nodiscard]] Table read_table(const std::filesystem::path& file);

}  // namespace grainsweep::tests
