// Cases of a campaign as `grainsweep query --format csv DB "SELECT factor, ..., response, ... FROM name"` writes them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::testing {

struct TableOfCases {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;  ///< NaN where there is no number

    [[nodiscard]] const std::vector<double>& of(const std::string& name) const {
        const auto found = std::find(names.begin(), names.end(), name);
        if (found == names.end()) throw std::runtime_error("no column " + name);
        return columns[static_cast<std::size_t>(found - names.begin())];
    }
};

inline TableOfCases read_cases(const std::string& path) {
    std::ifstream file(path);
    if (!file) throw std::runtime_error("cannot read " + path);
    TableOfCases table;
    std::string line, cell;
    std::getline(file, line);
    for (std::istringstream row(line); std::getline(row, cell, ',');) table.names.push_back(cell);
    table.columns.resize(table.names.size());
    while (std::getline(file, line)) {
        std::istringstream row(line);
        for (auto& column : table.columns) {
            cell.clear();
            std::getline(row, cell, ',');
            char* end = nullptr;
            const double value = std::strtod(cell.c_str(), &end);
            column.push_back(end == cell.c_str() ? std::numeric_limits<double>::quiet_NaN() : value);
        }
    }
    return table;
}

/// Features of the model: a factor's logarithm where its largest value is 2.5 times its smallest, scaled to [0, 1].
inline std::vector<double> features_of(const TableOfCases& table, const std::vector<std::string>& factors) {
    const std::size_t d = factors.size(), n = table.columns.front().size();
    std::vector<double> features(n * d);
    for (std::size_t j = 0; j < d; ++j) {
        const auto& column = table.of(factors[j]);
        const auto [low, high] = std::minmax_element(column.begin(), column.end());
        const bool logarithm = *low > 0 && *high >= 2.5 * *low;
        const auto scale = [&](double x) { return logarithm ? std::log(x) : x; };
        for (std::size_t i = 0; i < n; ++i)
            features[i * d + j] = (scale(column[i]) - scale(*low)) / (scale(*high) - scale(*low));
    }
    return features;
}

}  // namespace grainsweep::testing
