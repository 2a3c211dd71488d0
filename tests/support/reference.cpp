#include "tests/support/reference.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace grainsweep::tests {

Table read_table(const std::filesystem::path& file) {
    std::ifstream in(file);
    if (!in) throw std::runtime_error("cannot read " + file.string());
    Table table;
    std::vector<std::string> names;
    std::string line;
    std::string cell;
    std::getline(in, line);
    for (std::istringstream row(line); std::getline(row, cell, ',');) names.push_back(cell);
    while (std::getline(in, line)) {
        std::istringstream row(line);
        for (std::size_t k = 0; std::getline(row, cell, ','); ++k)
            table.columns[names.at(k)].push_back(std::strtod(cell.c_str(), nullptr));
        ++table.rows;
    }
    return table;
}

}  // namespace grainsweep::tests
