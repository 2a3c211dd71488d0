// Reads a table of the reference numbers: a header row, cells without commas inside.
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::testing {

class ReferenceTable {
public:
    /// `file` is relative to the reference folder, e.g. "designs/halton_plain.csv".
    explicit ReferenceTable(const std::string& file) {
        std::ifstream stream(path(file));
        if (!stream) throw std::runtime_error("cannot read " + path(file).string());
        std::string line;
        std::getline(stream, line);
        header_ = split(line);
        while (std::getline(stream, line)) rows_.push_back(split(line));
    }

    [[nodiscard]] static std::filesystem::path path(const std::string& file) {
        return std::filesystem::path(GRAINSWEEP_REFERENCE) / file;
    }
    [[nodiscard]] static bool exists(const std::string& file) { return std::filesystem::exists(path(file)); }

    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    [[nodiscard]] std::size_t columns() const { return header_.size(); }
    [[nodiscard]] const std::string& cell(std::size_t row, std::size_t column) const {
        return rows_.at(row).at(column);
    }
    [[nodiscard]] const std::string& cell(std::size_t row, const std::string& column) const {
        for (std::size_t c = 0; c < header_.size(); ++c)
            if (header_[c] == column) return cell(row, c);
        throw std::runtime_error("no column " + column);
    }
    [[nodiscard]] double number(std::size_t row, const std::string& column) const {
        return std::strtod(cell(row, column).c_str(), nullptr);
    }
    [[nodiscard]] double number(std::size_t row, std::size_t column) const {
        return std::strtod(cell(row, column).c_str(), nullptr);
    }
    [[nodiscard]] std::uint64_t whole(std::size_t row, const std::string& column) const {
        return std::strtoull(cell(row, column).c_str(), nullptr, 10);
    }

private:
    static std::vector<std::string> split(std::string line) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        std::vector<std::string> cells;
        std::istringstream stream(line);
        for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
        if (!line.empty() && line.back() == ',') cells.emplace_back();
        return cells;
    }

    std::vector<std::string> header_;
    std::vector<std::vector<std::string>> rows_;
};

}  // namespace grainsweep::testing

/// Skips the running test where the reference numbers are not at hand.
#define SKIP_WITHOUT_REFERENCE(file)                        \
    if (!grainsweep::testing::ReferenceTable::exists(file)) \
    GTEST_SKIP() << "no reference numbers at " << grainsweep::testing::ReferenceTable::path(file)
