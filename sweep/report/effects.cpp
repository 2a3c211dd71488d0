#include "sweep/report/effects.hpp"

#include "stats/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace grainsweep::report {
namespace {

constexpr std::size_t most_bins = 16;
constexpr std::size_t fewest_per_bin = 8;

using Pairs = std::vector<std::pair<double, double>>;  // factor, response

EffectBin bin_of(std::span<const std::pair<double, double>> pairs) {
    std::vector<double> responses;
    responses.reserve(pairs.size());
    double factor_sum = 0, response_sum = 0;
    for (const auto& [x, y] : pairs) {
        factor_sum += x;
        response_sum += y;
        responses.push_back(y);
    }
    const auto n = static_cast<double>(pairs.size());
    return {factor_sum / n, response_sum / n, stats::student_half_width(responses),
            static_cast<std::int64_t>(pairs.size())};
}

/// Ends of the runs of equal factor values.
std::vector<std::size_t> ends_of_runs(const Pairs& sorted) {
    std::vector<std::size_t> ends;
    for (std::size_t i = 1; i <= sorted.size(); ++i)
        if (i == sorted.size() || sorted[i].first != sorted[i - 1].first) ends.push_back(i);
    return ends;
}

}  // namespace

Histogram histogram_of(std::span<const double> values) {
    Histogram histogram;
    std::vector<double> finite;
    std::ranges::copy_if(values, std::back_inserter(finite), [](double x) { return std::isfinite(x); });
    if (finite.empty()) return histogram;
    const auto [low, high] = std::ranges::minmax(finite);
    histogram.low = low;
    histogram.high = high;
    const double width = high - low;
    const auto rice = static_cast<std::size_t>(std::ceil(2 * std::cbrt(static_cast<double>(finite.size()))));
    const std::size_t bins = width > 0 ? std::clamp<std::size_t>(rice, 5, 40) : 1;
    histogram.counts.resize(bins);
    for (const double x : finite) {
        const double share = width > 0 ? (x - low) / width : 0;
        ++histogram.counts[std::min(bins - 1, static_cast<std::size_t>(share * static_cast<double>(bins)))];
    }
    return histogram;
}

std::vector<EffectBin> main_effect(const FactorColumn& factor, std::span<const double> response) {
    Pairs pairs;
    for (std::size_t i = 0; i < response.size(); ++i)
        if (std::isfinite(response[i]) && std::isfinite(factor.values[i]))
            pairs.emplace_back(factor.values[i], response[i]);
    std::ranges::stable_sort(pairs, {}, &std::pair<double, double>::first);
    auto ends = ends_of_runs(pairs);
    if (factor.continuous() && ends.size() > most_bins) {
        const std::size_t bins = std::clamp<std::size_t>(pairs.size() / fewest_per_bin, 1, most_bins);
        ends.clear();
        for (std::size_t b = 1; b <= bins; ++b) ends.push_back(pairs.size() * b / bins);
    }
    std::vector<EffectBin> effect;
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
        effect.push_back(bin_of(std::span(pairs).subspan(begin, end - begin)));
        begin = end;
    }
    return effect;
}

}  // namespace grainsweep::report
