#include "stats/trend.hpp"

#include "stats/confidence.hpp"
#include "stats/undefined.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <vector>

namespace grainsweep::stats {
namespace {

constexpr std::size_t fewest_groups = 4;

std::vector<double> ranks_of(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return values[i]; });
    std::vector<double> ranks(values.size());
    for (std::size_t first = 0; first < order.size();) {
        std::size_t end = first + 1;
        while (end < order.size() && values[order[end]] == values[order[first]]) ++end;
        for (std::size_t i = first; i < end; ++i) ranks[order[i]] = 0.5 * static_cast<double>(first + end - 1);
        first = end;
    }
    return ranks;
}

double correlation_of_ranks(const std::vector<double>& x, const std::vector<double>& y) {
    if (x.size() < 3) return undefined;
    const auto a = ranks_of(x), b = ranks_of(y);
    const double middle = 0.5 * static_cast<double>(x.size() - 1);
    double ab = 0, aa = 0, bb = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        ab += (a[i] - middle) * (b[i] - middle);
        aa += (a[i] - middle) * (a[i] - middle);
        bb += (b[i] - middle) * (b[i] - middle);
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : undefined;
}

}  // namespace

SensitivityIndex rank_correlation(std::span<const double> x, std::span<const double> y,
                                  std::span<const std::size_t> groups) {
    assert(x.size() == y.size() && x.size() == groups.size());
    constexpr auto every_group = std::numeric_limits<std::size_t>::max();
    const auto without = [&](std::size_t left_out) {
        std::vector<double> a, b;
        for (std::size_t i = 0; i < x.size(); ++i) {
            if (groups[i] == left_out || !std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
            a.push_back(x[i]);
            b.push_back(y[i]);
        }
        return correlation_of_ranks(a, b);
    };
    SensitivityIndex index{.value = without(every_group)};
    const std::size_t count = groups.empty() ? 0 : *std::ranges::max_element(groups) + 1;
    std::vector<double> others;
    for (std::size_t g = 0; g < count; ++g)
        if (std::ranges::find(groups, g) != groups.end()) others.push_back(without(g));
    if (others.size() >= fewest_groups) index.half_width = jackknife_half_width(others);
    return index;
}

double rising_share(std::span<const double> means, std::span<const double> weights) {
    assert(means.size() == weights.size());
    struct Pool {
        double mean, weight;
    };
    std::vector<Pool> pools;
    double total = 0, weight = 0;
    for (std::size_t i = 0; i < means.size(); ++i) {
        total += weights[i] * means[i];
        weight += weights[i];
        pools.push_back({means[i], weights[i]});
        while (pools.size() > 1 && pools[pools.size() - 2].mean >= pools.back().mean) {
            const Pool last = pools.back();
            pools.pop_back();
            Pool& pool = pools.back();
            pool.mean = (pool.mean * pool.weight + last.mean * last.weight) / (pool.weight + last.weight);
            pool.weight += last.weight;
        }
    }
    const double centre = total / weight;
    double all = 0, rising = 0;
    for (std::size_t i = 0; i < means.size(); ++i) all += weights[i] * (means[i] - centre) * (means[i] - centre);
    for (const Pool& pool : pools) rising += pool.weight * (pool.mean - centre) * (pool.mean - centre);
    return all > 0 ? rising / all : undefined;
}

}  // namespace grainsweep::stats
