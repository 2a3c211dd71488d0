#include "sweep/study/cell_means.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace grainsweep::study {
namespace {

constexpr std::size_t most_distinct = 12;
constexpr double fewest_cells = 3, most_cells = 14, cases_per_cell = 8;

std::vector<double> edges_between(const std::vector<double>& distinct) {
    if (distinct.size() == 1) return {distinct.front() - 0.5, distinct.front() + 0.5};
    std::vector<double> edges(1);
    for (std::size_t k = 1; k < distinct.size(); ++k) edges.push_back((distinct[k - 1] + distinct[k]) / 2);
    edges.front() = 2 * distinct.front() - edges[1];
    edges.push_back(2 * distinct.back() - edges.back());
    return edges;
}

std::vector<double> edges_of(const FactorColumn& factor, const std::vector<std::size_t>& rows) {
    std::vector<double> edges;
    if (!factor.continuous()) {
        for (std::size_t k = 0; k <= factor.seen.size(); ++k) edges.push_back(static_cast<double>(k) - 0.5);
        return edges;
    }
    std::set<double> distinct;
    for (const auto row : rows) distinct.insert(factor.values[row]);
    if (distinct.size() <= most_distinct) return edges_between({distinct.begin(), distinct.end()});
    const auto wanted = std::floor(std::sqrt(static_cast<double>(rows.size()) / cases_per_cell));
    const double count = std::clamp(wanted, fewest_cells, most_cells);
    auto [low, high] = factor.ends();
    if (!(high > low)) low = *distinct.begin(), high = *distinct.rbegin();
    const bool log = factor.log() && low > 0;
    for (double k = 0; k <= count; ++k)
        edges.push_back(log ? low * std::pow(high / low, k / count) : low + (high - low) * k / count);
    return edges;
}

/// Returns the cell of a value; the cells at the ends include values that rounding puts beyond.
std::size_t cell_of(const std::vector<double>& edges, double x) {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, x);
    return static_cast<std::size_t>(above - edges.begin()) - 1;
}

}  // namespace

CellMeans cell_means(const FactorColumn& across, const FactorColumn& up, const ResponseColumn& response) {
    std::vector<std::size_t> rows;
    for (std::size_t row = 0; row < response.values.size(); ++row)
        if (std::isfinite(response.values[row]) && std::isfinite(across.values[row]) && std::isfinite(up.values[row]))
            rows.push_back(row);
    if (rows.empty()) return {};
    CellMeans cells{edges_of(across, rows), edges_of(up, rows), {}};
    const std::size_t columns = cells.x_edges.size() - 1;
    std::vector<double> counts(columns * (cells.y_edges.size() - 1), 0.0);
    cells.means.assign(counts.size(), 0.0);
    for (const auto row : rows) {
        const auto cell = cell_of(cells.y_edges, up.values[row]) * columns + cell_of(cells.x_edges, across.values[row]);
        counts[cell] += 1;
        cells.means[cell] += (response.values[row] - cells.means[cell]) / counts[cell];
    }
    for (std::size_t k = 0; k < counts.size(); ++k)
        if (counts[k] == 0) cells.means[k] = std::numeric_limits<double>::quiet_NaN();
    return cells;
}

}  // namespace grainsweep::study
