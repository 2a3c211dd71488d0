// Reads a table of the reference numbers: a header row, cells without commas inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/support/places.hpp"

namespace grainsweep::tests {

class ReferenceTable {
public:
    /// `file` is relative to tests/reference, e.g. "designs/halton_plain.csv". Throws std::runtime_error where it
    /// cannot be read.
    explicit ReferenceTable(const std::string& file) {
        const auto path = tests::reference(file);
        std::ifstream stream(path);
        if (!stream) throw std::runtime_error("cannot read " + path.string());
        std::string line;
        std::getline(stream, line);
        header_ = split(line);
        while (std::getline(stream, line)) rows_.push_back(split(line));
    }

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

}  // namespace grainsweep::tests
