#include "stats/tail.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grainsweep::stats {
namespace {

constexpr std::size_t fewest_seen = 120, fewest_farthest = 32, share_of_farthest = 16;
constexpr double largest_shape = 0.5, allowance = 3.5, least_endless = 0.05, surely_endless_shape = 0.1;

}  // namespace

std::optional<Tail> Tail::of(std::span<const double> sorted, bool upper, std::size_t together, bool endless) {
    const std::size_t n = sorted.size();
    if (n < fewest_seen) return std::nullopt;
    const std::size_t m = std::min(std::max({n / share_of_farthest, fewest_farthest, strata * together}), n / 2);
    const auto value = [&](std::size_t from_end) { return upper ? sorted[n - 1 - from_end] : sorted[from_end]; };
    const double start = value(m);
    double mean = 0, weighted = 0;  // of |y - start|, and times the share of values farther out
    for (std::size_t i = 0; i < m; ++i) {
        const double beyond = std::abs(value(i) - start) / static_cast<double>(m);
        mean += beyond;
        weighted += beyond * (static_cast<double>(i) + 0.5) / static_cast<double>(m);
    }
    if (!(mean > 2 * weighted)) return std::nullopt;
    Tail tail;
    const double shape = 2 - mean / (mean - 2 * weighted);
    tail.surely_endless_ = shape > surely_endless_shape;
    tail.shape_ = shape + allowance / std::pow(static_cast<double>(m), 0.75);
    if (endless) tail.shape_ = std::max(tail.shape_, least_endless);
    if (!(tail.shape_ > 0)) return std::nullopt;
    tail.shape_ = std::min(tail.shape_, largest_shape);
    const double scale = (1 - tail.shape_) * mean;
    const auto r = static_cast<double>(together), all = static_cast<double>(n);
    tail.weight_ = r / (all * all);
    for (std::size_t i = 0; i < strata * places; ++i) {
        const double p = (static_cast<double>(i) + 0.5) / places * r / static_cast<double>(m);
        const double beyond = scale * std::expm1(-tail.shape_ * std::log(p)) / tail.shape_;
        tail.values_.push_back(upper ? start + beyond : start - beyond);
    }
    return tail;
}

std::vector<Tail> tails_of(std::span<const double> sorted, std::size_t together, bool endless) {
    std::vector<Tail> tails;
    for (const bool upper : {false, true})
        if (auto tail = Tail::of(sorted, upper, together, endless)) tails.push_back(std::move(*tail));
    return tails;
}

}  // namespace grainsweep::stats
