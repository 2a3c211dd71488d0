#include "tests/support/measured.hpp"

#include "tests/support/places.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace grainsweep::tests {
namespace {

std::filesystem::path measured_file(const std::string& name) {
    return reference("measured/" + name + ".csv");
}

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ';');) cells.push_back(cell);
    if (line.ends_with(';')) cells.emplace_back();
    return cells;
}

}  // namespace

TableRows read_measured(const std::string& name) {
    std::ifstream file(measured_file(name));
    if (!file) throw std::runtime_error("cannot read " + measured_file(name).string());
    TableRows rows;
    for (std::string line; std::getline(file, line);) rows.push_back(cells_of(line));
    return rows;
}

void remember_measured(const std::string& name, const std::vector<std::string>& head, const TableRows& fresh,
                       std::size_t keys) {
    if (std::getenv("GRAINSWEEP_WRITE_DOCUMENTS") == nullptr) return;
    TableRows rows;
    if (std::filesystem::exists(measured_file(name))) rows = read_measured(name);
    if (rows.empty()) rows.push_back(head);
    rows.front() = head;
    for (const auto& row : fresh) {
        const auto same = [&](const auto& other) {
            return std::equal(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(keys), other.begin());
        };
        if (const auto old = std::find_if(rows.begin() + 1, rows.end(), same); old != rows.end())
            *old = row;
        else
            rows.push_back(row);
    }
    std::ofstream out(measured_file(name), std::ios::binary);
    for (const auto& row : rows) {
        std::string line;
        for (const auto& cell : row) line += (line.empty() ? "" : ";") + cell;
        out << line << '\n';
    }
}

}  // namespace grainsweep::tests
