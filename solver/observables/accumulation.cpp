#include "solver/observables/accumulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace grainsweep::observables {
namespace {

// Returns the bin of x; NaN counts in the first bin.
int bin(double x, double low, double high, int n) {
    const double at = (x - low) / (high - low) * n;
    return at > 0 ? static_cast<int>(std::min(at, n - 1.0)) : 0;
}

}  // namespace

std::vector<int> cell_counts(std::span<const Vec3> positions, const Box& box, int n) {
    const auto size = static_cast<std::size_t>(n);
    std::vector<int> counts(size * size * size, 0);
    for (const Vec3& x : positions) {
        std::size_t at = 0;
        for (std::size_t d = 3; d-- > 0;)
            at = at * size + static_cast<std::size_t>(bin(x[d], box.low[d], box.high[d], n));
        ++counts[at];
    }
    return counts;
}

double accumulation(std::span<const int> counts) {
    const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
    const double mean = total / static_cast<double>(counts.size());
    if (total < 2) return std::numeric_limits<double>::quiet_NaN();
    double sum = 0;
    for (const int k : counts) sum += std::abs(k - mean);
    return sum / (2 * (total - mean));
}

double random_accumulation(std::size_t particles, std::size_t cells) {
    const auto n = static_cast<double>(particles);
    const double p = 1 / static_cast<double>(cells);
    const double mean = n * p;
    const double f = std::floor(mean) + 1;
    const double choose = std::lgamma(n + 1) - std::lgamma(f + 1) - std::lgamma(n - f + 1);
    const double deviation = 2 * f * std::exp(choose + f * std::log(p) + (n - f + 1) * std::log1p(-p));
    return static_cast<double>(cells) * deviation / (2 * (n - mean));
}

double random_accumulation_deviation(std::size_t particles, std::size_t cells) {
    const auto n = static_cast<double>(particles);
    const auto c = static_cast<double>(cells);
    const double mean = n / c;
    const double deviation = random_accumulation(particles, cells) * 2 * (n - mean) / c;  // E|k - m|
    const double variance = mean * (1 - 1 / c) - deviation * deviation;
    return std::sqrt(std::max(variance, 0.0) * c) / (2 * (n - mean));
}

std::vector<double> density_profile(std::span<const Vec3> positions, const Box& box, int n, int d) {
    std::vector<double> profile(static_cast<std::size_t>(n), 0.0);
    const auto m = static_cast<std::size_t>(d);
    const double share = n / static_cast<double>(positions.size());
    for (const Vec3& x : positions) profile[static_cast<std::size_t>(bin(x[m], box.low[m], box.high[m], n))] += share;
    return profile;
}

double structures(std::span<const int> counts, int n) {
    const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
    const double dense = 2 * total / static_cast<double>(counts.size());
    if (dense < 1) return std::numeric_limits<double>::quiet_NaN();
    std::vector<char> seen(counts.size(), 0);
    const auto index = [n](int i, int j, int k) { return static_cast<std::size_t>(i + n * (j + n * k)); };
    int found = 0;
    std::vector<std::array<int, 3>> open;
    for (int k = 0; k < n; ++k)
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                if (seen[index(i, j, k)] != 0 || counts[index(i, j, k)] <= dense) continue;
                double held = 0;
                open.assign(1, {i, j, k});
                seen[index(i, j, k)] = 1;
                while (!open.empty()) {
                    const auto cell = open.back();
                    open.pop_back();
                    held += counts[index(cell[0], cell[1], cell[2])];
                    for (std::size_t d = 0; d < 3; ++d)
                        for (const int step : {-1, 1}) {
                            auto next = cell;
                            next[d] += step;
                            if (next[d] < 0 || next[d] >= n) continue;
                            const std::size_t at = index(next[0], next[1], next[2]);
                            if (seen[at] != 0 || counts[at] <= dense) continue;
                            seen[at] = 1;
                            open.push_back(next);
                        }
                }
                if (held >= 0.05 * total) ++found;
            }
    return found;
}

double formation_time(std::span<const double> times, std::span<const double> values, double scatter) {
    constexpr double never = std::numeric_limits<double>::quiet_NaN();
    if (values.empty()) return never;
    const double last = values.back();
    const double rise = std::abs(last - values.front());
    if (!(rise > 5 * scatter)) return never;
    const double near = std::max(0.1 * rise, 3 * scatter);
    std::size_t first = values.size();
    while (first > 0 && std::abs(values[first - 1] - last) <= near) --first;
    const bool late = times[first] - times.front() >= 0.9 * (times.back() - times.front());
    return late ? never : times[first];
}

}  // namespace grainsweep::observables
