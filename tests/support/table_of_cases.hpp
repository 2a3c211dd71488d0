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

namespace grainsweep::tests {

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

/// How a factor becomes a feature in [0, 1]: by its logarithm where its highest value is 2.5 times its lowest.
struct FactorScale {
    double low, high;

    [[nodiscard]] bool logarithmic() const { return low > 0 && high >= 2.5 * low; }
    [[nodiscard]] double feature(double x) const {
        return logarithmic() ? std::log(x / low) / std::log(high / low) : (x - low) / (high - low);
    }
    [[nodiscard]] double at(double u) const { return low + u * (high - low); }
};

/// "0.1:0.3,1:5" -> the ranges of two factors.
inline std::vector<FactorScale> read_box(const std::string& text) {
    std::vector<FactorScale> box;
    std::string range;
    for (std::istringstream all(text); std::getline(all, range, ',');) {
        const auto colon = range.find(':');
        if (colon == std::string::npos) throw std::runtime_error("a range is LOW:HIGH, not " + range);
        box.push_back({std::strtod(range.c_str(), nullptr), std::strtod(range.c_str() + colon + 1, nullptr)});
    }
    return box;
}

/// Features of the cases, row-major: factor j is column `first` + j.
inline std::vector<double> features_of(const TableOfCases& table, std::size_t first,
                                       const std::vector<FactorScale>& box) {
    const std::size_t n = table.columns.front().size();
    std::vector<double> features(n * box.size());
    for (std::size_t j = 0; j < box.size(); ++j)
        for (std::size_t i = 0; i < n; ++i)
            features[i * box.size() + j] = box[j].feature(table.columns.at(first + j)[i]);
    return features;
}

}  // namespace grainsweep::tests
