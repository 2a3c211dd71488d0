#include "stats/settling.hpp"

#include <cmath>
#include <vector>

namespace grainsweep::stats {
namespace {

double mean_of(std::span<const double> values) {
    double sum = 0;
    for (const double value : values) sum += value - values.front();
    return values.front() + sum / static_cast<double>(values.size());
}

/// Standard error of the mean of independent values.
double naive_error(std::span<const double> values) {
    const auto n = static_cast<double>(values.size());
    const double mean = mean_of(values);
    double squares = 0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    return std::sqrt(squares / (n * (n - 1)));
}

}  // namespace

std::size_t settled_from(std::span<const double> series, double band) {
    std::size_t first = series.size();
    while (first > 0 && std::abs(series[first - 1] - series.back()) <= band) --first;
    return first;
}

BlockedMean blocked_mean(std::span<const double> series) {
    BlockedMean result;
    if (series.empty()) return result;
    result.mean = mean_of(series);
    if (series.size() < 2) return result;
    const auto n = static_cast<double>(series.size());
    const double plain = naive_error(series);
    std::vector<double> blocks(series.begin(), series.end());
    // Two blocks say little about a spread: the last level looked at has four.
    for (std::size_t length = 1; length == 1 || blocks.size() >= 4; length *= 2) {
        const double error = naive_error(blocks);
        result.standard_error = error;
        result.block_length = length;
        const auto b = static_cast<double>(length);
        const double ratio = plain > 0 ? error / plain : 1;
        result.effective_samples = ratio > 0 ? n / (ratio * ratio) : n;
        result.plateau = b * b * b > 2 * n * ratio * ratio * ratio * ratio;
        if (result.plateau || plain == 0) break;
        for (std::size_t k = 0; 2 * k + 1 < blocks.size(); ++k) blocks[k] = 0.5 * (blocks[2 * k] + blocks[2 * k + 1]);
        blocks.resize(blocks.size() / 2);
    }
    result.plateau = result.plateau || plain == 0;
    return result;
}

}  // namespace grainsweep::stats
