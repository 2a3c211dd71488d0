// A few of many rows: at random, or the largest and smallest.
#include "stats/random.hpp"
#include "sweep/study/responses.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::study {

std::vector<std::size_t> extreme_rows(std::span<const double> values, std::size_t count, bool largest) {
    std::vector<std::size_t> rows;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (std::isfinite(values[i])) rows.push_back(i);
    const auto before = [&](std::size_t a, std::size_t b) {
        if (values[a] != values[b]) return largest ? values[a] > values[b] : values[a] < values[b];
        return a < b;
    };
    const auto kept = std::min(count, rows.size());
    std::ranges::partial_sort(rows, rows.begin() + static_cast<std::ptrdiff_t>(kept), before);
    rows.resize(kept);
    return rows;
}

std::vector<std::size_t> random_rows(std::vector<std::size_t> rows, std::size_t most) {
    if (rows.size() <= most) return rows;
    const auto draw = [](std::size_t row) { return stats::bits_at(0, 0, row); };
    std::ranges::nth_element(rows, rows.begin() + static_cast<std::ptrdiff_t>(most), {}, draw);
    rows.resize(most);
    std::ranges::sort(rows);
    return rows;
}

}  // namespace grainsweep::study
